//! One sample at a time in `f64`, with the functions of the standard library: the reference for the lanes.

use std::f64::consts::TAU;

use super::distribution::Distribution;
use super::slices::Slices;
use crate::Scatter;
use crate::grid::axis::Axis;
use crate::grid::neighbours::Neighbours;
use crate::specular::coords;

impl Distribution {
    /// Like [`draw_lanes`](Distribution::draw_lanes), in `f64`; `None` if `known` is not above the surface. Sums and
    /// knots are those of the lanes, rounded to `f32`; everything else is exact.
    pub fn draw_reference(&self, known: [f64; 3], u: [f64; 2]) -> Option<([f64; 3], f64)> {
        let [x, y, z] = known;
        let (side, up) = match self.surface.scatter {
            Scatter::Reflection => (1.0, z),
            Scatter::Transmission => (-z.signum(), z.abs()),
        };
        if !(up > 0.0 && x.hypot(y).is_finite() && up.is_finite()) {
            return None;
        }
        let offset = |sigma: f64| self.surface.refraction.as_ref().map_or(0.0, |offset| offset.at(sigma));
        let zenith = |sigma: f64| sigma + offset(sigma);
        let [sigma, psi, ..] = coords::directions_to_angles([x, y, up], [0.0, 0.0, 1.0], zenith);

        let blend = self.blend(sigma, psi);
        let slices = &self.slices;
        let (rows, columns) = (1 << slices.grid.row_bits, 1 << slices.grid.column_bits);
        let sum = |sums: &[f32], entry: usize| {
            let texel = &sums[entry * slices.width..][..slices.width];
            texel.iter().zip(&blend.weights).map(|(&sum, weight)| f64::from(sum) * weight).sum::<f64>()
        };
        let first = blend.block * rows;
        let row = invert(u[0], rows, |row| sum(slices.rows.as_slice(), first + row));
        let first = (first + row.cell) * columns;
        let column = invert(u[1], columns, |column| sum(slices.columns.as_slice(), first + column));

        let (phi, row_width) = within(&slices.grid.phi, &row);
        let (v, column_width) = self.within_column(slices, &column);
        let height = height(zenith(sigma).clamp(0.0, std::f64::consts::FRAC_PI_2), phi);
        let theta = 2.0 * (0.5 * v * height).max(0.0).sqrt().min(1.0).asin();
        let (_, [x, y, z]) = coords::angles_to_directions([sigma, psi, theta, phi], zenith);
        Some(([x, y, side * z.max(0.0)], column.mass / row.total / (row_width * column_width * height)))
    }

    fn within_column(&self, slices: &Slices, column: &Inverted) -> (f64, f64) {
        let [low, per_v] = slices.grid.columns[column.cell].map(f64::from);
        (low + column.fraction / per_v, 1.0 / per_v)
    }

    fn blend(&self, sigma: f64, psi: f64) -> Blend {
        let (sigma, up) = cell(&self.sigma, sigma);
        match &self.psi {
            None => Blend { block: sigma, weights: [1.0 - up, up, 0.0, 0.0] },
            Some(axis) => {
                let (psi, on) = cell(axis, psi);
                let weights = [(1.0 - up) * (1.0 - on), (1.0 - up) * on, up * (1.0 - on), up * on];
                Blend { block: sigma * axis.cells().len() + psi, weights }
            }
        }
    }
}

/// The slices around an incident direction.
struct Blend {
    block: usize,
    weights: [f64; 4],
}

/// The place of a number among cumulative sums.
struct Inverted {
    cell: usize,
    fraction: f64,
    mass: f64,
    total: f64,
}

/// The cell of `0..count` at whose end `sum` first exceeds the share `u` of its last value.
fn invert(u: f64, count: usize, sum: impl Fn(usize) -> f64) -> Inverted {
    let total = sum(count - 1);
    let target = u * total;
    let (mut cell, mut left) = (0, count - 1);
    while left > 0 {
        let half = left / 2;
        if sum(cell + half) <= target {
            cell += half + 1;
            left -= half + 1;
        } else {
            left = half;
        }
    }
    let below = if cell == 0 { 0.0 } else { sum(cell - 1) };
    let mass = (sum(cell) - below).max(f64::from(f32::MIN_POSITIVE));
    Inverted { cell, fraction: ((target - below) / mass).clamp(0.0, 1.0), mass, total }
}

/// The cell of an angle and the fraction into it, never outside.
fn cell(axis: &Axis, angle: f64) -> (usize, f64) {
    let knots = axis.knots();
    let first = f64::from(knots[0]);
    let angle = if axis.edge() == crate::Edge::Periodic && angle < first { angle + TAU } else { angle };
    let Neighbours { nodes: [cell, _], weights: [_, fraction] } = Neighbours::held(knots, angle);
    (cell, fraction)
}

/// A place in a cell of an axis, and the width of the cell.
fn within(axis: &Axis, at: &Inverted) -> (f64, f64) {
    let [low, high] = [at.cell, at.cell + 1].map(|knot| f64::from(axis.knots()[knot]));
    (low + at.fraction * (high - low), high - low)
}

/// `1 - cos theta_max` (see [`incident`](super::incident)) about a zenith at a polar angle.
fn height(zenith: f64, phi: f64) -> f64 {
    let (sin, cos) = zenith.sin_cos();
    let (a, cos2) = (sin * phi.cos(), cos * cos);
    let q = a.hypot(cos);
    let sum = q + a.abs();
    (if a < 0.0 { cos2 / sum } else { sum }) / q
}
