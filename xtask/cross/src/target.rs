//! The targets that are tested, and how they run here.

use std::ffi::OsString;
use std::path::Path;

use anyhow::{bail, ensure};
use clap::ValueEnum;

use super::install;

/// An instruction set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// NEON
    Aarch64,
    /// simd128 of WebAssembly
    Wasm,
    /// x86-64 without anything newer
    Sse2,
    /// AVX-512
    Avx512,
}

/// How cargo builds and runs programs of a target.
#[derive(Debug, Default)]
pub struct Setup {
    /// Environment variables of cargo.
    pub environment: Vec<(String, OsString)>,
    /// `true` if a panic ends the program.
    pub panics_end: bool,
    /// Arguments to test programs.
    pub harness: &'static [&'static str],
}

impl Setup {
    fn set(&mut self, name: impl Into<String>, value: impl Into<OsString>) {
        self.environment.push((name.into(), value.into()));
    }

    /// Sets a variable that cargo has for each target of rustc.
    fn set_of(&mut self, triple: &str, key: &str, value: impl Into<OsString>) {
        self.set(format!("CARGO_TARGET_{}_{key}", triple.to_uppercase().replace('-', "_")), value);
    }
}

const HOST: &str = std::env::consts::ARCH;

impl Target {
    pub const ALL: [Target; 4] = [Target::Aarch64, Target::Wasm, Target::Sse2, Target::Avx512];

    pub fn name(self) -> &'static str {
        match self {
            Target::Aarch64 => "aarch64",
            Target::Wasm => "wasm",
            Target::Sse2 => "sse2",
            Target::Avx512 => "avx512",
        }
    }

    /// The name of its backend.
    pub fn backend(self) -> &'static str {
        match self {
            Target::Aarch64 => "neon",
            Target::Wasm => "simd128",
            Target::Sse2 => "sse2",
            Target::Avx512 => "avx512",
        }
    }

    /// The crate of its backend.
    pub fn backend_crate(self) -> &'static str {
        match self {
            Target::Aarch64 => "lobe-neon",
            Target::Wasm => "lobe-wasm",
            Target::Sse2 => "lobe-sse",
            Target::Avx512 => "lobe-avx512",
        }
    }

    /// How its programs are run here, with all tools that they need.
    ///
    /// # Errors
    /// The reason why they cannot be run.
    pub fn setup(self) -> anyhow::Result<Setup> {
        let mut setup = Setup::default();
        match self {
            Target::Aarch64 if HOST == "aarch64" => {}
            Target::Aarch64 => {
                // Without a system library: rustc provides everything that programs are linked with, and qemu needs no
                // files.
                let triple = "aarch64-unknown-linux-musl";
                install::rust_target(triple)?;
                setup.set("CARGO_BUILD_TARGET", triple);
                setup.set_of(triple, "LINKER", "rust-lld");
                // The oldest of them.
                let mut runner = install::qemu("aarch64")?.into_os_string();
                runner.push(" -cpu cortex-a53");
                setup.set_of(triple, "RUNNER", runner);
                setup.set("LOBE_EMULATED", "1");
            }
            Target::Wasm => {
                let triple = "wasm32-wasip1";
                let node = install::node()?;
                install::rust_target(triple)?;
                setup.set("CARGO_BUILD_TARGET", triple);
                // The stack of a main thread on other systems, and so much memory that it need not grow: then it may move,
                // but node would read and write where it was before, and crash.
                let memory = "-C link-arg=-zstack-size=8388608 -C link-arg=--initial-memory=3221225472";
                setup.set_of(triple, "RUSTFLAGS", format!("-C target-feature=+simd128 {memory}"));
                let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/wasi.mjs");
                let mut runner = node.into_os_string();
                runner.push(" --no-warnings ");
                runner.push(script);
                setup.set_of(triple, "RUNNER", runner);
                // A panic ends the program, and captured output is lost.
                setup.panics_end = true;
                setup.harness = &["--nocapture"];
            }
            Target::Sse2 => {
                ensure!(
                    HOST == "x86_64" && cfg!(target_os = "linux"),
                    "qemu can run the programs only on Linux on x86-64"
                );
                let mut runner = install::qemu("x86_64")?.into_os_string();
                runner.push(" -cpu core2duo");
                setup.set_of("x86_64-unknown-linux-gnu", "RUNNER", runner);
                setup.set("LOBE_EMULATED", "1");
            }
            Target::Avx512 => has_avx512()?,
        }
        Ok(setup)
    }
}

#[cfg(target_arch = "x86_64")]
fn has_avx512() -> anyhow::Result<()> {
    let has = std::is_x86_feature_detected!("avx512f")
        && std::is_x86_feature_detected!("avx512vl")
        && std::is_x86_feature_detected!("avx512dq")
        && std::is_x86_feature_detected!("avx512bw")
        && std::is_x86_feature_detected!("avx512vbmi2");
    if !has {
        bail!("this processor has no AVX-512 (F, VL, DQ, BW, VBMI2), and qemu does not emulate it");
    }
    Ok(())
}

#[cfg(not(target_arch = "x86_64"))]
fn has_avx512() -> anyhow::Result<()> {
    bail!("this is not an x86-64 processor");
}
