//! Samples tables, and evaluates the densities of samples.

use std::sync::Arc;

use lobe_benches::tables::klems;
use lobe_table::window::{Block, Component};
use lobe_table::{Edges, Given, PatchSampler, Sampled, Scatter};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::machine::Machine;
use super::record::{Bound, Record};
use super::tables::{Case, Queries, adversarial, cases};

/// Every table once, with a sampler built by this backend.
pub(super) fn record(machine: impl Machine) -> Vec<Record> {
    let is_wanted = |case: &&Case| case.name.ends_with("incoherent") && *case.table.edges() == Edges::default();
    let mut records: Vec<Record> = cases().iter().filter(is_wanted).flat_map(|case| sample(machine, case)).collect();
    records.extend(patches(machine));
    records
}

/// Samples the patches of Klems matrices, and evaluates their densities.
fn patches(machine: impl Machine) -> Vec<Record> {
    let (window, Queries { wi, wo }) = (klems(), adversarial());
    let (count, u) = (wi.len(), numbers(wi.len()));
    let mut records = Vec::new();
    for block in Block::ALL {
        let Some(Component::Klems(matrix)) = window.block(block) else { continue };
        let scatter = block.aspect().scatter;
        let sampler = PatchSampler::new(scatter, &[(matrix, 1.0)], 0.05).expect("options").expect("a sampler");
        let mut directions = vec![[f32::NAN; 3]; count];
        let (mut pdfs, mut densities) = (vec![f32::NAN; count], vec![f32::NAN; count]);
        machine.patches(&sampler, &wi, &u, &mut directions, &mut pdfs);
        machine.patch_densities(&sampler, &wi, &wo, &mut densities);
        let name = if scatter == Scatter::Reflection { "patches" } else { "patches, transmission" };
        let results =
            [("directions", directions.into_flattened()), ("densities of samples", pdfs), ("densities", densities)];
        records.extend(
            results.map(|(what, values)| Record::bounded(format!("{name}: {what}"), values, Bound::StrictOnly)),
        );
    }
    records
}

/// A histogram has steps, and a sample next to one may fall on either side, so nothing is promised for the fused form
/// here: statistical tests show that its samples have the right density.
fn sample(machine: impl Machine, case: &Case) -> Vec<Record> {
    let channels = case.table.channel_count();
    let sampler = machine.sampler(Arc::new(case.table.clone()));
    let name = case.name.trim_end_matches(", incoherent");
    let mut queries = case.queries.clone();
    let Queries { wi, wo } = adversarial();
    queries.wi.extend(wi);
    queries.wo.extend(wo);
    let count = queries.wi.len();
    let u = numbers(count);

    let mut records = Vec::new();
    for given in [Given::Light, Given::Viewer] {
        let mut directions = vec![[f32::NAN; 3]; count];
        let (mut weights, mut pdfs, mut densities) =
            (vec![f32::NAN; count * channels], vec![f32::NAN; count], vec![f32::NAN; count]);
        let out = Sampled { directions: &mut directions, weights: &mut weights, pdfs: &mut pdfs };
        machine.sample(&sampler, given, &queries.wi, &u, out);
        machine.densities(&sampler, given, &queries.wi, &queries.wo, &mut densities);

        let agrees = (0..count).map(|query| {
            let mut weight = vec![f32::NAN; channels];
            let (mut direction, mut pdf) = ([[f32::NAN; 3]], [f32::NAN]);
            let one = query..query + 1;
            let out = Sampled { directions: &mut direction, weights: &mut weight, pdfs: &mut pdf };
            machine.sample(&sampler, given, &queries.wi[one.clone()], &u[one], out);
            let found = direction[0].iter().chain(&pdf).chain(&weight);
            let expected = directions[query].iter().chain([&pdfs[query]]).chain(&weights[query * channels..]);
            found.zip(expected).all(|(a, b)| a.to_bits() == b.to_bits())
        });
        records.push(Record::exact(format!("{name}: single sample as batch"), agrees.collect::<Vec<bool>>()));
        let results = [
            ("directions", directions.into_flattened()),
            ("densities of samples", pdfs),
            ("weights", weights),
            ("densities", densities),
        ];
        records.extend(
            results.map(|(what, values)| Record::bounded(format!("{name}: {what}"), values, Bound::StrictOnly)),
        );
    }
    records
}

/// Pairs of numbers, among them the ends of the allowed range, and numbers outside it.
pub(super) fn numbers(count: usize) -> Vec<[f32; 2]> {
    let mut rng = Pcg32::seed_from_u64(12);
    let mut u: Vec<[f32; 2]> = (0..count).map(|_| [rng.random(), rng.random()]).collect();
    let ends = [0.0, 1.0, 1.0 - f32::EPSILON / 2.0, -1.0, f32::NAN];
    for (k, pair) in u.iter_mut().take(ends.len() * ends.len()).enumerate() {
        *pair = [ends[k % ends.len()], ends[k / ends.len()]];
    }
    u
}
