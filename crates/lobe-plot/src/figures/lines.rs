//! Lines of partly measured values.

use crate::simplify::simplify;

/// Splits a line into measured and unmeasured runs. Neighbouring runs share a point, so no gap shows.
pub(super) fn runs(points: &[[f64; 2]], is_measured: &[bool], tolerance: f64) -> Vec<(bool, Vec<[f64; 2]>)> {
    let mut runs: Vec<(bool, Vec<[f64; 2]>)> = Vec::new();
    for (&point, &measured) in points.iter().zip(is_measured) {
        match runs.last_mut() {
            Some((is_solid, run)) if *is_solid == measured => run.push(point),
            Some((_, run)) => {
                let joint = run[run.len() - 1];
                runs.push((measured, vec![joint, point]));
            }
            None => runs.push((measured, vec![point])),
        }
    }
    runs.into_iter().map(|(solid, run)| (solid, simplify(&run, tolerance))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_meet() {
        let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 5.0], [3.0, 0.0]];
        let found = runs(&points, &[false, false, true, true], 0.0);
        assert_eq!(found, [(false, points[..2].to_vec()), (true, points[1..].to_vec())]);
    }
}
