//! The loop of models that are evaluated pair by pair.

use lobe::Directions;

/// Has `at` fill the values of each pair of directions, `size` of them.
///
/// # Panics
///
/// If there are not as many `wo` as `wi`, or not `size` values for each.
pub(super) fn each_pair(
    wi: Directions<'_>,
    wo: Directions<'_>,
    size: usize,
    out: &mut [f32],
    at: impl Fn([f64; 3], [f64; 3], &mut [f32]),
) {
    assert_eq!(wi.count(), wo.count(), "as many wi as wo");
    assert_eq!(out.len(), size * wi.count(), "{size} values per pair");
    for (pair, values) in out.chunks_exact_mut(size).enumerate() {
        at(wi.get(pair).map(f64::from), wo.get(pair).map(f64::from), values);
    }
}
