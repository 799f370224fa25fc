//! Look-up in knots for the reference evaluators.

/// The interval of ascending knots that `x` lies in and the fraction in it, both clamped; `(0, 0)` for a single knot.
pub(crate) fn cell(knots: &[f32], x: f64) -> (usize, f64) {
    if knots.len() < 2 {
        return (0, 0.0);
    }
    let index = knots.partition_point(|k| f64::from(*k) <= x).saturating_sub(1).min(knots.len() - 2);
    let (k0, k1) = (f64::from(knots[index]), f64::from(knots[index + 1]));
    (index, ((x - k0) / (k1 - k0)).clamp(0.0, 1.0))
}
