//! The cost of samplers before the first sample: memory and the time to build them.

use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::Context;
use lobe::formats::Document;
use lobe::table::half_diff;
use lobe::{Material, Options, Sampler, SamplerOptions};
use lobe_benches::tables;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;
use serde::Serialize;

use xtask_common::{Grid, times};

/// The name by which it can be selected.
pub const ID: &str = "samplers";

/// Bins of the MERL database: half angle, difference angle, azimuth of the difference.
const MERL: [usize; 3] = [90, 90, 180];

/// The cost of the sampler of a material.
#[derive(Clone, Debug, Serialize)]
pub struct SamplerCost {
    /// The material.
    pub material: &'static str,
    /// Bytes of the material.
    pub material_bytes: usize,
    /// Bytes that the sampler adds.
    pub sampler_bytes: usize,
    /// Seconds to build it on one core, the least of a few times.
    pub seconds: f64,
    /// The goal for that, in seconds.
    pub goal: f64,
}

/// Builds the samplers of tables of the paper's sizes and, unless `quick`, of a material of MERL's size.
///
/// # Errors
/// If there is no sampler.
pub fn all(quick: bool) -> anyhow::Result<Vec<SamplerCost>> {
    let mut costs = vec![
        cost("7 × 8 × 13", Document::new(tables::isotropic()), (0.05, 20))?,
        cost("17 × 7 × 17 × 13", Document::new(tables::anisotropic()), (0.05, 20))?,
    ];
    if !quick {
        let mut rng = Pcg32::seed_from_u64(7);
        let values = (0..3 * MERL.iter().product::<usize>()).map(|_| rng.random_range(0.01..1.0)).collect();
        let data = half_diff::Data::new(MERL, values)?;
        let document = Document::new(data);
        costs.push(cost("MERL, 90 × 90 × 180", document, (3.0, 2))?);
    }
    Ok(costs)
}

fn cost(material: &'static str, document: Document, (goal, rounds): (f64, usize)) -> anyhow::Result<SamplerCost> {
    let made = Material::from_document(&document, &Options::default())?;
    let made = Arc::new(made);
    let mut least = Duration::MAX;
    let mut bytes = 0;
    for _ in 0..rounds {
        let start = Instant::now();
        let sampler = Sampler::new(made.clone(), &SamplerOptions::default()).context(material)?;
        least = least.min(start.elapsed());
        bytes = sampler.bytes();
    }
    let seconds = least.as_secs_f64();
    Ok(SamplerCost { material, material_bytes: made.bytes(), sampler_bytes: bytes, seconds, goal })
}

/// The table.
pub fn grids(costs: &[SamplerCost]) -> Vec<Grid> {
    let row = |cost: &SamplerCost| {
        let &SamplerCost { material, material_bytes, sampler_bytes, seconds, goal } = cost;
        let kilobytes = |bytes: usize| format!("{:.0} kB", bytes as f64 / 1e3);
        vec![
            material.to_owned(),
            kilobytes(material_bytes),
            kilobytes(sampler_bytes),
            times(sampler_bytes as f64 / material_bytes as f64),
            format!("{:.1} ms", 1e3 * seconds),
            format!("{:.0} ms{}", 1e3 * goal, if seconds > goal { ", short" } else { "" }),
        ]
    };
    if costs.is_empty() {
        return Vec::new();
    }
    vec![Grid::new(
        "Sampling tables",
        READING,
        ["material", "size", "sampler", "ratio", "time to build", "goal"],
        costs.iter().map(row).collect(),
    )]
}

const READING: &str = "The memory that a sampler takes in addition to its material, at most one and a half times as \
much unless the material is tiny, and the time to build it.";
