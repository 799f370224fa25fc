//! Records of the results of a property on one backend, and their comparison with the reference.

use serde::Serialize;

use super::Form;

/// A named row of results, item by item the same on every backend, whatever its width.
#[derive(Clone, Debug)]
pub struct Record {
    /// What was computed.
    pub what: String,
    /// The results.
    pub values: Values,
    /// The bound of the difference between the fused form and the reference.
    pub bound: Bound,
}

/// The results of a [`Record`].
#[derive(Clone, Debug)]
pub enum Values {
    /// Floats; all NaN count as one value.
    Floats(Vec<f32>),
    /// Integers, indices, mask bits: equal in every form.
    Words(Vec<u32>),
    /// Statements that must be true by definition, on the reference as well.
    Holds(Vec<bool>),
}

/// The bound of the difference between floats in fused form and the reference.
#[derive(Clone, Debug)]
pub enum Bound {
    /// No difference, because nothing here multiplies and adds.
    Same,
    /// An absolute difference.
    Within(f64),
    /// An absolute difference for each item.
    Each(Vec<f64>),
    /// Nothing is promised, because the input is outside the domain.
    StrictOnly,
}

/// The outcome for one record on one backend in one form.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Name of the backend.
    pub backend: String,
    /// What was computed.
    pub what: String,
    /// `strict` or `fused`.
    pub form: Form,
    /// Number of results compared.
    pub items: usize,
    /// Number of results that differ in any bit.
    pub differing: usize,
    /// The difference of the item that comes nearest to its bound, or exceeds it most.
    pub max_abs: f64,
    /// The bound of that item.
    pub bound: f64,
    /// `true` if every item is within its bound.
    pub ok: bool,
    /// The first item out of bounds, found and expected.
    #[serde(skip)]
    pub first_fault: Option<String>,
}

impl From<Vec<f32>> for Values {
    fn from(values: Vec<f32>) -> Self {
        Values::Floats(values)
    }
}

impl From<Vec<u32>> for Values {
    fn from(values: Vec<u32>) -> Self {
        Values::Words(values)
    }
}

impl From<Vec<bool>> for Values {
    fn from(values: Vec<bool>) -> Self {
        Values::Holds(values)
    }
}

impl Record {
    /// Results that must be the same in both forms.
    pub fn exact(what: impl Into<String>, values: impl Into<Values>) -> Self {
        Record { what: what.into(), values: values.into(), bound: Bound::Same }
    }

    /// Floats whose fused form must be within `bound`.
    pub fn bounded(what: impl Into<String>, values: Vec<f32>, bound: Bound) -> Self {
        Record { what: what.into(), values: Values::Floats(values), bound }
    }

    /// Compares `self` with the record of the reference; `None` if nothing is promised in this form.
    ///
    /// # Panics
    /// If the two records are of different computations.
    pub fn compare(&self, reference: &Record, backend: &str, form: Form) -> Option<Check> {
        assert_eq!(self.what, reference.what, "records in another order");
        let fused = form == Form::Fused;
        if fused && matches!(reference.bound, Bound::StrictOnly) {
            return None;
        }
        let mut check = Check {
            backend: backend.into(),
            what: self.what.clone(),
            form,
            items: 0,
            differing: 0,
            max_abs: 0.0,
            bound: 0.0,
            ok: true,
            first_fault: None,
        };
        match (&self.values, &reference.values) {
            (Values::Floats(found), Values::Floats(expected)) => {
                assert_eq!(found.len(), expected.len(), "{}", self.what);
                let mut nearest = -1.0;
                for (item, (&found, &expected)) in found.iter().zip(expected).enumerate() {
                    let bound = match &reference.bound {
                        Bound::Within(bound) if fused => *bound,
                        Bound::Each(bounds) if fused => bounds[item],
                        _ => 0.0,
                    };
                    let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
                    let difference = if same { 0.0 } else { difference(found, expected) };
                    // A zero with the wrong sign is a fault although the difference is 0, except in fused sums, where
                    // the product of a zero weight and a negative value keeps its sign.
                    let fused_sum = fused && matches!(reference.bound, Bound::Each(_));
                    let fault = !same && (difference > bound || (bound == 0.0 && !fused_sum));
                    let show = |x: f32| format!("{x:e} ({:#010x})", x.to_bits());
                    check.count(!same, fault, || format!("item {item}: {}, not {}", show(found), show(expected)));
                    if nearness(difference, bound) > nearest {
                        (nearest, check.max_abs, check.bound) = (nearness(difference, bound), difference, bound);
                    }
                }
            }
            (Values::Words(found), Values::Words(expected)) => {
                assert_eq!(found.len(), expected.len(), "{}", self.what);
                for (item, (found, expected)) in found.iter().zip(expected).enumerate() {
                    let differ = found != expected;
                    check.count(differ, differ, || format!("item {item}: {found:#x}, not {expected:#x}"));
                }
            }
            (Values::Holds(found), Values::Holds(_)) => {
                for (item, &holds) in found.iter().enumerate() {
                    check.count(!holds, !holds, || format!("item {item} is not as defined"));
                }
            }
            _ => panic!("{}: records of different types", self.what),
        }
        Some(check)
    }
}

impl Check {
    /// Merges a check of the same computation on other input.
    pub fn merge(&mut self, other: Check) {
        self.items += other.items;
        self.differing += other.differing;
        self.ok &= other.ok;
        if other.nearness() > self.nearness() {
            (self.max_abs, self.bound) = (other.max_abs, other.bound);
        }
        self.first_fault = self.first_fault.take().or(other.first_fault);
    }

    /// The difference as a fraction of its bound.
    pub fn nearness(&self) -> f64 {
        nearness(self.max_abs, self.bound)
    }

    fn count(&mut self, differs: bool, fault: bool, describe: impl Fn() -> String) {
        self.items += 1;
        self.differing += usize::from(differs);
        if fault {
            self.ok = false;
            self.first_fault.get_or_insert_with(describe);
        }
    }
}

/// A difference as a fraction of its bound; any difference is far beyond a bound of 0.
fn nearness(difference: f64, bound: f64) -> f64 {
    difference / bound.max(f64::MIN_POSITIVE)
}

/// The absolute difference; infinite if one of the two is NaN.
fn difference(a: f32, b: f32) -> f64 {
    let difference = (f64::from(a) - f64::from(b)).abs();
    if difference.is_nan() { f64::INFINITY } else { difference }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(found: f32, expected: f32, bound: Bound, form: Form) -> Option<Check> {
        let record = |value, bound| Record::bounded("x", vec![0.0, value], bound);
        record(found, Bound::Same).compare(&record(expected, bound), "b", form)
    }

    #[test]
    fn strict_means_equal_bits() {
        let strict = |found, expected| check(found, expected, Bound::Within(1.0), Form::Strict).unwrap();
        assert!(strict(1.0, 1.0).ok);
        assert!(strict(f32::NAN, f32::from_bits(0xffc0_0001)).ok);
        let zero = strict(0.0, -0.0);
        assert!(!zero.ok && zero.differing == 1 && zero.items == 2);
        assert!(!strict(1.0, 1.0 + f32::EPSILON).ok);
        assert!(strict(f32::NAN, 1.0).max_abs.is_infinite());
        assert!(strict(2.0, 1.0).first_fault.unwrap().starts_with("item 1: 2e0"));
    }

    #[test]
    fn fused_means_within_the_bound() {
        let fused = |found, expected, bound| check(found, expected, bound, Form::Fused);
        let near = fused(1.25, 1.0, Bound::Within(0.25)).unwrap();
        assert!(near.ok && near.differing == 1 && near.max_abs == 0.25 && near.bound == 0.25);
        assert!(!fused(1.26, 1.0, Bound::Within(0.25)).unwrap().ok);
        assert!(!fused(1.1, 1.0, Bound::Each(vec![1.0, 0.01])).unwrap().ok);
        assert!(!fused(f32::NAN, 1.0, Bound::Within(9.0)).unwrap().ok);
        assert!(!fused(0.0, -0.0, Bound::Same).unwrap().ok);
        assert!(fused(7.0, 1.0, Bound::StrictOnly).is_none());
    }

    #[test]
    fn definitions_are_checked_on_every_backend() {
        let holds = |values: Vec<bool>| Record::exact("x", values);
        let check = holds(vec![true, false]).compare(&holds(vec![true, false]), "b", Form::Fused).unwrap();
        assert!(!check.ok && check.differing == 1);
    }
}
