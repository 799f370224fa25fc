//! Every backend agrees with the scalar reference on every property, with one test for each.
//!
//! A test of a backend that this CPU does not have prints SKIP; `the_expected_backends_ran` counts those and fails if
//! one was skipped that this CPU has.

use xtask_equivalence::{Form, Property, Subject, compare, facade_agrees, reference};

fn check(subject: Subject, form: Form, property: Property) {
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
    ($($backend:ident: ($subject:expr) $form:ident;)*) => {
        /// What is tested here.
        fn listed() -> Vec<(Subject, Form)> {
            vec![$(($subject, Form::$form)),*]
        }

        $(mod $backend {
            tests! { @properties ($subject) $form:
                floats Floats; ints Ints; masks Masks; memory Memory; texels Texels; math Math; axes Axes;
                evaluation Evaluation; interpolation Interpolation; rgl Rgl; sampling Sampling;
                representations Representations;
            }
        })*
    };
    (@properties ($subject:expr) $form:ident: $($name:ident $property:ident;)*) => {$(
        #[test]
        fn $name() {
            use super::{Form, Property, Subject};
            super::check($subject, Form::$form, Property::$property);
        }
    )*};
}

tests! {
    emulated4: (Subject::Emulated4) Strict;
    emulated8: (Subject::Emulated8) Strict;
    emulated16: (Subject::Emulated16) Strict;
    sse2: (Subject::Native("sse2")) Strict;
    sse41: (Subject::Native("sse4.1")) Strict;
    avx2: (Subject::Native("avx2")) Strict;
    avx2_fused: (Subject::Native("avx2")) Fused;
}

#[test]
fn the_reference_holds_what_its_definition_says() {
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
        for &form in subject.forms() {
            assert!(listed().contains(&(subject, form)), "{} {form:?} has no tests in this file", subject.name());
        }
        let tests = subject.forms().len() * Property::ALL.len();
        let ran = subject.record(Form::Strict, Property::Masks).is_some();
        assert_eq!(ran, subject.expected(), "{}", subject.name());
        *if ran { &mut run } else { &mut skipped } += tests;
    }
    println!("{run} tests of backends ran, {skipped} were skipped");
    facade_agrees().unwrap();
}
