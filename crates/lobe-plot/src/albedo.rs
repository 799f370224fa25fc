//! How much of the light comes back.

use std::f64::consts::{PI, TAU};

use lobe::Scatter;

use crate::colour::Colour;
use crate::evaluate::{Progress, evaluate};
use crate::geometry::{cross, incident, normalise, outgoing_sign};
use crate::in_plane::MOST;
use crate::subject::Subject;
use crate::view::View;

/// What of the light from one direction leaves by one way.
#[derive(Clone, Debug, PartialEq)]
pub struct Albedo {
    /// The polar angle of the light in radians.
    pub sigma: f64,
    /// Reflection or transmission.
    pub scatter: Scatter,
    /// The directional-hemispherical reflectance or transmittance of the quantity of the view.
    pub value: f64,
    /// Its linear sRGB.
    pub rgb: [f64; 3],
}

/// Cells of the integral from the mirror direction to its opposite, and around it.
const POLAR: usize = 256;
const AROUND: usize = 128;

/// The directional albedos of a view: the integral of `f cos(theta_o)` over the hemisphere, for each of its incidences.
///
/// A midpoint rule in polar coordinates about the mirror direction (or the ray straight through), in the square root of
/// the polar angle, so that the narrowest cells lie at the peak. About a thousandth of the value is the error for a
/// smooth material; peaks narrower than a tenth of a degree are missed.
pub fn albedos(subject: &Subject, view: &View, progress: &dyn Progress) -> Vec<Albedo> {
    let scatters = subject.scatters(view.side);
    let sigmas = view.incidences(subject, MOST);
    progress.begin("albedo", (scatters.len() * sigmas.len() * POLAR * AROUND) as u64);
    let mut albedos = Vec::new();
    for scatter in scatters {
        for &sigma in &sigmas {
            let (value, rgb) = albedo(subject, view, (sigma, scatter), progress);
            albedos.push(Albedo { sigma, scatter, value, rgb });
        }
    }
    albedos
}

fn albedo(subject: &Subject, view: &View, of: (f64, Scatter), progress: &dyn Progress) -> (f64, [f64; 3]) {
    let (sigma, scatter) = of;
    let wi = incident(view.side, sigma, view.psi);
    let up = outgoing_sign(view.side, scatter);
    let pole = [-wi[0], -wi[1], up * wi[2].abs()];
    // Any two directions across the pole.
    let across = normalise(cross(pole, [view.psi.sin(), -view.psi.cos(), 0.0]));
    let along = cross(across, pole);
    let mut cells = Vec::with_capacity(POLAR * AROUND);
    for ring in 0..POLAR {
        let angle = |at: f64| PI * (at / POLAR as f64).powi(2);
        let (from, to) = (angle(ring as f64), angle(ring as f64 + 1.0));
        let (sin, cos) = angle(ring as f64 + 0.5).sin_cos();
        let solid_angle = (from.cos() - to.cos()) * TAU / AROUND as f64;
        for sector in 0..AROUND {
            let (y, x) = (TAU * (sector as f64 + 0.5) / AROUND as f64).sin_cos();
            let wo: [f64; 3] = std::array::from_fn(|k| cos * pole[k] + sin * (x * along[k] + y * across[k]));
            if up * wo[2] > 0.0 {
                cells.push((wo, solid_angle * wo[2].abs()));
            }
        }
    }
    let colour: &Colour = &view.colour;
    let reduce = |texel: &[f32]| {
        let [r, g, b] = colour.rgb(texel);
        [view.quantity.reduce(texel), r, g, b]
    };
    let values = evaluate(subject.material(), cells.len(), |at| (wi, cells[at].0), reduce, progress);
    progress.advance((POLAR * AROUND - cells.len()) as u64);
    let mut sums = [0.0; 4];
    for (value, (_, weight)) in values.iter().zip(&cells) {
        sums.iter_mut().zip(value).for_each(|(sum, value)| *sum += weight * f64::from(*value));
    }
    (sums[0], [sums[1], sums[2], sums[3]])
}
