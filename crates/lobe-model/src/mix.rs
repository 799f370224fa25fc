//! Two materials in one.

use crate::Model;

/// A surface of invisibly small patches, a `share` of which is `b` and the rest `a`.
///
/// Reciprocal and energy conserving if both parts are, unlike the plain sum of a diffuse and a glossy model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mix<A, B> {
    /// The material of the rest of the area.
    pub a: A,
    /// The material of `share` of the area.
    pub b: B,
    /// Area of `b`, in `[0, 1]`.
    pub share: f64,
}

impl<A: Model, B: Model> Model for Mix<A, B> {
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        let (a, b) = (self.a.f(wi, wo), self.b.f(wi, wo));
        std::array::from_fn(|c| (1.0 - self.share) * a[c] + self.share * b[c])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Lambert;

    #[test]
    fn shares_add_up() {
        let model = Mix { a: Lambert { albedo: [1.0, 0.5, 0.0] }, b: Lambert { albedo: [0.0, 0.5, 1.0] }, share: 0.25 };
        let up = [0.0, 0.0, 1.0];
        let expected = [0.75, 0.5, 0.25].map(|a: f64| a / std::f64::consts::PI);
        for (x, y) in model.f(up, up).into_iter().zip(expected) {
            assert!((x - y).abs() < 1e-15, "{x} instead of {y}");
        }
    }
}
