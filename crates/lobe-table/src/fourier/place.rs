//! The place of a pair of directions among the knots, in `f64`, for both the reference and the lanes.

use super::data::Data;
use crate::{Aspect, Scatter, Side};

/// A pair of directions in the coordinates of the series.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The knots of the light and of the viewer.
    pub(super) light: Spline,
    pub(super) viewer: Spline,
    /// The cosine of the azimuth between the direction in which light travels and the direction to the viewer.
    pub(super) cos_phi: f64,
    /// The factor from the value of the series to `f`.
    pub(super) scale: f64,
}

/// The knots that a cubic spline blends, and their weights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spline {
    /// The second of the four knots.
    knot: usize,
    weights: [f64; 4],
}

/// Vectors shorter or longer than this have no direction, as in the other representations.
const LENGTHS: [f64; 2] = [1e-15, 1e15];
/// Below this cosine, a direction grazes the surface and has no value, because `f` is a quotient by the cosine.
const GRAZING: f64 = 1e-7;
/// Below this sine, a direction is so near the normal that it has no azimuth.
const POLE: f64 = 1e-15;

impl Place {
    /// Finds the place of `wi` and `wo`, which may have any length. `None` if there is no value, because a direction
    /// has no length or grazes the surface.
    pub(super) fn find(data: &Data, wi: [f64; 3], wo: [f64; 3]) -> Option<Self> {
        let ([ix, iy, iz], [ox, oy, oz]) = (unit(wi)?, unit(wo)?);
        let (light, viewer) = (-iz, oz);
        if light.abs() < GRAZING || viewer.abs() < GRAZING {
            return None;
        }
        let across = ((ix * ix + iy * iy).sqrt(), (ox * ox + oy * oy).sqrt());
        let cos_phi = match across.0 > POLE && across.1 > POLE {
            true => (-(ix * ox + iy * oy) / (across.0 * across.1)).clamp(-1.0, 1.0),
            false => 1.0,
        };
        let side = if iz > 0.0 { Side::Front } else { Side::Back };
        let scatter = if iz * oz > 0.0 { Scatter::Reflection } else { Scatter::Transmission };
        let mu = &data.parts().mu;
        Some(Place {
            light: Spline::at(mu, light),
            viewer: Spline::at(mu, viewer),
            cos_phi,
            scale: data.radiance(Aspect { scatter, light: side }) / light.abs(),
        })
    }

    /// The pair of knots at one of the 16 corners, the viewer's first, and its weight; `None` if it has none.
    pub(super) fn corner(&self, corner: usize) -> Option<([usize; 2], f64)> {
        let (viewer, light) = (corner / 4, corner % 4);
        let weight = self.viewer.weights[viewer] * self.light.weights[light];
        // A knot beyond the ends has no weight.
        (weight != 0.0).then(|| ([self.viewer.knot + viewer - 1, self.light.knot + light - 1], weight))
    }
}

fn unit(direction: [f64; 3]) -> Option<[f64; 3]> {
    let [x, y, z] = direction;
    let length = (x * x + y * y + z * z).sqrt();
    (LENGTHS[0] < length && length < LENGTHS[1]).then(|| direction.map(|c| c / length))
}

impl Spline {
    /// The Catmull-Rom spline of pbrt: through the knots, with slopes from their neighbours, one-sided at the ends. A
    /// place outside the knots counts as that of the first or last.
    fn at(knots: &[f32], x: f64) -> Self {
        let knot = |at: usize| f64::from(knots[at]);
        let last = knots.len() - 1;
        let x = x.clamp(knot(0), knot(last));
        let at = knots.partition_point(|knot| f64::from(*knot) <= x).clamp(1, last) - 1;
        let (x0, x1) = (knot(at), knot(at + 1));
        let width = x1 - x0;
        // There is nothing between two knots at 0.
        let t = if width > 0.0 { (x - x0) / width } else { 0.0 };
        let (t2, t3) = (t * t, t * t * t);
        let mut weights = [0.0, 2.0 * t3 - 3.0 * t2 + 1.0, -2.0 * t3 + 3.0 * t2, 0.0];
        let first_slope = t3 - 2.0 * t2 + t;
        if at > 0 && x1 > knot(at - 1) {
            let slope = first_slope * width / (x1 - knot(at - 1));
            weights[0] = -slope;
            weights[2] += slope;
        } else {
            weights[1] -= first_slope;
            weights[2] += first_slope;
        }
        let last_slope = t3 - t2;
        if at + 2 <= last && knot(at + 2) > x0 {
            let slope = last_slope * width / (knot(at + 2) - x0);
            weights[1] -= slope;
            weights[3] = slope;
        } else {
            weights[1] -= last_slope;
            weights[2] += last_slope;
        }
        Spline { knot: at, weights }
    }
}

/// The channels of the material from those of the series, clamped at 0: green is the rest of luminance without red and
/// blue.
pub(super) fn colours(series: [f64; 3], channels: usize) -> [f64; 3] {
    let [luminance, red, blue] = series;
    let luminance = luminance.max(0.0);
    if channels == 1 {
        return [luminance, 0.0, 0.0];
    }
    let green = 1.39829 * luminance - 0.100913 * blue - 0.297375 * red;
    [red.max(0.0), green.max(0.0), blue.max(0.0)]
}
