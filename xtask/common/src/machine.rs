//! Describes the machine that the figures come from.

use std::process::Command;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

/// The machine, the compiler and the source.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Machine {
    /// Model of the processor.
    pub cpu: String,
    /// Logical cores.
    pub cores: usize,
    /// SIMD extensions, as detected by the program.
    pub features: Vec<String>,
    /// Mean number of processes that wanted a core during the minute before the run began: above 1, figures are noisy.
    pub load: Option<f64>,
    /// Compiler and its target.
    pub compiler: String,
    /// Date and time in UTC.
    pub date: String,
    /// Commit of the source, with `+changes` if files differ from it.
    pub commit: String,
}

impl Machine {
    /// Describes this process.
    pub fn here() -> Self {
        let compiler = format!("{}, {}, opt-level {}", env!("LOBE_RUSTC"), env!("LOBE_TARGET"), env!("LOBE_OPT_LEVEL"));
        Machine {
            cpu: cpu(),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            features: features(),
            load: load(),
            compiler,
            date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            commit: commit(),
        }
    }
}

fn cpu() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or_else(|| std::env::consts::ARCH.into(), |(_, name)| name.trim().into())
}

fn load() -> Option<f64> {
    std::fs::read_to_string("/proc/loadavg").ok()?.split_whitespace().next()?.parse().ok()
}

#[cfg(target_arch = "x86_64")]
fn features() -> Vec<String> {
    let mut found = Vec::new();
    macro_rules! detect {
        ($($name:tt)*) => { $(if std::is_x86_feature_detected!($name) { found.push($name.to_owned()); })* };
    }
    detect!("sse2" "sse4.1" "popcnt" "avx" "f16c" "fma" "avx2" "bmi1" "bmi2" "lzcnt" "avx512f" "avx512vbmi2");
    found
}

#[cfg(not(target_arch = "x86_64"))]
fn features() -> Vec<String> {
    Vec::new()
}

fn commit() -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let Some(hash) = git(&["rev-parse", "--short=12", "HEAD"]) else { return "unknown".into() };
    match git(&["status", "--porcelain"]) {
        Some(changes) if changes.is_empty() => hash,
        _ => hash + "+changes",
    }
}
