//! The values of a table outside its outermost knots.

/// The behaviour for a query outside the first and last knot of an axis.
///
/// An axis with a single knot is constant, whatever its policy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The query moves to the nearest knot.
    Clamp,
    /// The outermost cell is extrapolated linearly. Values can become negative.
    Extrapolate,
    /// The value is 0 outside the knots.
    Zero,
    /// The axis is a full circle: the query is wrapped into `[k0, k0 + 2 pi)`. If the last knot `kn` is below `k0 + 2
    /// pi`, the gap between them is one more cell, with the values of `k0` at its end.
    Periodic,
}

/// The policy of each axis, and whether negative results are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edges {
    /// Policies of sigma, psi, theta and phi.
    pub axes: [Edge; 4],
    /// Results below 0 become 0, after the interpolation.
    pub non_negative: bool,
}

impl Default for Edges {
    /// Clamped in sigma and theta, periodic in psi and phi, never negative.
    fn default() -> Self {
        Edges { axes: [Edge::Clamp, Edge::Periodic, Edge::Clamp, Edge::Periodic], non_negative: true }
    }
}

impl Edges {
    /// Linear extrapolation beyond every end, with negative values kept: the rule of the libbsdf library, which also
    /// does not join the ends of psi and phi.
    pub fn extrapolate() -> Self {
        Edges { axes: [Edge::Extrapolate; 4], non_negative: false }
    }

    /// 0 if sigma or theta is outside the knots, periodic in psi and phi, never negative.
    pub fn zero() -> Self {
        Edges { axes: [Edge::Zero, Edge::Periodic, Edge::Zero, Edge::Periodic], non_negative: true }
    }
}

/// The distance outside its knots, in radians, at which a query still counts as inside: a tolerance for knots and
/// angles rounded in a file.
pub(crate) const ROUNDING: f64 = 1e-6;
