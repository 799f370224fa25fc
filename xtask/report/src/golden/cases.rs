//! The contents of each kind of file of answers, and the allowed differences.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use lobe::formats::{self, Document, Format};
use lobe::{Backend, Data, Edges, Material, Options};

use super::answers::{self, Answer, direction};
use super::{Comparison, Measure};
use lobe_testing::made::{merl_formula, utia_numbers};

/// Compares the file of answers `name`; `None` if it is not such a file.
pub(super) fn compare(backend: Backend, shared: &Path, answers: &Path, name: &str) -> anyhow::Result<Vec<Comparison>> {
    let one = match name {
        "merl_formula.txt" => merl(backend, answers)?,
        "utia_lcg.txt" => utia(backend, answers)?,
        "real_rgl.mitsuba.json" => return mitsuba_values(backend, shared, answers),
        _ => {
            let of = |program: &str| name.strip_suffix(program);
            if let Some(stem) = of(".libbsdf.txt") {
                libbsdf(backend, &source(shared, stem)?, answers)?
            } else if let Some(stem) = of(".powitacq.txt") {
                powitacq(backend, &source(shared, stem)?, answers, stem.starts_with("real_"))?
            } else if let Some(stem) = of(".radiance.txt") {
                radiance(backend, &source(shared, stem)?, answers)?
            } else if name == "syn.pbsdf.mitsuba.txt" {
                mitsuba_mueller(backend, &source(shared, "syn.pbsdf")?, answers)?
            } else if let Some(stem) = of(".mitsuba.txt") {
                mitsuba_spectra(backend, &source(shared, stem)?, answers)?
            } else {
                return Ok(Vec::new());
            }
        }
    };
    Ok(vec![one])
}

/// The file that answers are about: the prefix `real_` denotes a measured file, all others are next to their answers.
fn source(shared: &Path, stem: &str) -> anyhow::Result<PathBuf> {
    let candidates: Vec<PathBuf> = match stem.strip_prefix("real_") {
        Some(file) => {
            let folders = std::fs::read_dir(shared.join("data")).context("the measured files")?;
            folders.filter_map(|folder| Some(folder.ok()?.path().join(file))).collect()
        }
        None => ["", ".bsdf", ".xml"].map(|end| shared.join("golden").join(format!("{stem}{end}"))).to_vec(),
    };
    candidates.into_iter().find(|path| path.is_file()).with_context(|| format!("the file {stem} is missing"))
}

/// A material on the backend, and facts about its file.
struct Subject {
    file: String,
    format: Format,
    material: Material,
    /// The largest magnitude of a specular table; 0 elsewhere.
    largest: f64,
}

impl Subject {
    fn open(backend: Backend, path: &Path, options: &Options) -> anyhow::Result<Self> {
        let (format, document) = formats::open(path)?;
        Subject::new(backend, path, (format, document), options)
    }

    fn new(
        backend: Backend,
        path: &Path,
        (format, document): (Format, Document),
        options: &Options,
    ) -> anyhow::Result<Self> {
        let largest = match document.only() {
            Some(Data::Specular(table)) => table.values().iter().fold(0.0, |most: f64, x| most.max(f64::from(x.abs()))),
            _ => 0.0,
        };
        let material = Material::from_document(&document, options)?.with_backend(backend);
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Subject { file, format, material, largest })
    }

    /// Values of all pairs, each times the `scale` for its viewer.
    fn values(&self, pairs: &[([f32; 3], [f32; 3])], scale: impl Fn([f32; 3]) -> f64) -> Vec<Vec<f64>> {
        let (wi, wo): (Vec<_>, Vec<_>) = pairs.iter().copied().unzip();
        let channels = self.material.channel_count();
        let mut values = vec![f32::NAN; pairs.len() * channels];
        self.material.eval_batch(&wi, &wo, &mut values);
        let texels = values.chunks_exact(channels).zip(wo);
        texels.map(|(texel, wo)| texel.iter().map(|x| f64::from(*x) * scale(wo)).collect()).collect()
    }

    /// The largest difference between `found` and the outputs of `answers`, one by one, as far as both exist.
    fn against(
        self,
        program: &'static str,
        answers: &[Answer],
        found: &[Vec<f64>],
        (of, floor, bound): (Measure, f64, f64),
    ) -> Comparison {
        let outputs = || answers.iter().flat_map(|answer| &answer.outputs);
        let largest = match self.largest {
            0.0 => outputs().fold(0.0, |most: f64, x| most.max(x.abs())),
            of_the_table => of_the_table,
        };
        let difference = |found: f64, expected: f64| {
            let difference = (found - expected).abs();
            match of {
                Measure::Largest => difference / largest,
                Measure::Value => difference / expected.abs().max(floor),
                Measure::Absolute => difference,
            }
        };
        let each = found.iter().zip(answers).flat_map(|(found, answer)| found.iter().zip(&answer.outputs));
        let error = each.map(|(found, expected)| difference(*found, *expected)).fold(0.0, |most: f64, x| {
            // A NaN must not get lost.
            if x > most || x.is_nan() { x } else { most }
        });
        Comparison {
            file: self.file,
            reader: self.format.name().to_owned(),
            against: program,
            pairs: answers.len(),
            error,
            of,
            bound,
        }
    }
}

fn pairs(answers: &[Answer]) -> Vec<([f32; 3], [f32; 3])> {
    answers.iter().map(|answer| (answer.direction(0), answer.direction(3))).collect()
}

fn as_it_is(_: [f32; 3]) -> f64 {
    1.0
}

fn cosine(wo: [f32; 3]) -> f64 {
    f64::from(wo[2])
}

/// Specular tables, extrapolated linearly beyond their knots.
fn libbsdf(backend: Backend, file: &Path, path: &Path) -> anyhow::Result<Comparison> {
    let subject = Subject::open(backend, file, &Options { edges: Edges::extrapolate(), ..Options::default() })?;
    let answers = answers::read(path, [6, subject.material.channel_count()])?;
    let found = subject.values(&pairs(&answers), as_it_is);
    Ok(subject.against("libbsdf", &answers, &found, (Measure::Largest, 0.0, 2e-5)))
}

/// `f cos(theta_o)` of the EPFL database, never below 0.
fn powitacq(backend: Backend, file: &Path, path: &Path, is_real: bool) -> anyhow::Result<Comparison> {
    let subject = Subject::open(backend, file, &Options::default())?;
    let answers = answers::read(path, [6, subject.material.channel_count()])?;
    let mut found = subject.values(&pairs(&answers), cosine);
    found.iter_mut().flatten().for_each(|value| *value = value.max(0.0));
    let floor = if is_real { 1e-3 } else { 1e-7 };
    Ok(subject.against("powitacq", &answers, &found, (Measure::Value, floor, 1e-4)))
}

/// `f cos(theta_o)` of the EPFL database at its own wavelengths, which come first.
fn mitsuba_spectra(backend: Backend, file: &Path, path: &Path) -> anyhow::Result<Comparison> {
    let subject = Subject::open(backend, file, &Options::default())?;
    let answers = answers::read(path, [6, subject.material.channel_count()])?;
    let found = subject.values(&pairs(&answers), cosine);
    Ok(subject.against("Mitsuba 3", &answers, &found, (Measure::Value, 1e-7, 1e-4)))
}

/// Mueller matrices times the cosine; the first direction is the viewer's.
fn mitsuba_mueller(backend: Backend, file: &Path, path: &Path) -> anyhow::Result<Comparison> {
    let subject = Subject::open(backend, file, &Options::default())?;
    let answers = answers::read(path, [7, 16])?;
    let matrix = |answer: &Answer| {
        let (viewer, light) = (answer.direction(0), answer.direction(3));
        let matrix = subject.material.mueller(light, viewer, answer.inputs[6]).context("Mueller matrices")?;
        Ok(matrix.as_flattened().iter().map(|x| x * cosine(light)).collect())
    };
    let found = answers.iter().map(matrix).collect::<anyhow::Result<Vec<Vec<f64>>>>()?;
    Ok(subject.against("Mitsuba 3", &answers, &found, (Measure::Absolute, 0.0, 2e-6)))
}

/// Materials of the EPFL database at a few angles: `theta_i`, `theta_o` and `phi` in degrees, and `f`.
///
/// If two directions are mirror images, their half vector is the normal, and its azimuth is determined only by
/// rounding, although the tables differ between azimuths. Pairs that are mirror directions to the last digit in `f64`
/// have no defined value in lanes; the tests of `lobe-formats` compare them with the `f64` reference.
fn mitsuba_values(backend: Backend, shared: &Path, path: &Path) -> anyhow::Result<Vec<Comparison>> {
    let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let files: serde_json::Map<String, serde_json::Value> =
        serde_json::from_str(&text).with_context(|| path.display().to_string())?;
    let mut comparisons = Vec::new();
    for (file, entry) in files {
        let evals: Vec<(f64, f64, f64, Vec<f64>)> =
            serde_json::from_value(entry["evals"].clone()).with_context(|| format!("{file} in {}", path.display()))?;
        let subject = Subject::open(backend, &shared.join("data").join(&file), &Options::default())?;
        let answers: Vec<Answer> = evals
            .into_iter()
            .filter(|(i, o, phi, _)| !(*i > 0.0 && i == o && *phi == 180.0))
            .map(|(i, o, phi, outputs)| Answer { inputs: [i, o, phi].map(f64::to_radians).to_vec(), outputs })
            .collect();
        let pair = |answer: &Answer| {
            let [theta_i, theta_o, phi] = [0, 1, 2].map(|k| answer.inputs[k]);
            (direction([theta_i, 0.0]), direction([theta_o, phi]))
        };
        let found = subject.values(&answers.iter().map(pair).collect::<Vec<_>>(), as_it_is);
        comparisons.push(subject.against("Mitsuba 3", &answers, &found, (Measure::Value, 1e-3, 1e-4)));
    }
    Ok(comparisons)
}

/// The visible band of a window system. Radiance perturbs values by up to 3.5e-4 on purpose; if a second column has the
/// unperturbed value, that one counts.
fn radiance(backend: Backend, file: &Path, path: &Path) -> anyhow::Result<Comparison> {
    let subject = Subject::open(backend, file, &Options::default())?;
    let names = subject.material.channels().names();
    let Some(visible) = names.iter().position(|name| name.eq_ignore_ascii_case("visible")) else {
        bail!("{}: expected a visible band", file.display());
    };
    let mut answers = answers::read(path, [6, 1])?;
    let is_exact = answers.iter().all(|answer| answer.outputs.len() == 2);
    answers.iter_mut().for_each(|answer| drop(answer.outputs.drain(..usize::from(is_exact))));
    let values = subject.values(&pairs(&answers), as_it_is);
    let found: Vec<Vec<f64>> = values.iter().map(|texel| vec![texel[visible]]).collect();
    let (program, bound) = if is_exact { ("Radiance, unperturbed", 1e-6) } else { ("Radiance", 3.5e-4) };
    Ok(subject.against(program, &answers, &found, (Measure::Value, 1e-12, bound)))
}

/// Every bin of this table holds its own indices.
fn merl(backend: Backend, path: &Path) -> anyhow::Result<Comparison> {
    let made = ("bins that hold their indices", Format::Merl, &*merl_formula());
    angles(backend, path, made, "BRDFRead", (Measure::Absolute, 0.0, 0.0))
}

/// Numbers of a generator that the file of answers defines.
fn utia(backend: Backend, path: &Path) -> anyhow::Result<Comparison> {
    let made = ("pseudo-random numbers", Format::Utia, &*utia_numbers());
    angles(backend, path, made, "UTIA-brdf", (Measure::Largest, 0.0, 2e-5))
}

/// A table that is constructed here, queried by zenith angles and azimuths.
fn angles(
    backend: Backend,
    path: &Path,
    (name, format, bytes): (&str, Format, &[u8]),
    program: &'static str,
    measure: (Measure, f64, f64),
) -> anyhow::Result<Comparison> {
    let file = Path::new(name);
    let document = formats::read(format, bytes, file)?;
    let subject = Subject::new(backend, file, (format, document), &Options::default())?;
    let answers = answers::read(path, [4, 3])?;
    let pairs: Vec<_> = answers.iter().map(|answer| (answer.spherical(0), answer.spherical(2))).collect();
    let found = subject.values(&pairs, as_it_is);
    Ok(subject.against(program, &answers, &found, measure))
}
