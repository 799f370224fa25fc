//! Rays against a periodic surface of triangles.

use super::weave::{Thread, Weave};
use crate::vec3::{Frame, Vec3, cross, normalize};

/// A grid of square cells, each of two triangles that meet on the diagonal from its lower left corner.
///
/// Lengths are in cells; the field repeats after `side` cells. Neighbouring triangles share their corners, so the
/// surface has no holes: a ray that is above it at one end of an interval and below it at the other has hit it.
pub(super) struct HeightField {
    side: usize,
    heights: Vec<f64>,
    /// The highest corner of each cell, to skip cells that a ray passes over.
    cell_tops: Vec<f64>,
    /// The yarn and the fibre frame of each triangle, of which there are twice as many as cells.
    facets: Vec<(Thread, Frame)>,
    lowest: f64,
    highest: f64,
}

/// A point of the surface.
pub(super) struct Hit {
    /// The position, inside the first period.
    pub point: Vec3,
    /// Index of the triangle.
    pub facet: usize,
}

/// The distance that rounding may put a point below the surface, in cells. Positions up to a thousand cells have errors
/// of 1e-13, which the steepest triangles magnify some ten times.
const ROUNDING: f64 = 1e-10;

/// A horizontal ray can run along a groove forever. After this many cells it counts as gone.
const LONGEST: usize = 1 << 16;

impl HeightField {
    /// Samples one period of a weave with `resolution` cells per yarn.
    pub fn new(weave: &Weave, resolution: usize) -> HeightField {
        let side = resolution * weave.period() as usize;
        let unit = resolution as f64;
        let heights: Vec<f64> =
            (0..side * side).map(|i| weave.top((i % side) as f64 / unit, (i / side) as f64 / unit).1 * unit).collect();
        let extreme = |pick: fn(f64, f64) -> f64| heights.iter().copied().reduce(pick).unwrap_or(0.0);
        let (lowest, highest) = (extreme(f64::min), extreme(f64::max));
        let mut field = HeightField { side, heights, cell_tops: Vec::new(), facets: Vec::new(), lowest, highest };
        for i in 0..side * side {
            let (column, row) = (i % side, i / side);
            let corners = field.corners(column, row);
            field.cell_tops.push(corners.into_iter().fold(f64::MIN, f64::max));
            for upper in [false, true] {
                let [along_x, along_y] = slopes(corners, upper);
                let (a, b) = if upper { (1.0 / 3.0, 2.0 / 3.0) } else { (2.0 / 3.0, 1.0 / 3.0) };
                let (thread, _) = weave.top((column as f64 + a) / unit, (row as f64 + b) / unit);
                let [x, y] = weave.fibre(thread);
                let normal = normalize([-along_x, -along_y, 1.0]);
                let fibre = normalize([x, y, x * along_x + y * along_y]);
                field.facets.push((thread, Frame([fibre, cross(normal, fibre), normal])));
            }
        }
        field
    }

    /// Yarn and frame (fibre, across, normal) of a triangle.
    pub fn facet(&self, index: usize) -> &(Thread, Frame) {
        &self.facets[index]
    }

    /// A point above the surface, for two numbers in `[0, 1)`.
    pub fn above(&self, u: [f64; 2]) -> Vec3 {
        [u[0] * self.side as f64, u[1] * self.side as f64, self.highest]
    }

    /// The first point that a ray hits. `origin` must be on or above the surface.
    pub fn first_hit(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        let step = [0, 1].map(|axis| if direction[axis] > 0.0 { 1.0_f64 } else { -1.0 });
        let inverse = direction.map(f64::recip);
        let side = self.side as f64;
        // The corner of the current cell, of the endless surface and of its first period.
        let mut corner = [origin[0].floor(), origin[1].floor()];
        let mut cell = corner.map(|c| c.rem_euclid(side) as usize);
        // A downward ray is below everything here at the latest; this ends vertical rays, which never leave a cell.
        let end = if direction[2] < 0.0 { (self.lowest - 1.0 - origin[2]) * inverse[2] } else { f64::INFINITY };
        let mut t = 0.0;
        for _ in 0..LONGEST {
            let leave = [0, 1].map(|axis| {
                if direction[axis] == 0.0 {
                    f64::INFINITY
                } else {
                    (corner[axis] + step[axis].max(0.0) - origin[axis]) * inverse[axis]
                }
            });
            let axis = usize::from(leave[1] < leave[0]);
            let next = leave[axis].min(end).max(t);
            let z = [origin[2] + t * direction[2], origin[2] + next * direction[2]];
            if z[0].min(z[1]) <= self.cell_tops[cell[1] * self.side + cell[0]] {
                let local = [origin[0] - corner[0], origin[1] - corner[1], origin[2]];
                if let Some(hit) = self.hit_in_cell(cell, local, direction, [t, next]) {
                    return Some(hit);
                }
            }
            if next == f64::INFINITY || (direction[2] >= 0.0 && z[1] > self.highest) {
                return None;
            }
            t = next;
            corner[axis] += step[axis];
            cell[axis] = match (cell[axis], step[axis] > 0.0) {
                (last, true) if last + 1 == self.side => 0,
                (here, true) => here + 1,
                (0, false) => self.side - 1,
                (here, false) => here - 1,
            };
        }
        None
    }

    /// Searches for the surface inside one cell, between two ray parameters. `origin` is relative to the corner of the
    /// cell.
    fn hit_in_cell(&self, cell: [usize; 2], origin: Vec3, direction: Vec3, [from, to]: [f64; 2]) -> Option<Hit> {
        let corners = self.corners(cell[0], cell[1]);
        let at = |t: f64| [0, 1, 2].map(|axis| origin[axis] + t * direction[axis]);
        // Positive to the right of the diagonal.
        let right = [from, to].map(|t| at(t)[0] - at(t)[1]);
        let crosses = right[0] * right[1] < 0.0;
        let middle = if crosses { from + (to - from) * right[0] / (right[0] - right[1]) } else { to };
        let starts_right = right[0] + if crosses { 0.0 } else { right[1] } > 0.0;
        for (part, [from, to]) in [[from, middle], [middle, to]].into_iter().enumerate().take(1 + usize::from(crosses))
        {
            let upper = starts_right == (part == 1);
            let [along_x, along_y] = slopes(corners, upper);
            let above = |[x, y, z]: Vec3| z - corners[0] - along_x * x - along_y * y;
            let [first, last] = [above(at(from)).max(0.0), above(at(to))];
            if last < -ROUNDING {
                let [x, y, _] = at(from + (to - from) * first / (first - last));
                let z = corners[0] + along_x * x + along_y * y;
                let facet = 2 * (cell[1] * self.side + cell[0]) + usize::from(upper);
                return Some(Hit { point: [x + cell[0] as f64, y + cell[1] as f64, z], facet });
            }
        }
        None
    }

    /// Heights at the corners of a cell: lower left, lower right, upper left, upper right.
    fn corners(&self, column: usize, row: usize) -> [f64; 4] {
        let after = |i: usize| if i + 1 == self.side { 0 } else { i + 1 };
        let (low, high) = (row * self.side, after(row) * self.side);
        [low + column, low + after(column), high + column, high + after(column)].map(|i| self.heights[i])
    }
}

/// Slopes along x and y of the lower right or the upper left triangle of a cell.
fn slopes([low_left, low_right, high_left, high_right]: [f64; 4], upper: bool) -> [f64; 2] {
    if upper { [high_right - high_left, high_left - low_left] } else { [low_right - low_left, high_right - low_right] }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, TAU};

    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg32;

    use super::super::weave::Ply;
    use super::*;
    use crate::vec3::{dot, spherical};

    fn field() -> HeightField {
        let plies = [Ply { along: 1, across: 3.0, depth: 0.05 }, Ply::SMOOTH];
        HeightField::new(&Weave { over: 2, under: 1, crimp: 0.15, roundness: 0.3, plies }, 16)
    }

    /// The height of the surface at any point, directly from the corners.
    fn height(field: &HeightField, x: f64, y: f64) -> f64 {
        let cell = [x, y].map(|v| v.floor().rem_euclid(field.side as f64) as usize);
        let (x, y) = (x - x.floor(), y - y.floor());
        let corners = field.corners(cell[0], cell[1]);
        let [along_x, along_y] = slopes(corners, y > x);
        corners[0] + along_x * x + along_y * y
    }

    #[test]
    fn agrees_with_small_steps_along_the_ray() {
        let field = field();
        let mut rng = Pcg32::seed_from_u64(1);
        let (mut hits, mut misses) = (0, 0);
        for _ in 0..300 {
            let start = field.above([rng.random(), rng.random()]);
            let (cos, phi): (f64, f64) = (rng.random(), rng.random());
            let down = spherical((-cos).acos(), TAU * phi);
            let first = field.first_hit(start, down).expect("a ray that goes down meets the cloth");
            let (_, frame) = field.facet(first.facet);
            assert!(dot(frame.0[2], down) < 0.0, "met from behind");
            // Continue from there in a random direction away from the facet.
            let (cos, phi): (f64, f64) = (rng.random(), rng.random());
            let direction = frame.to_world(spherical(cos.acos(), TAU * phi));
            let found = field.first_hit(first.point, direction);
            let step = 2e-3;
            let at = |t: f64| [0, 1, 2].map(|axis| first.point[axis] + t * direction[axis]);
            let under = (1..40_000).map(|i| f64::from(i) * step).find(|&t| {
                let [x, y, z] = at(t);
                z < height(&field, x, y) - 1e-9
            });
            match (found, under) {
                (Some(hit), Some(t)) => {
                    let [x, y, z] = at(t - 0.5 * step);
                    let side = field.side as f64;
                    let apart = (x.rem_euclid(side) - hit.point[0]).abs().min(1.0)
                        + (y.rem_euclid(side) - hit.point[1]).abs().min(1.0)
                        + (z - hit.point[2]).abs();
                    // A ray that only cuts a corner stays under the surface for less than a step.
                    assert!(apart < 2.0 * step || height(&field, x, y) - z < 2.0 * step, "{apart}");
                    hits += 1;
                }
                (None, None) => misses += 1,
                (found, under) => {
                    assert!(found.is_some() && under.is_none(), "stepping found {under:?}, the ray nothing")
                }
            }
        }
        assert!(hits > 30 && misses > 30, "{hits} hits, {misses} misses");
    }

    #[test]
    fn rays_do_not_hit_the_triangle_they_leave() {
        let field = field();
        let mut rng = Pcg32::seed_from_u64(2);
        for _ in 0..20_000 {
            let start = field.above([rng.random(), rng.random()]);
            let hit = field.first_hit(start, [0.0, 0.0, -1.0]).expect("straight down");
            // Along the facet, where rounding decides.
            let (_, frame) = field.facet(hit.facet);
            let direction = frame.to_world(spherical(FRAC_PI_2, TAU * rng.random::<f64>()));
            let next = field.first_hit(hit.point, direction);
            assert!(next.is_none_or(|next| next.facet != hit.facet), "{:?} is left and hit again", hit.point);
        }
    }

    #[test]
    fn vertical_and_level_rays_end() {
        let field = field();
        let start = field.above([0.3, 0.7]);
        let hit = field.first_hit(start, [0.0, 0.0, -1.0]).expect("straight down");
        assert!((hit.point[2] - height(&field, start[0], start[1])).abs() < 1e-9);
        assert!(field.first_hit(hit.point, [0.0, 0.0, 1.0]).is_none());
        assert!(field.first_hit(start, [1.0, 0.0, 0.0]).is_none());
    }
}
