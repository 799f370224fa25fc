//! Interpolates tables at known angles.

use lobe_table::Edges;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::bound::SUM;
use super::machine::Machine;
use super::record::{Bound, Record};
use super::tables::{Case, cases};

/// Queries of each table: whole blocks, and a remainder that is not a multiple of any number of lanes.
const QUERIES: usize = 64 * 2 + 5;

/// Every table once, at angles inside and outside its knots, on them, and at NaN and infinities.
pub(super) fn record(machine: impl Machine) -> Vec<Record> {
    let tables = cases().iter().filter(|case| case.name.ends_with("incoherent"));
    tables.enumerate().map(|(seed, case)| interpolate(machine, case, seed as u64)).collect()
}

fn interpolate(machine: impl Machine, case: &Case, seed: u64) -> Record {
    let Case { name, table, largest, .. } = case;
    let name = name.trim_end_matches(", incoherent");
    let angles = angles(seed);
    let mut values = vec![f32::NAN; QUERIES * table.channel_count()];
    machine.interpolate(table, angles.each_ref().map(Vec::as_slice), &mut values);
    // Cells and fractions of the same angles have the same bits in both forms, so only the sums differ; beyond the
    // knots of a table that is extrapolated linearly, weights may have any size.
    let bound = if *table.edges() == Edges::extrapolate() {
        Bound::StrictOnly
    } else {
        Bound::Each(vec![SUM * largest; values.len()])
    };
    Record::bounded(format!("{name}, at known angles"), values, bound)
}

/// Sigma, psi, theta and phi.
fn angles(seed: u64) -> [Vec<f32>; 4] {
    let mut rng = Pcg32::seed_from_u64(seed);
    let mut angles =
        [1.7f32, 6.4, 3.3, 6.4].map(|end| (0..QUERIES).map(|_| rng.random_range(-0.1..end)).collect::<Vec<f32>>());
    for (axis, column) in angles.iter_mut().enumerate() {
        let special = [0.0, -0.0, std::f32::consts::FRAC_PI_2, std::f32::consts::TAU, f32::NAN, f32::INFINITY, 1e-40];
        for (k, angle) in special.into_iter().enumerate() {
            column[7 * axis + k] = angle;
        }
    }
    angles
}
