//! Checks that the machine runs as fast as usual.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use serde::Serialize;

/// Number of multiplications in a chain, each of which waits for the one before; a chain takes about fifty
/// microseconds.
const CHAIN: usize = 50_000;
/// Number of chains, of which the shortest counts, because other work makes them longer.
const TIMES: usize = 400;
/// If a run is slower than the fastest run on this processor by more than this, the machine was slow.
const SLOWER: f64 = 1.05;

/// Nanoseconds of a multiplication that waits for another one, a few cycles on any processor.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Speed {
    /// Before the first contest.
    pub start: f64,
    /// After the last one.
    pub end: f64,
    /// The shortest time ever measured on this processor.
    pub usual: f64,
}

impl Speed {
    /// A description of it, which mentions slow runs.
    pub fn text(&self) -> String {
        let Speed { start, end, usual } = self;
        let verdict = if start.max(*end) > SLOWER * usual { ": the machine was slow" } else { "" };
        format!("{start:.3} ns at the start, {end:.3} ns at the end, {usual:.3} ns at best{verdict}")
    }
}

/// Nanoseconds of a multiplication in a chain.
pub fn measure() -> f64 {
    let chain = || {
        let (start, factor) = (Instant::now(), black_box(1.000_000_1_f64));
        let mut x = black_box(1.0);
        for _ in 0..CHAIN {
            x *= factor;
        }
        black_box(x);
        start.elapsed().as_secs_f64() / CHAIN as f64 * 1e9
    };
    (0..TIMES).map(|_| chain()).fold(f64::INFINITY, f64::min)
}

/// The speed of a run, with the best of all runs on such a processor, which is kept in a file.
///
/// # Errors
/// If the file cannot be written. A file that cannot be read counts as missing.
pub fn kept(file: &Path, cpu: &str, [start, end]: [f64; 2]) -> anyhow::Result<Speed> {
    let mut known: BTreeMap<String, f64> =
        std::fs::read_to_string(file).ok().and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
    let usual = known.get(cpu).copied().unwrap_or(f64::INFINITY).min(start).min(end);
    known.insert(cpu.into(), usual);
    xtask_common::replace(file, serde_json::to_string_pretty(&known)? + "\n")?;
    Ok(Speed { start, end, usual })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fastest_run_is_kept_and_slower_ones_are_named() {
        let file = std::env::temp_dir().join(format!("lobe-speed-{}.json", std::process::id()));
        assert!(!kept(&file, "a", [1.0, 1.02]).unwrap().text().contains("slow"));
        assert!(kept(&file, "a", [1.01, 1.2]).unwrap().text().contains("slow"));
        assert!(!kept(&file, "b", [1.2, 1.2]).unwrap().text().contains("slow"));
        assert_eq!(kept(&file, "a", [0.9, 2.0]).unwrap().usual, 0.9);
        std::fs::remove_file(&file).unwrap();
    }
}
