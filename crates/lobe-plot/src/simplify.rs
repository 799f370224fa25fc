//! Fewer points for the same line.

/// Drops the points of a line that are within `tolerance` of the rest: D. Douglas and T. Peucker, "Algorithms for the
/// Reduction of the Number of Points Required to Represent a Digitized Line or its Caricature", Cartographica 10(2),
/// 1973.
pub(crate) fn simplify(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut is_kept = vec![false; points.len()];
    is_kept[0] = true;
    is_kept[points.len() - 1] = true;
    let mut spans = vec![(0, points.len() - 1)];
    while let Some((from, to)) = spans.pop() {
        let farthest = (from + 1..to)
            .map(|at| (distance(points[at], points[from], points[to]), at))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, at)) = farthest.filter(|(far, _)| *far > tolerance) {
            is_kept[at] = true;
            spans.extend([(from, at), (at, to)]);
        }
    }
    points.iter().zip(is_kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

/// The distance from a point to the segment between two others.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let share = if square > 0.0 { ((along[0] * from[0] + along[1] * from[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (from[0] - share * along[0]).hypot(from[1] - share * along[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_runs_vanish_and_corners_stay() {
        let line: Vec<[f64; 2]> =
            (0..=100).map(|i| [f64::from(i), if i < 50 { 0.0 } else { f64::from(i - 50) }]).collect();
        assert_eq!(simplify(&line, 0.01), [[0.0, 0.0], [50.0, 0.0], [100.0, 50.0]]);
        // A closed line has no direction from its first to its last point.
        let closed = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]];
        assert_eq!(simplify(&closed, 0.01), closed);
    }
}
