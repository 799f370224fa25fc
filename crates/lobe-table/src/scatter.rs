//! Reflection or transmission.

/// The side of the surface on which the light leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scatter {
    /// A BRDF: `wi` and `wo` on the same side.
    Reflection,
    /// A BTDF: `wo` on the other side. The zenith of `(theta, phi)` is the mirror image, about the surface, of the
    /// straight-through (or refracted) ray, so tables of both kinds have the same geometry.
    Transmission,
}
