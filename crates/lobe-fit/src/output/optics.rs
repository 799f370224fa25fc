//! Tables of the parameters that optics programs ask for in their dialogues.

use std::f64::consts::TAU;

use super::OutputError;
use crate::fit::Fit;
use crate::fitted::Fitted;
use crate::model::Model;

/// A fit of ABg, Harvey-Shack or K-correlation as comma-separated values, with one row per channel: the wavelength in
/// micrometres (0 if unknown, which Zemax takes for any), the parameters, and the total integrated scatter for light
/// along the normal.
///
/// ABg is the model of the ABg catalogue of Zemax OpticStudio, TracePro and FRED; the two forms of Harvey-Shack are
/// those of FRED and TracePro.
///
/// # Errors
/// [`OutputError`] for other models.
pub fn table(fit: &Fit) -> Result<String, OutputError> {
    let model = fit.request.model;
    let names = match model {
        Model::Abg => ["A", "B", "g"],
        Model::HarveyShack => ["b0", "l", "s"],
        Model::KCorrelation => ["sigma", "B", "s"],
        _ => {
            let expected = "abg, harvey-shack and k-correlation";
            return Err(OutputError::Model { found: model.name(), expected, format: "a table for optics programs" });
        }
    };
    let heads = match model {
        Model::KCorrelation => ["sigma_nm", "B_um", "s"],
        _ => names,
    };
    let mut text = format!("wavelength_um,{},TIS\n", heads.join(","));
    for (channel, (nm, values)) in fit.fitted.wavelengths.iter().zip(&fit.fitted.parameters).enumerate() {
        let wavelength = if nm.is_finite() { 1e-3 * nm } else { 0.0 };
        let value = |name: &str| {
            let index = model.parameters().iter().position(|parameter| parameter.name == name);
            index.map_or(f64::NAN, |index| values[index])
        };
        let numbers = names.map(|name| value(name).to_string()).join(",");
        text += &format!("{wavelength},{numbers},{}\n", total(&fit.fitted, channel));
    }
    Ok(text)
}

/// The share of light along the normal that a channel scatters, for a model whose values depend only on the polar angle
/// of the viewer: the integral of `f` over direction cosines, in equal steps of the logarithm of their length.
pub fn total(fitted: &Fitted, channel: usize) -> f64 {
    const STEPS: usize = 4000;
    const LEAST: f64 = 1e-12;
    let mut texel = vec![0.0; fitted.parameters.len()];
    let (wi, above) = fitted.aspect.place([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
    let step = -LEAST.ln() / STEPS as f64;
    let mut sum = 0.0;
    for index in 0..STEPS {
        let beta = (LEAST.ln() + (index as f64 + 0.5) * step).exp();
        fitted.f(wi, [beta, 0.0, above[2] * (1.0 - beta * beta).sqrt()], &mut texel);
        sum += texel[channel] * beta * beta * step;
    }
    TAU * sum
}
