//! The reference evaluation: one query at a time, in `f64`, written for the reader.
//!
//! Everything faster in this workspace is tested against this.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::grid::edges::ROUNDING;
use crate::specular::Data;
use crate::specular::coords::directions_to_angles;
use crate::{Edge, Edges, Scatter};

/// Evaluates `f(wi, wo)` in 1/sr into `out`, one value a channel.
///
/// `wi` points to the light and `wo` to the viewer, unit vectors that point away from the surface, normal on +z. A
/// reflection table answers 0 unless both have `z > 0`. A transmission table takes `|z|` of both, since its values are
/// stored mirrored up at the surface, and answers 0 where one of them is 0: which side the light is on is the business
/// of the material that owns the table. A direction with a NaN or infinite component gives 0.
///
/// # Panics
/// Where `out` is not as long as there are channels.
pub fn eval(samples: &Data, edges: &Edges, wi: [f64; 3], wo: [f64; 3], out: &mut [f64]) {
    let fold = |v: [f64; 3]| match samples.scatter() {
        Scatter::Reflection => v,
        Scatter::Transmission => [v[0], v[1], v[2].abs()],
    };
    let (wi, wo) = (fold(wi), fold(wo));
    let finite = wi.iter().chain(&wo).all(|c| c.is_finite());
    if !(finite && wi[2] > 0.0 && wo[2] > 0.0) {
        return out.fill(0.0);
    }
    let angles = directions_to_angles(wi, wo, |sigma| zenith(samples, edges, sigma));
    eval_angles(samples, edges, angles, out);
}

/// The table at sigma, psi, theta and phi in radians, in 1/sr, with no regard to the horizon: multilinear in the
/// angles, with the policy of each axis outside its knots.
///
/// # Panics
/// Where `out` is not as long as there are channels.
pub fn eval_angles(samples: &Data, edges: &Edges, angles: [f64; 4], out: &mut [f64]) {
    let channels = samples.channels().count();
    assert_eq!(out.len(), channels, "one output a channel");
    out.fill(0.0);
    let mut cells = [Cell::constant(); 4];
    for axis in 0..4 {
        match Cell::find(&samples.knots()[axis], edges.axes[axis], angles[axis]) {
            Some(cell) => cells[axis] = cell,
            None => return,
        }
    }
    for corner in 0..16 {
        let upper = |axis: usize| corner >> axis & 1;
        let weight: f64 = (0..4).map(|axis| cells[axis].weights[upper(axis)]).product();
        if weight != 0.0 {
            let texel = samples.texel(std::array::from_fn(|axis| cells[axis].nodes[upper(axis)]));
            for (sum, value) in out.iter_mut().zip(texel) {
                *sum += weight * f64::from(*value);
            }
        }
    }
    if edges.non_negative {
        for value in out {
            *value = value.max(0.0);
        }
    }
}

/// The polar angle in `[0, pi/2]` of the zenith of `(theta, phi)` for light at `sigma`: `sigma` plus the refraction
/// offset, where the table has offsets, interpolated with the policy of the sigma axis ([`Edge::Zero`] as
/// [`Edge::Clamp`]).
pub fn zenith(samples: &Data, edges: &Edges, sigma: f64) -> f64 {
    let Some(offsets) = samples.refraction() else { return sigma };
    let edge = if edges.axes[0] == Edge::Zero { Edge::Clamp } else { edges.axes[0] };
    let offset = Cell::find(&samples.knots()[0], edge, sigma)
        .map_or(0.0, |Cell { nodes, weights }| weights[0] * offsets[nodes[0]] + weights[1] * offsets[nodes[1]]);
    (sigma + offset).clamp(0.0, FRAC_PI_2)
}

/// The two nodes about a query on one axis, and how much each counts.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    nodes: [usize; 2],
    weights: [f64; 2],
}

impl Cell {
    fn constant() -> Self {
        Cell { nodes: [0, 0], weights: [1.0, 0.0] }
    }

    /// `None` where the value is 0 because the query is outside.
    fn find(knots: &[f64], edge: Edge, x: f64) -> Option<Self> {
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        if knots.len() == 1 {
            return Some(Cell::constant());
        }
        let x = match edge {
            Edge::Extrapolate => x,
            Edge::Zero if x < first - ROUNDING || x > last + ROUNDING => return None,
            Edge::Clamp | Edge::Zero => x.clamp(first, last),
            Edge::Periodic => {
                let x = wrap(x, first);
                let end = first + TAU;
                if last < end - ROUNDING && x > last {
                    return Some(Cell::between([knots.len() - 1, 0], [last, end], x));
                }
                x.min(last)
            }
        };
        let upper = knots.partition_point(|&knot| knot < x).clamp(1, knots.len() - 1);
        Some(Cell::between([upper - 1, upper], [knots[upper - 1], knots[upper]], x))
    }

    fn between(nodes: [usize; 2], ends: [f64; 2], x: f64) -> Self {
        let fraction = (x - ends[0]) / (ends[1] - ends[0]);
        Cell { nodes, weights: [1.0 - fraction, fraction] }
    }
}

/// `x` in `[start, start + 2 pi)`, untouched where it already is.
fn wrap(x: f64, start: f64) -> f64 {
    if (start..start + TAU).contains(&x) {
        return x;
    }
    let wrapped = start + (x - start).rem_euclid(TAU);
    // The remainder of a tiny negative number rounds to the full circle.
    if wrapped < start + TAU { wrapped } else { start }
}
