//! Checks conservation of energy: albedos by quadrature and by samples, integrals of densities, and reciprocity.

use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;

use anyhow::Context;
use lobe::formats::{Document, Format};
use lobe::table::specular::coords::angles_to_directions;
use lobe::{Data, Given, Material, Options, Sampler, SamplerOptions, luminance};
use lobe_model::{Lambert, goniometer};
use lobe_ops::albedo::albedo_of;
use lobe_ops::hemisphere::Effort;
use lobe_ops::reciprocity::reciprocity;
use lobe_ops::{Aspect, Subject};
use serde::Serialize;

use xtask_common::{Grid, noise, times};

/// The name by which it can be selected.
pub const ID: &str = "energy";

/// Polar angles of the light in degrees, and its azimuths if they matter.
const SIGMAS: [f64; 5] = [0.0, 30.0, 60.0, 80.0, 85.0];
const PSIS: [f64; 2] = [0.0, 80.0];

/// Samples per direction of the light.
const COUNT: usize = 1 << 18;

/// Number of points over which densities are summed, and how many at a time.
const POINTS: usize = 1 << 21;
const CHUNK: usize = 1 << 12;

/// Pairs of directions that are exchanged, with polar angles up to 80 degrees.
const PAIRS: usize = 20_000;
const LIMIT: f64 = 80.0;

/// The energy of a material.
#[derive(Clone, Debug, Serialize)]
pub struct Energy {
    /// The material.
    pub material: String,
    /// The largest albedo of a channel at the incidences below.
    pub largest: f64,
    /// The root mean square of the difference of exchanged pairs, relative to the root mean square of the values.
    pub reciprocity_rms: f64,
    /// The median of the relative differences of exchanged pairs.
    pub reciprocity_median: f64,
    /// The energy by direction of the light.
    pub incidences: Vec<Incidence>,
}

/// One direction of the light.
#[derive(Clone, Debug, Serialize)]
pub struct Incidence {
    /// Polar angle and azimuth in degrees.
    pub light: [f64; 2],
    /// Luminance of the albedo by quadrature.
    pub albedo: f64,
    /// The same as the mean of the weights of samples, and its standard error.
    pub by_samples: f64,
    /// The standard error.
    pub error: f64,
    /// The integral of the density of samples.
    pub density: f64,
    /// The variance of one weight divided by the square of the mean, and the same for cosine-weighted directions.
    pub variance: f64,
    /// For cosine-weighted directions.
    pub variance_by_cosine: f64,
}

/// Measures a white surface and the fixtures.
///
/// # Errors
/// If a fixture cannot be read.
pub fn all() -> anyhow::Result<Vec<Energy>> {
    let fixtures = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures"));
    let mut subjects = Vec::new();
    for name in ["conductor-7x8x13.ddr", "cloth-17x7x17x13.ddr"] {
        let (format, document) = lobe::formats::open(&fixtures.join(name))?;
        if let (true, Some(Data::Specular(samples))) = (subjects.is_empty(), document.only()) {
            let white = goniometer::measure(&Lambert { albedo: [1.0; 3] }, samples.knots().clone(), || {})?;
            subjects.push(("white, 7 × 8 × 13", format, Document::new(white)));
        }
        subjects.push((name, format, document));
    }
    subjects.into_iter().map(|(name, format, document)| of(name, format, document)).collect()
}

fn of(name: &str, format: Format, document: Document) -> anyhow::Result<Energy> {
    let options = Options::default();
    let material = || Material::from_document(&document, &options);
    let sampler = Sampler::new(Arc::new(material()?), &SamplerOptions::default()).context("no sampler")?;
    let subject = Subject::new(format, document.clone(), material()?, &options);
    let psis = if subject.is_isotropic() { &PSIS[..1] } else { &PSIS };
    let uniforms = noise::uniforms(COUNT);
    let mut largest = f64::NEG_INFINITY;
    let mut incidences = Vec::new();
    for (sigma, psi) in SIGMAS.iter().flat_map(|&sigma| psis.iter().map(move |&psi| (sigma, psi))) {
        let light = [sigma.to_radians(), psi.to_radians()];
        let albedo = albedo_of(&subject, Aspect::REFLECTION, light, Effort::default());
        largest = largest.max(albedo.largest());
        let weights = luminance(subject.material.channels());
        let albedo = albedo.values.iter().zip(&weights).map(|(value, &y)| value * f64::from(y)).sum();
        let by_samples = noise::by_samples(&sampler, Given::Light, direction(light), &uniforms);
        let by_cosine = noise::by_cosine(&subject.material, Given::Light, direction(light), &uniforms);
        let density = density(&sampler, light);
        incidences.push(Incidence {
            light: [sigma, psi],
            albedo,
            by_samples: by_samples.mean,
            error: by_samples.mean * (by_samples.variance / COUNT as f64).sqrt(),
            density,
            variance: by_samples.variance,
            variance_by_cosine: by_cosine.variance,
        });
    }
    let exchanged = reciprocity(&subject.material, Aspect::REFLECTION, LIMIT.to_radians(), PAIRS);
    Ok(Energy {
        material: name.to_owned(),
        largest,
        reciprocity_rms: exchanged.relative_rms,
        reciprocity_median: exchanged.relative_median,
        incidences,
    })
}

fn direction([theta, phi]: [f64; 2]) -> [f32; 3] {
    let ((sin, cos), (sin_phi, cos_phi)) = (theta.sin_cos(), phi.sin_cos());
    [sin * cos_phi, sin * sin_phi, cos].map(|x| x as f32)
}

/// The integral of the density over the hemisphere, in polar coordinates about the mirror direction.
///
/// The density of a histogram has steps that do not coincide with panels of a quadrature, so it is summed over points
/// of which no two share an angle: the additive recurrence of the plastic number (Roberts 2018).
fn density(sampler: &Sampler, [sigma, psi]: [f64; 2]) -> f64 {
    let place = |point: usize| {
        let [u, w] = [0.754_877_666_246_693, 0.569_840_290_998_053].map(|step| (point as f64 * step).fract());
        // The peak is at theta = 0, and the density of points there matches its width.
        let theta = PI * u * u;
        let (_, viewer) = angles_to_directions([sigma, psi, theta, TAU * w], |sigma| sigma);
        (viewer.map(|x| x as f32), 2.0 * PI * u * theta.sin() * TAU)
    };
    let light = direction([sigma, psi]);
    let chunk = |first: usize| {
        let (viewers, areas): (Vec<[f32; 3]>, Vec<f64>) = (first..first + CHUNK).map(place).unzip();
        let mut pdfs = vec![0.0; CHUNK];
        sampler.pdf_batch(Given::Light, &[light; CHUNK], &viewers, &mut pdfs);
        pdfs.into_iter().zip(areas).map(|(pdf, area)| f64::from(pdf) * area).sum::<f64>()
    };
    (0..POINTS).step_by(CHUNK).map(chunk).sum::<f64>() / POINTS as f64
}

/// The tables: by direction of the light, and per material.
pub fn grids(energies: &[Energy]) -> Vec<Grid> {
    if energies.is_empty() {
        return Vec::new();
    }
    let by_light = |Energy { material, incidences, .. }: &Energy| {
        let row = |incidence: &Incidence| {
            let Incidence { light: [sigma, psi], albedo, by_samples, error, density, .. } = incidence;
            let Incidence { variance, variance_by_cosine, .. } = incidence;
            vec![
                material.clone(),
                format!("{sigma}°, {psi}°"),
                format!("{albedo:.4}"),
                format!("{by_samples:.4} ± {error:.4}"),
                format!("{density:.4}"),
                format!("{variance:.4}"),
                format!("{variance_by_cosine:.4}"),
                times(variance_by_cosine / variance),
            ]
        };
        incidences.iter().map(row).collect::<Vec<_>>()
    };
    let whole = |energy: &Energy| {
        vec![
            energy.material.clone(),
            format!("{:.4}", energy.largest),
            format!("{:.2} %", 100.0 * energy.reciprocity_rms),
            format!("{:.2} %", 100.0 * energy.reciprocity_median),
        ]
    };
    vec![
        Grid::new(
            "Energy",
            BY_LIGHT,
            ["material", "light", "albedo", "by samples", "∫ density", "variance", "by cosine", "gain"],
            energies.iter().flat_map(by_light).collect(),
        ),
        Grid::new(
            "Energy and reciprocity",
            WHOLE,
            ["material", "largest albedo", "reciprocity, rms", "median"],
            energies.iter().map(whole).collect(),
        ),
    ]
}

const BY_LIGHT: &str = "In a white furnace a surface is as bright as its albedo: here is its luminance by quadrature, \
and as the mean weight of 262,144 samples with its standard error. The density of samples must integrate to 1. The \
variance is the variance of the albedo from one sample, over the square of its mean, with the sampler and with cosine-weighted directions.";

const WHOLE: &str = "The largest albedo of any channel at these angles: it is at most 1 for a passive surface. \
Reciprocity is measured by the change of values when light and viewer, up to 80° from the normal, are exchanged: the \
root mean square of the difference relative to that of the values, and the median of the relative differences. A table \
is not quite reciprocal, because it interpolates differently between directions of the light and of the viewer.";
