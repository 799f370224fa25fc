//! What a table answers outside its outermost knots.

/// What happens to a query outside the first and last knot of one axis.
///
/// An axis with a single knot is constant, whatever its policy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The query moves to the nearest knot.
    Clamp,
    /// The outermost cell continues in a straight line. Values can become negative.
    Extrapolate,
    /// The value is 0 outside the knots.
    Zero,
    /// The axis is a full circle: the query is wrapped into `[k0, k0 + 2 pi)`, and where the last knot `kn` lies below
    /// `k0 + 2 pi` the gap between them is one more cell, with the values of `k0` at its end.
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
    /// Straight lines beyond every end and negative values kept: the rule of the libbsdf library, which also does not
    /// join the ends of psi and phi.
    pub fn extrapolate() -> Self {
        Edges { axes: [Edge::Extrapolate; 4], non_negative: false }
    }

    /// 0 if sigma or theta lies outside the knots, periodic in psi and phi, never negative.
    pub fn zero() -> Self {
        Edges { axes: [Edge::Zero, Edge::Periodic, Edge::Zero, Edge::Periodic], non_negative: true }
    }
}

/// How far outside its knots, in radians, a query still counts as inside: room for knots and angles rounded in a file.
pub(crate) const ROUNDING: f64 = 1e-6;
