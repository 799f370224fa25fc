//! The noise of samples: the variance of the albedo from one sample, `f cos / pdf`, over the square of its mean, for
//! Mitsuba's sampler, for this library's, and for cosine-weighted directions, with the same files and numbers.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, bail};
use lobe::{Given, Material, Options, Sampler, SamplerOptions};
use serde::Serialize;
use serde_json::json;

use super::exchange::Exchange;
use super::material;
use super::program::Programs;
use xtask_common::noise;
use xtask_common::{Grid, times};

/// Polar angles of the known direction in degrees.
const ANGLES: [f64; 8] = [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0, 85.0];

/// Samples per direction.
const COUNT: usize = 1 << 17;

/// By how much the albedos that Mitsuba and this library find may differ, relative: the random numbers are the same, so
/// they differ by rounding alone.
const AGREEMENT: f64 = 1e-3;

/// Relative variances of the luminance of a single sample.
#[derive(Clone, Debug, Serialize)]
pub struct Variance {
    /// The material.
    pub on: String,
    /// Polar angle of the known direction in degrees.
    pub degrees: f64,
    /// With Mitsuba's sampler.
    pub mitsuba: f64,
    /// With this library's sampler, if the file is indexed by the viewer, the known direction, as in Mitsuba.
    pub lobe: f64,
    /// With this library's sampler, if the file is indexed by the sampled light direction.
    pub by_light: f64,
    /// With a cosine distribution.
    pub cosine: f64,
}

impl Variance {
    fn cells(&self) -> Vec<String> {
        let Variance { on, degrees, mitsuba, lobe, by_light, cosine } = self;
        let figure = |variance: f64| format!("{variance:.4}");
        let [mitsuba, by_light] = [figure(*mitsuba), figure(*by_light)];
        let gain = times(cosine / lobe);
        vec![on.clone(), format!("{degrees}°"), mitsuba, figure(*lobe), by_light, figure(*cosine), gain]
    }
}

const HEADER: [&str; 7] = ["material", "angle", "Mitsuba", "lobe", "lobe, by light", "cosine", "cosine / lobe"];

/// The table; `None` if nothing was measured.
pub fn grid(variances: &[Variance]) -> Option<Grid> {
    let rows = variances.iter().map(Variance::cells).collect();
    (!variances.is_empty()).then(|| Grid::new("Noise of samples", READING, HEADER, rows))
}

const READING: &str = "\
One sample estimates the albedo as `f cos / pdf`, in luminance. The table gives the variance of that estimate divided
by the square of its mean, which is the number of samples that leaves an error of 100 %. `angle` is the angle between
the given viewing direction and the normal. Mitsuba and lobe receive the same random numbers. Both index the file by
the viewer; in the column `by light`, lobe indexes it by the sampled light direction, which is how the material was
measured.";

/// The materials, their samplers and Mitsuba's tasks.
pub struct Question {
    /// In degrees from the normal, and as a direction.
    known: Vec<(f64, [f32; 3])>,
    uniforms: Vec<[f32; 2]>,
    subjects: Vec<Subject>,
}

struct Subject {
    name: String,
    sampler: Sampler,
    by_light: Sampler,
    task: String,
}

impl Question {
    /// The name by which it can be selected.
    pub const NAME: &str = "variance";

    /// Requests samples of all files.
    ///
    /// # Errors
    /// If a file cannot be read or written.
    pub fn new(data: &Path, exchange: &mut Exchange) -> anyhow::Result<Self> {
        let uniforms = noise::uniforms(COUNT);
        let direction = |(at, degrees): (usize, f64)| {
            // Each has a different azimuth.
            let ((sin, cos), (sin_phi, cos_phi)) = (degrees.to_radians().sin_cos(), (at as f64 * 2.4).sin_cos());
            (degrees, [sin * cos_phi, sin * sin_phi, cos].map(|x| x as f32))
        };
        let known: Vec<_> = ANGLES.into_iter().enumerate().map(direction).collect();
        let columns = [0, 1, 2].map(|k| known.iter().flat_map(|(_, w)| [w[k]; COUNT]).collect::<Vec<_>>());
        let rows: Vec<&[f32]> = columns.iter().chain(&columns).map(Vec::as_slice).collect();
        let pairs = exchange.floats("variance-pairs", &rows)?;
        let numbers = [0, 1].map(|k| uniforms.iter().map(|u| u[k]).collect::<Vec<_>>().repeat(ANGLES.len()));
        let uniforms_file = exchange.floats("variance-uniforms", &[&numbers[0], &numbers[1]])?;

        let mut subjects = Vec::new();
        for file in material::files(data) {
            let file = file.canonicalize()?;
            let name = file.file_stem().unwrap_or_default().to_string_lossy().trim_end_matches("_rgb").to_owned();
            let sampler = |indexed_by| -> anyhow::Result<Sampler> {
                let material = Material::open_with(&file, &Options { indexed_by, ..Options::default() })?;
                Ok(Sampler::new(Arc::new(material), &SamplerOptions::default())?)
            };
            let (by_light, sampler) = (sampler(Given::Light)?, sampler(Given::Viewer)?);
            let task = format!("variance-{}", name.replace(' ', "_"));
            let bsdf = json!({ "type": "measured", "filename": file });
            exchange.task(&task, json!({ "bsdf": bsdf, "what": "sample", "pairs": pairs, "uniforms": uniforms_file }));
            subjects.push(Subject { name, sampler, by_light, task });
        }
        Ok(Question { known, uniforms, subjects })
    }

    /// The variances of all samplers; empty if Mitsuba does not run.
    ///
    /// # Errors
    /// If Mitsuba fails, or finds a different albedo.
    pub fn answer(&self, programs: &mut Programs, exchange: &Exchange) -> anyhow::Result<Vec<Variance>> {
        let mut answers = Vec::new();
        if !programs.has("mitsuba") {
            return Ok(answers);
        }
        for subject in &self.subjects {
            let file = exchange.answer("mitsuba", &subject.task);
            programs.write("mitsuba", &subject.task, &file)?;
            // Directions, densities and weights.
            let theirs = exchange.read(&file, 7 * COUNT * ANGLES.len())?;
            std::fs::remove_file(&file)?;
            let weights = &theirs[4 * COUNT * ANGLES.len()..];
            for (known, weights) in self.known.iter().zip(weights.chunks(3 * COUNT)) {
                let answer = subject.compare(*known, &self.uniforms, weights);
                answers.push(answer.with_context(|| subject.name.clone())?);
            }
        }
        Ok(answers)
    }
}

impl Subject {
    /// The variances for one known direction; `theirs` are Mitsuba's weights.
    fn compare(
        &self,
        (degrees, known): (f64, [f32; 3]),
        uniforms: &[[f32; 2]],
        theirs: &[f32],
    ) -> anyhow::Result<Variance> {
        let material = self.sampler.material();
        let mitsuba = noise::of_weights(material, theirs);
        let [lobe, by_light] =
            [&self.sampler, &self.by_light].map(|sampler| noise::by_samples(sampler, Given::Viewer, known, uniforms));
        if (lobe.mean / mitsuba.mean - 1.0).abs() > AGREEMENT {
            let [theirs, ours] = [mitsuba.mean, lobe.mean];
            bail!("at {degrees} degrees the albedo is {theirs} by Mitsuba's samples and {ours} by lobe's");
        }
        let cosine = noise::by_cosine(material, Given::Viewer, known, uniforms);
        let [mitsuba, lobe, by_light, cosine] = [mitsuba, lobe, by_light, cosine].map(|moments| moments.variance);
        Ok(Variance { on: self.name.clone(), degrees, mitsuba, lobe, by_light, cosine })
    }
}
