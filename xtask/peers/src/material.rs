//! Materials of the EPFL database, compared with Mitsuba's `measured` on the same files.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use anyhow::bail;
use lobe::formats;
use lobe::table::rgl::{self, Drawn, UniformOrder, Wanted};
use lobe::{Backend, Buffer, Channels, Data, Directions};
use lobe_benches::contest::Contender;
use lobe_benches::workload::{Input, Pairs};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;
use serde_json::json;

use super::comparison::Agreement;
use super::contest::{Contest, Outside};
use super::exchange::Exchange;

/// Queries per run: enough that the fixed cost of a wavefront does not matter.
pub const COUNT: usize = 1 << 20;

/// The RGB files, in order of their names.
pub fn files(data: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(data.join("rgl_bsdf")).into_iter().flatten().flatten();
    let mut files: Vec<_> = entries.map(|entry| entry.path()).filter(|path| is_rgb(path)).collect();
    files.sort();
    files
}

fn is_rgb(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().ends_with("_rgb.bsdf"))
}

/// Pairs of directions, and the file of their six components.
///
/// # Errors
/// If it cannot be written.
pub fn pairs(exchange: &Exchange, input: Input) -> anyhow::Result<(Rc<Pairs>, PathBuf)> {
    let pairs = input.pairs(COUNT);
    let rows: Vec<&[f32]> = pairs.wi.iter().chain(&pairs.wo).map(|column| &**column).collect();
    let file = exchange.floats(&format!("pairs-{}", input.name()), &rows)?;
    Ok((Rc::new(pairs), file))
}

/// Values of every file on both inputs, densities and samples on the incoherent one.
///
/// # Errors
/// If a file cannot be read or written.
pub fn all(data: &Path, exchange: &mut Exchange) -> anyhow::Result<Vec<Contest>> {
    let mut contests = Vec::new();
    let files = files(data);
    if files.is_empty() {
        return Ok(contests);
    }
    let incoherent = pairs(exchange, Input::Incoherent)?;
    let coherent = pairs(exchange, Input::Coherent)?;
    let mut rng = Pcg32::seed_from_u64(2018);
    let uniforms: Rc<[[f32; 2]]> = (0..COUNT).map(|_| [rng.random(), rng.random()]).collect();
    let [first, second] = [0, 1].map(|k| uniforms.iter().map(|pair| pair[k]).collect::<Vec<_>>());
    let uniforms = (uniforms, exchange.floats("uniforms", &[&first, &second])?);
    for file in files {
        let (_, document) = formats::open(&file)?;
        let Some(Data::Rgl(data)) = document.only() else {
            bail!("{}: expected a material of the EPFL database", file.display());
        };
        let subject = Subject::new(&file, data)?;
        contests.push(subject.eval(exchange, Input::Incoherent, &incoherent));
        contests.push(subject.eval(exchange, Input::Coherent, &coherent));
        contests.push(subject.pdf(exchange, &incoherent));
        contests.push(subject.sample(exchange, &incoherent, &uniforms));
    }
    Ok(contests)
}

/// A material in a file.
struct Subject<'a> {
    file: &'a Path,
    name: String,
    table: Rc<rgl::Table>,
    backend: Backend,
}

impl<'a> Subject<'a> {
    fn new(file: &'a Path, rgl: &rgl::Data) -> anyhow::Result<Self> {
        if rgl.parts().channels != Channels::Rgb {
            bail!("{}: expected RGB", file.display());
        }
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Subject {
            file,
            name: name.trim_end_matches("_rgb").to_owned(),
            table: Rc::new(rgl::Table::new(rgl, rgl::Options::default())?),
            backend: Backend::best().fused(),
        })
    }

    /// `f cos(theta_o)`, which is what Mitsuba returns.
    fn eval(&self, exchange: &mut Exchange, input: Input, (pairs, file): &(Rc<Pairs>, PathBuf)) -> Contest {
        let (table, backend, pairs) = (self.table.clone(), self.backend, pairs.clone());
        let run = move |out: &mut Buffer<f32>| {
            let [wi, wo] = columns(&pairs);
            table.evaluate(backend, wi, wo, Wanted::ValuesCos(out));
        };
        let lobe = Contender::new("lobe", Contender::UNCHECKED, Buffer::zeros(3 * COUNT), run, |out| out.to_vec());
        let task = json!({ "what": "eval", "pairs": file });
        self.contest(exchange, ("rgl-eval", "evaluation"), input, task, lobe, Some(7.0))
    }

    fn pdf(&self, exchange: &mut Exchange, (pairs, file): &(Rc<Pairs>, PathBuf)) -> Contest {
        let (table, backend, pairs) = (self.table.clone(), self.backend, pairs.clone());
        let run = move |out: &mut Buffer<f32>| {
            let [wi, wo] = columns(&pairs);
            table.pdf_batch(backend, wi, wo, out);
        };
        let lobe = Contender::new("lobe", Contender::UNCHECKED, Buffer::zeros(COUNT), run, |out| out.to_vec());
        let task = json!({ "what": "pdf", "pairs": file });
        self.contest(exchange, ("rgl-pdf", "density"), Input::Incoherent, task, lobe, None)
    }

    /// Directions, densities and weights.
    fn sample(
        &self,
        exchange: &mut Exchange,
        (pairs, file): &(Rc<Pairs>, PathBuf),
        (uniforms, uniforms_file): &(Rc<[[f32; 2]]>, PathBuf),
    ) -> Contest {
        let (table, backend, pairs, uniforms) = (self.table.clone(), self.backend, pairs.clone(), uniforms.clone());
        let out = (Buffer::zeros(COUNT), Buffer::zeros(COUNT), Buffer::zeros(3 * COUNT));
        let run = move |(wo, pdf, weights): &mut (Buffer<[f32; 3]>, Buffer<f32>, Buffer<f32>)| {
            let [wi, _] = columns(&pairs);
            table.sample_batch(backend, wi, &uniforms, UniformOrder::Powitacq, Drawn { wo, pdf, weights });
        };
        let lobe = Contender::new("lobe", Contender::UNCHECKED, out, run, |(wo, pdf, weights)| {
            [wo.as_flattened(), &**pdf, &**weights].concat()
        });
        let task = json!({ "what": "sample", "pairs": file, "uniforms": uniforms_file });
        self.contest(exchange, ("rgl-sample", "sample"), Input::Incoherent, task, lobe, Some(10.0))
    }

    fn contest(
        &self,
        exchange: &mut Exchange,
        (id, unit): (&'static str, &'static str),
        input: Input,
        mut task: serde_json::Value,
        lobe: Contender,
        goal: Option<f64>,
    ) -> Contest {
        // Words of a request are separated by spaces.
        let name = format!("{id}-{}-{}", self.name.replace(' ', "_"), input.name());
        task["bsdf"] = json!({ "type": "measured", "filename": self.file.canonicalize().unwrap_or(self.file.into()) });
        exchange.task(&name, task);
        Contest {
            id,
            on: format!("{}, {}", self.name, input.name()),
            unit,
            count: COUNT,
            lobe,
            inside: Vec::new(),
            outside: vec![
                Outside::new("Mitsuba measured", "mitsuba", &name),
                Outside::of_sixteen("Mitsuba measured, AVX-512", "mitsuba-wide", name),
            ],
            // Both sample in single precision, whose rounding moves a direction far within a dark cell.
            agreement: Some(Agreement {
                relative: if id == "rgl-sample" { 1e-3 } else { 1e-4 },
                floor: 1e-2,
                outliers: 1e-4,
            }),
            judge: None,
            goal,
        }
    }
}

fn columns(pairs: &Pairs) -> [Directions<'_>; 2] {
    [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z))
}
