//! Curves, spectra, albedos, tables of values and figures.

use std::fmt::Write as _;

use lobe_plot::{Figure, Shown, Silent, View, albedos, curves, draw};
use serde::Serialize;

use crate::request::{Showing, word};
use crate::{Opened, Request};

/// Numbers per point of [`curve`].
pub const CURVE_ROW: usize = 3;

/// The curve in the plane of incidence for light at `sigma`. Each point has three numbers: the viewing angle in
/// radians, positive away from the light; the value; and a flag, which is 1 if the angle lies within the measurement,
/// plus 2 if it was itself measured.
///
/// # Errors
/// If the request does not fit the material.
pub fn curve(opened: &Opened, request: &Request, sigma: f64) -> Result<Vec<f64>, String> {
    let Showing { view, scatter, .. } = request.of(opened)?;
    let view = View { sigmas: vec![sigma], ..view };
    let found = curves(&opened.subject, &view, &Silent);
    let Some(curve) = found.into_iter().find(|curve| curve.scatter == scatter) else { return Ok(Vec::new()) };
    let mut rows = Vec::with_capacity(CURVE_ROW * curve.theta.len());
    for ((theta, f), is_measured) in curve.theta.iter().zip(&curve.f).zip(&curve.is_measured) {
        rows.extend([*theta, f64::from(*f), f64::from(u8::from(*is_measured))]);
    }
    for point in curve.points {
        rows[CURVE_ROW * point + 2] += 2.0;
    }
    Ok(rows)
}

/// The values at all wavelengths for one pair of directions in the plane of incidence.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spectrum {
    /// The viewing angle in radians.
    pub theta: f64,
    /// Wavelengths in nm, ascending.
    pub nm: Vec<f64>,
    /// The value at each wavelength.
    pub f: Vec<f32>,
    /// `true` if the pair of directions lies within the measurement.
    pub is_measured: bool,
}

/// Spectra for light at `sigma` and the viewing angles `thetas`, or some around the mirror direction if `thetas` is
/// empty. A material without wavelengths has none.
///
/// # Errors
/// If the request does not fit the material.
pub fn spectra(opened: &Opened, request: &Request, sigma: f64, thetas: &[f64]) -> Result<Vec<Spectrum>, String> {
    let Showing { view, scatter, .. } = request.of(opened)?;
    let view = View { thetas: thetas.to_vec(), ..view };
    let found = lobe_plot::spectra(&opened.subject, &view, &[sigma], &Silent).unwrap_or_default();
    let of_scatter = found.into_iter().filter(|spectrum| spectrum.scatter == scatter);
    let ascending = |spectrum: lobe_plot::Spectrum| {
        let mut order: Vec<usize> = (0..spectrum.nm.len()).collect();
        order.sort_by(|a, b| spectrum.nm[*a].total_cmp(&spectrum.nm[*b]));
        Spectrum {
            theta: spectrum.theta,
            nm: order.iter().map(|&at| spectrum.nm[at]).collect(),
            f: order.iter().map(|&at| spectrum.f[at]).collect(),
            is_measured: spectrum.is_measured,
        }
    };
    Ok(of_scatter.map(ascending).collect())
}

/// Directional albedos. Each incidence has five numbers: its polar angle in radians, the albedo of the quantity, and
/// the albedo as linear sRGB.
///
/// # Errors
/// If the request does not fit the material.
pub fn albedo_rows(opened: &Opened, request: &Request, sigmas: &[f64]) -> Result<Vec<f64>, String> {
    let Showing { view, scatter, .. } = request.of(opened)?;
    let view = View { sigmas: sigmas.to_vec(), ..view };
    let found = albedos(&opened.subject, &view, &Silent).into_iter().filter(|albedo| albedo.scatter == scatter);
    Ok(found.flat_map(|albedo| [albedo.sigma, albedo.value].into_iter().chain(albedo.rgb)).collect())
}

/// The curve of all channels as CSV with a header line.
///
/// # Errors
/// If the request does not fit the material.
pub fn table(opened: &Opened, request: &Request, sigma: f64) -> Result<String, String> {
    let Showing { view, scatter, .. } = request.of(opened)?;
    let rows = curve(opened, request, sigma)?;
    let material = opened.subject.material();
    let channels = material.channel_count();
    let narrow = |direction: [f64; 3]| direction.map(|c| c as f32);
    let wi = narrow(lobe_plot::incident(view.side, sigma, view.psi));
    let thetas: Vec<f64> = rows.chunks_exact(CURVE_ROW).map(|row| row[0]).collect();
    let wo: Vec<[f32; 3]> =
        thetas.iter().map(|&theta| narrow(lobe_plot::in_plane(view.side, scatter, theta, view.psi))).collect();
    let mut values = vec![0.0; wo.len() * channels];
    material.eval_batch(&vec![wi; wo.len()], &wo, &mut values);
    let quoted = |name: &String| match name.contains([',', '"', '\n']) {
        true => format!("\"{}\"", name.replace('"', "\"\"")),
        false => name.clone(),
    };
    let names: Vec<String> = material.channels().names().iter().map(quoted).collect();
    let mut out = format!("sigma_deg,psi_deg,theta_deg,measured,{}\n", names.join(","));
    for ((theta, row), texel) in thetas.iter().zip(rows.chunks_exact(CURVE_ROW)).zip(values.chunks_exact(channels)) {
        let [sigma, psi, theta] = [sigma, view.psi, *theta].map(|angle| (1e9 * angle.to_degrees()).round() / 1e9);
        let _ = write!(out, "{sigma},{psi},{theta},{}", u8::from(row[2] >= 1.0));
        for value in texel {
            let _ = write!(out, ",{value:?}");
        }
        out.push('\n');
    }
    Ok(out)
}

/// The figures of `lobe plot`.
const FIGURES: [Figure; 8] = [
    Figure::Curves,
    Figure::Polar,
    Figure::Channels,
    Figure::Spectra,
    Figure::Slices,
    Figure::Sphere,
    Figure::Mueller,
    Figure::Polarisation,
];

/// A figure of one or more materials as SVG, as drawn by `lobe plot`: `curves`, `polar`, `channels`, `spectra`,
/// `slices`, `sphere`, `mueller` or `polarisation`.
///
/// # Errors
/// If there is no such figure, a request does not fit its material, or the figure cannot show the materials.
pub fn figure(opened: &[&Opened], requests: &[Request], kind: &str, sigmas: &[f64]) -> Result<String, String> {
    let names: Vec<(String, Figure)> = FIGURES.into_iter().map(|kind| (kind.to_string(), kind)).collect();
    let names: Vec<(&str, Figure)> = names.iter().map(|(name, kind)| (name.as_str(), *kind)).collect();
    let kind = word(kind, &names)?.unwrap_or(Figure::Curves);
    let view = |(opened, request): (&&Opened, &Request)| {
        let Showing { view, .. } = request.of(opened)?;
        Ok(View { sigmas: sigmas.to_vec(), ..view })
    };
    let views: Vec<View> = opened.iter().zip(requests).map(view).collect::<Result<_, String>>()?;
    let shown: Vec<Shown<'_>> =
        opened.iter().zip(&views).map(|(opened, view)| Shown { subject: &opened.subject, view }).collect();
    Ok(draw(&shown, kind, &Silent).map_err(|error| error.to_string())?.svg)
}
