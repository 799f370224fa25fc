//! Thousands of damaged files of every format must give a material or an error, never a panic, and never use more
//! memory than the size of the file can justify.
//!
//! The damage follows from a seed, so every run is the same. `LOBE_MUTATIONS` sets the number of damaged files per
//! sound one (400 by default), and `LOBE_MUTATION_SEED` the seed of the first of them (0 by default). A file that
//! breaks its reader is kept in `target/tmp`.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use lobe_formats::{Format, sniff};
use lobe_testing::probe::probe;
use lobe_testing::{damage, examples};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

lobe_testing::count_memory!();

/// Files beyond this size have fewer mutants, so that each file takes about as long.
const FULL_COUNT_SIZE: usize = 4_096;

/// Statistics of reading the files of a format.
#[derive(Default)]
struct Cost {
    files: usize,
    sound: usize,
    slowest: Duration,
    bytes_per_byte: f64,
}

/// Reads one file; if that goes wrong, keeps the file and reports its name.
fn run(format: Format, name: &str, bytes: &[u8], costs: &mut BTreeMap<&'static str, Cost>) -> bool {
    let start = Instant::now();
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        sniff(bytes);
        probe(format, bytes, Path::new(name))
    }));
    let Ok((result, peak)) = outcome else {
        let kept = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::write(&kept, bytes).expect("a file in target/tmp");
        panic!("reading {} as {format} failed; see the panic before this one", kept.display());
    };
    let cost = costs.entry(format.name()).or_default();
    cost.files += 1;
    cost.sound += usize::from(result.is_ok());
    cost.slowest = cost.slowest.max(start.elapsed());
    // Even a short file must give an error.
    cost.bytes_per_byte = cost.bytes_per_byte.max(peak as f64 / bytes.len().max(1_000) as f64);
    result.is_ok()
}

/// A number from the environment.
fn variable(name: &str, default: usize) -> usize {
    std::env::var(name)
        .map_or(default, |value| value.parse().unwrap_or_else(|_| panic!("{name} is not a number: {value}")))
}

/// A single test, so that no other thread allocates meanwhile.
#[test]
fn damaged_files_do_no_harm() {
    let (count, first) = (variable("LOBE_MUTATIONS", 400), variable("LOBE_MUTATION_SEED", 0));
    let mut files = examples::all();
    let own = files.len();
    if let Some(shared) = lobe_testing::files::shared() {
        for path in ["golden", "data"].iter().flat_map(|folder| lobe_testing::files::small_files(&shared.join(folder)))
        {
            let bytes = lobe_testing::files::bytes(&path);
            files.extend(sniff(&bytes).map(|format| (format, bytes)));
        }
    }
    files.push((Format::Utia, vec![0; 1_990_656]));
    let mut costs = BTreeMap::new();
    for (index, (format, bytes)) in files.iter().enumerate() {
        let name = |change: &str| format!("{format:?}-{index}-{change}");
        let is_sound = run(*format, &name("sound"), bytes, &mut costs);
        if index < own {
            assert!(is_sound, "our own file {index}, {format}, is not sound");
            for end in 0..bytes.len() {
                run(*format, &name(&format!("cut-{end}")), &bytes[..end], &mut costs);
            }
        }
        let same: Vec<&[u8]> = files.iter().filter(|(other, _)| other == format).map(|(_, bytes)| &bytes[..]).collect();
        let mutants = (count * FULL_COUNT_SIZE / bytes.len().max(FULL_COUNT_SIZE)).max(1);
        for seed in first..first + mutants {
            let mut random = Pcg64Mcg::seed_from_u64((seed << 16 | index) as u64);
            let mutant = damage::mutant(&mut random, bytes, same[seed % same.len()]);
            run(*format, &name(&format!("seed-{seed}")), &mutant, &mut costs);
        }
    }
    for (format, Cost { files, sound, slowest, bytes_per_byte }) in costs {
        println!("{format}: {files} files, {sound} sound, {bytes_per_byte:.1} bytes per byte, slowest {slowest:.1?}");
    }
}
