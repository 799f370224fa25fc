//! Tests that every backend agrees with the scalar reference on every property, with one test for each.
//!
//! A test of a backend that this CPU does not have prints SKIP; `the_expected_backends_ran` counts those and fails if
//! one was skipped that this CPU has.

use xtask_equivalence::{Form, Property, Subject, compare, facade_agrees, reference};

fn check(subject: Subject, form: Form, property: Property) {
    if subject.lanes().is_some() && !subject.forms().contains(&form) {
        println!("SKIP: {} has one form", subject.name());
        return;
    }
    let Some(found) = subject.record(form, property) else {
        println!("SKIP: this CPU has no {}", subject.name());
        return;
    };
    let checks = compare(&found, &reference(property), subject.name(), form);
    assert!(!checks.is_empty());
    let faults: Vec<_> = checks.iter().filter(|check| !check.ok).collect();
    assert!(faults.is_empty(), "{} of {} checks failed: {faults:#?}", faults.len(), checks.len());
}

macro_rules! tests {
    ($($module:ident: ($subject:expr) $form:ident;)*) => {$(
        mod $module {
            tests! { @properties ($subject) $form:
                floats Floats; ints Ints; masks Masks; memory Memory; texels Texels; math Math; axes Axes;
                evaluation Evaluation; interpolation Interpolation; rgl Rgl; sampling Sampling;
                representations Representations;
            }
        }
    )*};
    (@properties ($subject:expr) $form:ident: $($name:ident $property:ident;)*) => {$(
        #[test]
        fn $name() {
            use xtask_equivalence::{Form, Property, Subject};
            crate::check($subject, Form::$form, Property::$property);
        }
    )*};
}

tests! {
    emulated4: (Subject::Emulated4) Strict;
    emulated8: (Subject::Emulated8) Strict;
    emulated16: (Subject::Emulated16) Strict;
}

/// Both forms of every backend.
macro_rules! tests_of_backends {
    ($($backend:ident $name:literal;)*) => {$(
        #[allow(non_snake_case, reason = "the names of the backends")]
        mod $backend {
            tests! {
                strict: (Subject::Native($name)) Strict;
                fused: (Subject::Native($name)) Fused;
            }
        }
    )*};
}

lobe_backend::each_backend! { tests_of_backends }

#[test]
fn the_reference_satisfies_its_definitions() {
    for property in Property::ALL {
        let records = reference(property);
        for check in compare(&records, &records, "scalar", Form::Strict) {
            assert!(check.ok, "{check:#?}");
        }
    }
}

#[test]
fn the_expected_backends_ran() {
    let (mut run, mut skipped) = (0, 0);
    for subject in Subject::all() {
        let tests = subject.forms().len() * Property::ALL.len();
        let ran = subject.record(Form::Strict, Property::Masks).is_some();
        assert_eq!(ran, subject.expected(), "{}", subject.name());
        *if ran { &mut run } else { &mut skipped } += tests;
    }
    println!("{run} tests of backends ran, {skipped} were skipped");
    facade_agrees().unwrap();
}
