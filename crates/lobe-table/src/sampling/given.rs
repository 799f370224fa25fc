//! The known direction of a pair.

/// Which direction of a pair is known; the other one is sampled.
///
/// A table depends on the light in one way (sigma and psi) and on the viewer in another (theta and phi). Given the
/// viewer, the light is sampled as if the material were reciprocal, that is, from the distribution of light scattered
/// from the viewer's direction. The weight contains the true `f(wi, wo)`, so estimates are right for every material; if
/// the data are far from reciprocal, or a BTDF refracts, they are noisier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Given {
    /// `wi` is given and `wo` sampled.
    #[default]
    Light,
    /// `wo` is given and `wi` sampled.
    Viewer,
}

/// `(wi, wo)` from the known and the other direction, and vice versa.
#[inline(always)]
pub(super) fn pair<T>(given: Given, known: T, other: T) -> (T, T) {
    match given {
        Given::Light => (known, other),
        Given::Viewer => (other, known),
    }
}
