//! The trait that every model implements.

/// A reflecting surface with a colour of three channels.
pub trait Model {
    /// The BRDF at one pair of directions, in 1/sr, without the cosine. Zero if `wi` or `wo` is not above the surface.
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3];

    /// [`Model::f`] for one direction of the light and many viewers, in their order.
    ///
    /// A model that simulates light does so once for all viewers; other models gain nothing.
    fn f_many(&self, wi: [f64; 3], viewers: &[[f64; 3]]) -> Vec<[f64; 3]> {
        viewers.iter().map(|&wo| self.f(wi, wo)).collect()
    }
}

/// Checks shared by models.
#[cfg(test)]
pub(crate) mod testing {
    use super::Model;
    use crate::vec3::spherical;

    /// Directions over the upper hemisphere, none of them at a pole or in a plane of symmetry.
    pub fn directions() -> Vec<[f64; 3]> {
        (0..40).map(|i| spherical(0.03 + 1.5 * f64::from(i) / 39.0, 0.1 + 2.399 * f64::from(i))).collect()
    }

    /// Asserts `f(a, b) = f(b, a)` over many pairs.
    pub fn assert_reciprocal(model: &impl Model) {
        for &a in &directions() {
            for (there, b) in model.f_many(a, &directions()).into_iter().zip(directions()) {
                let back = model.f(b, a);
                for (x, y) in there.into_iter().zip(back) {
                    assert!((x - y).abs() <= 1e-11 * x.max(1.0), "f({a:?}, {b:?}) is {x} one way and {y} the other");
                }
            }
        }
    }

    /// Asserts that nothing is reflected through the surface.
    pub fn assert_dark_below(model: &impl Model) {
        let (up, down) = (spherical(0.4, 1.0), [0.6, 0.0, -0.8]);
        assert_eq!(model.f(down, up), [0.0; 3]);
        assert_eq!(model.f(up, down), [0.0; 3]);
        assert_ne!(model.f(up, up), [0.0; 3]);
    }
}
