//! The reference evaluation: one query at a time, in `f64`, written to be readable.
//!
//! Everything faster in this workspace is tested against this.

use std::f64::consts::FRAC_PI_2;

use super::data::Data;
use crate::grid::neighbours::{Neighbours, corners};
use crate::specular::coords::directions_to_angles;
use crate::{Edge, Edges, Scatter};

/// Evaluates `f(wi, wo)` in 1/sr into `out`, one value per channel.
///
/// `wi` points to the light and `wo` to the viewer, unit vectors that point away from the surface, normal on +z. A
/// reflection table gives 0 unless both have `z > 0`. A transmission table uses `|z|` of both, because its values are
/// stored mirrored to the upper hemisphere, and gives 0 if one of them is 0; the material that owns the table decides
/// which side the light is on. A direction with a NaN or infinite component gives 0.
///
/// # Panics
/// If the length of `out` is not the number of channels.
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

/// The table at sigma, psi, theta and phi in radians, in 1/sr, ignoring the horizon: multilinear in the angles, with
/// the policy of each axis outside its knots.
///
/// # Panics
/// If the length of `out` is not the number of channels.
pub fn eval_angles(samples: &Data, edges: &Edges, angles: [f64; 4], out: &mut [f64]) {
    let channels = samples.channels().count();
    assert_eq!(out.len(), channels, "one output per channel");
    out.fill(0.0);
    let mut cell = [Neighbours::ONLY; 4];
    for (axis, found) in cell.iter_mut().enumerate() {
        match Neighbours::find(&samples.knots()[axis], edges.axes[axis], angles[axis]) {
            Some(neighbours) => *found = neighbours,
            None => return,
        }
    }
    corners(&cell, |node, weight| {
        for (sum, value) in out.iter_mut().zip(samples.texel(node)) {
            *sum += weight * f64::from(*value);
        }
    });
    if edges.non_negative {
        for value in out {
            *value = value.max(0.0);
        }
    }
}

/// The polar angle in `[0, pi/2]` of the zenith of `(theta, phi)` for light at `sigma`: `sigma` plus the refraction
/// offset, if the table has offsets, interpolated with the policy of the sigma axis ([`Edge::Zero`] as
/// [`Edge::Clamp`]).
pub fn zenith(samples: &Data, edges: &Edges, sigma: f64) -> f64 {
    let Some(offsets) = samples.refraction() else { return sigma };
    let edge = if edges.axes[0] == Edge::Zero { Edge::Clamp } else { edges.axes[0] };
    let offset = Neighbours::find(&samples.knots()[0], edge, sigma)
        .map_or(0.0, |at| at.weights[0] * offsets[at.nodes[0]] + at.weights[1] * offsets[at.nodes[1]]);
    (sigma + offset).clamp(0.0, FRAC_PI_2)
}
