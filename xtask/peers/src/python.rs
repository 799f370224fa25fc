//! The package for Python: what it adds to a batch in Rust, and Mitsuba from Python on the same files.

use std::path::{Path, PathBuf};

use anyhow::ensure;
use lobe::{Backend, Buffer, Material};
use lobe_benches::contest::Contender;
use lobe_benches::workload::Input;
use serde_json::{Value, json};

use super::comparison::Agreement;
use super::contest::{Contest, Outside};
use super::exchange::Exchange;
use super::material::{self, COUNT, pairs};
use super::workspace;

/// The program that has the package, and its name there.
pub const PROGRAM: &str = "lobe-bsdf";

/// The number of files of the EPFL database.
const MEASURED: usize = 2;

/// Evaluation of NumPy arrays in rows of directions, into new arrays and into an existing one.
///
/// # Errors
/// If a file cannot be read or written.
pub fn all(data: &Path, exchange: &mut Exchange) -> anyhow::Result<Vec<Contest>> {
    let (pairs, floats) = pairs(exchange, Input::Incoherent)?;
    let vectors = pairs.vectors();
    let table = workspace().join("fixtures/conductor-7x8x13.ddr");
    let measured = material::files(data).into_iter().take(MEASURED);
    let mut contests = vec![contest(exchange, &table, &floats, &vectors)?];
    for file in measured {
        let mut contest = contest(exchange, &file, &floats, &vectors)?;
        let bsdf = json!({ "type": "measured", "filename": file.canonicalize().unwrap_or(file) });
        for (peer, layout) in [("Mitsuba from Python, rows", "rows"), ("Mitsuba from Python, columns", "columns")] {
            let task = format!("{}-mitsuba-{layout}", contest.on.replace(' ', "_"));
            exchange.task(&task, json!({ "what": "arrays", "bsdf": bsdf, "pairs": floats, "layout": layout }));
            contest.outside.push(Outside::new(peer, "mitsuba", &task));
            contest.outside.push(Outside::of_sixteen("the same, AVX-512", "mitsuba-wide", task));
        }
        contests.push(contest);
    }
    Ok(contests)
}

fn contest(
    exchange: &mut Exchange,
    file: &Path,
    floats: &Path,
    (wi, wo): &(Vec<[f32; 3]>, Vec<[f32; 3]>),
) -> anyhow::Result<Contest> {
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let backend = Backend::best().fused();
    let material = Material::open(file)?.with_backend(backend);
    ensure!(material.channel_count() == 3, "{}: expected three channels", file.display());
    let mut outside = Vec::new();
    for (peer, layout, is_given) in [
        ("from Python", "rows", false),
        ("from Python, out=", "rows", true),
        ("from Python, columns, out=", "columns", true),
    ] {
        let task = format!("{}-{layout}-{is_given}", name.replace(' ', "_"));
        exchange.task(&task, task_of(file, floats, backend, layout, is_given));
        outside.push(Outside::new(peer, PROGRAM, task));
    }
    let (wi, wo) = (wi.clone(), wo.clone());
    let run = move |out: &mut Buffer<f32>| material.eval_batch(&wi, &wo, out);
    Ok(Contest {
        id: "python",
        on: name,
        unit: "evaluation",
        count: COUNT,
        lobe: Contender::new("lobe", Contender::UNCHECKED, Buffer::zeros(3 * COUNT), run, |out| out.to_vec()),
        inside: Vec::new(),
        outside,
        agreement: Some(Agreement { relative: 1e-4, floor: 1e-2, outliers: 1e-4 }),
        judge: None,
        goal: None,
    })
}

fn task_of(file: &Path, floats: &Path, backend: Backend, layout: &str, is_given: bool) -> Value {
    let file = file.canonicalize().unwrap_or(file.into());
    json!({ "file": file, "pairs": floats, "backend": backend.name(), "layout": layout, "out": is_given })
}

/// The interpreter that `cargo xtask python` leaves with the package installed.
pub fn interpreter() -> PathBuf {
    workspace().join("target/python/bin/python")
}
