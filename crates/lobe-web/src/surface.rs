//! The lobe as a surface in space.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe::{Scatter, Side};
use lobe_plot::{Scale, Scaling, incident};

use crate::hemisphere::{GRAZING, Place, each};
use crate::{Opened, Request};

/// Numbers per vertex of [`surface`]: x, y, z and the value.
pub const SURFACE_ROW: usize = 4;

/// The cosine of the polar angle, 89 degrees, at which the surface ends.
const LOWEST: f64 = 0.0175;

/// The lobe for light at `sigma` as a surface, whose distance from the origin is the value relative to the largest one,
/// or the position of the value on a logarithmic axis. It is a grid of `rows + 1` rings by `columns + 1` azimuths,
/// `[ring][azimuth]`. The rings begin at the mirror or straight-through direction, around which they are densest, and
/// end at the horizon.
///
/// # Errors
/// If the request does not fit the material.
pub fn surface(
    opened: &Opened,
    request: &Request,
    sigma: f64,
    [rows, columns]: [usize; 2],
) -> Result<Vec<f32>, String> {
    let showing = request.of(opened)?;
    let (view, scatter) = (&showing.view, showing.scatter);
    let up = match (view.side, scatter) {
        (Side::Front, Scatter::Reflection) | (Side::Back, Scatter::Transmission) => 1.0,
        _ => -1.0,
    };
    let wi = incident(view.side, sigma, view.psi);
    // The pole of the rings, and two directions perpendicular to it.
    let pole = [-wi[0], -wi[1], up * wi[2].abs()];
    let along = [-(view.psi.cos()) * sigma.cos(), -(view.psi.sin()) * sigma.cos(), -up * sigma.sin()];
    let across = [-view.psi.sin(), view.psi.cos(), 0.0];
    let mut places = Vec::with_capacity((rows + 1) * (columns + 1));
    for ring in 0..=rows {
        for column in 0..=columns {
            let azimuth = TAU * column as f64 / columns as f64;
            let (sin, cos) = azimuth.sin_cos();
            let away: [f64; 3] = std::array::from_fn(|k| cos * along[k] + sin * across[k]);
            // Where the great circle from the pole meets the horizon: tan(theta) = -pole.z / away.z.
            let end = (pole[2] * up).atan2(-away[2] * up).clamp(0.0, PI);
            let end = if pole[2].abs() < 1e-9 { FRAC_PI_2 } else { end };
            let t = ring as f64 / rows as f64;
            // Quadratic spacing: a tenth of the rings lie within a hundredth of the way.
            let theta = end * t * t;
            let (sin, cos) = theta.sin_cos();
            let wo: [f64; 3] = std::array::from_fn(|k| cos * pole[k] + sin * away[k]);
            // At the horizon itself there is no value, and just above it values may be of any size.
            let wo = [wo[0], wo[1], up * (up * wo[2]).max(LOWEST)];
            places.push(Place { at: places.len(), wo: wo.map(|c| c as f32) });
        }
    }
    let mut values = vec![0.0_f32; places.len()];
    let channels = opened.subject.material().channel_count();
    each(opened, wi.map(|c| c as f32), &places, channels, |at, texel| values[at] = view.quantity.reduce(texel));
    // Near the horizon, values may be larger than all others; they end at the sphere of the largest one elsewhere.
    let seen =
        || places.iter().zip(&values).filter(|(place, _)| place.wo[2].abs() > GRAZING).map(|(_, f)| f64::from(*f));
    let scale = match showing.scaling {
        Scaling::Log => {
            let scale = Scale::around(seen(), Scaling::Log);
            // Four decades show the shape of a lobe; with more, it would look like a ball.
            Scale { low: scale.low.max(scale.high * 1e-4), ..scale }
        }
        Scaling::Linear => {
            let most = seen().filter(|f| f.is_finite()).fold(0.0, f64::max);
            Scale { scaling: Scaling::Linear, low: 0.0, high: most.max(1e-30) }
        }
    };
    let mut out = Vec::with_capacity(SURFACE_ROW * places.len());
    for (place, value) in places.iter().zip(values) {
        let radius = scale.place(f64::from(value)).clamp(0.0, 1.0) as f32;
        out.extend(place.wo.map(|c| c * radius));
        out.push(value);
    }
    Ok(out)
}
