//! Directions near each other, to distinguish measured values from extrapolated ones.

use std::collections::HashMap;

/// Angles that differ by less than this, in radians, are equal.
pub(crate) const SAME: f64 = 1e-4;

/// The direction at a polar angle and an azimuth.
pub(crate) fn direction(theta: f64, phi: f64) -> [f64; 3] {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// `true` if light at this polar angle is between the measured angles, or at one of them. If there is only one, every
/// other angle is extrapolated.
pub(crate) fn spans(thetas: &[f64], theta: f64) -> bool {
    let first = thetas.first().copied().unwrap_or(0.0);
    let last = thetas.last().copied().unwrap_or(0.0);
    let is_between = thetas.len() > 1 && (first - SAME..=last + SAME).contains(&theta);
    is_between || thetas.iter().any(|knot| (knot - theta).abs() < SAME)
}

/// Finds whether a direction has others near it, with cells as wide as that distance.
pub(crate) struct Near {
    cells: HashMap<[i32; 3], Vec<[f64; 3]>>,
    width: f64,
    cos: f64,
}

impl Near {
    /// `reach` is the distance that counts as near, in radians.
    pub(crate) fn new(directions: Vec<[f64; 3]>, reach: f64) -> Self {
        // The chord of the angle, so that a neighbour is at most one cell away.
        let mut near = Near { cells: HashMap::new(), width: (2.0 * (0.5 * reach).sin()).max(1e-3), cos: reach.cos() };
        for direction in directions {
            near.cells.entry(near.cell(direction)).or_default().push(direction);
        }
        near
    }

    fn cell(&self, direction: [f64; 3]) -> [i32; 3] {
        direction.map(|c| (c / self.width).floor() as i32)
    }

    pub(crate) fn has_neighbour(&self, direction: [f64; 3]) -> bool {
        let [x, y, z] = self.cell(direction);
        let around = (0..27).filter_map(|at| self.cells.get(&[x + at % 3 - 1, y + at / 3 % 3 - 1, z + at / 9 - 1]));
        around.flatten().any(|place| dot(*place, direction) >= self.cos)
    }
}

/// One and a half times the distance at which most directions have a neighbour, within limits.
pub(crate) fn reach(outgoing: &[[f64; 2]]) -> f64 {
    let directions: Vec<[f64; 3]> =
        outgoing.iter().map(|[theta, phi]| [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]).collect();
    // A few hundred directions are enough to estimate it.
    let step = directions.len().div_ceil(200);
    let mut nearest: Vec<f64> = Vec::new();
    for a in directions.iter().step_by(step) {
        let others = directions.iter().map(|b| dot(*a, *b)).filter(|cos| *cos < 1.0 - 1e-9);
        nearest.push(others.fold(-1.0, f64::max).acos());
    }
    nearest.sort_by(f64::total_cmp);
    let most = nearest.get(nearest.len() * 9 / 10).copied().unwrap_or(0.0);
    (1.5 * most).clamp(2.5_f64.to_radians(), 15_f64.to_radians())
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_found_across_cells_and_nowhere_else() {
        let direction = |degrees: f64| super::direction(degrees.to_radians(), 0.7);
        let near = Near::new((0..9).map(|i| direction(10.0 * f64::from(i))).collect(), 3_f64.to_radians());
        for tenths in 0..880 {
            let degrees = 0.1 * f64::from(tenths) + 0.05;
            let distance = (degrees - 10.0 * (degrees / 10.0).round().min(8.0)).abs();
            assert_eq!(near.has_neighbour(direction(degrees)), distance < 3.0, "{degrees}");
        }
    }
}
