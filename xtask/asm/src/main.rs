//! `cargo xtask asm`: checks that every intrinsic is inlined in the release binaries.
//!
//! A helper that is generic over the lanes but not `#[inline(always)]` is compiled without the backend's features, so
//! each intrinsic in it becomes a call to a function of one instruction. That costs up to a factor of 75. No compiler
//! warns about it, but the function leaves a symbol. A multiply-add of single floats becomes a call of the C library.
#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail, ensure};
use clap::Parser;
use object::{Architecture, Object, ObjectSymbol, SymbolKind};

/// The package that calls kernels in every way, and the package that users run.
const PACKAGES: [&str; 2] = ["xtask-report", "lobe-cli"];

/// Check that no SIMD intrinsic is called out of line in the release binaries
#[derive(Parser, Debug)]
#[command(bin_name = "cargo xtask asm")]
struct Args {
    /// Packages whose binaries are checked
    #[arg(long = "package", value_name = "NAME", value_delimiter = ',', default_values = PACKAGES)]
    packages: Vec<String>,
    /// Programs that are checked instead
    #[arg(long = "binary", value_name = "FILE", conflicts_with = "packages")]
    binaries: Vec<PathBuf>,
}

/// Builds the binaries in release mode and searches their symbols.
///
/// # Errors
/// If the build fails, a binary has no symbols, or an intrinsic is out of line.
fn main() -> anyhow::Result<()> {
    let args = Args::parse();
    let mut found = Vec::new();
    let binaries = if args.binaries.is_empty() { build(&args.packages)? } else { args.binaries };
    for binary in binaries {
        let symbols = Symbols::read(&binary)?;
        println!("{}: {} functions", binary.display(), symbols.functions);
        for name in &symbols.detection {
            println!("  detection, allowed: {name}");
        }
        for name in &symbols.out_of_line {
            println!("  OUT OF LINE: {name}");
        }
        found.extend(symbols.out_of_line);
    }
    ensure!(
        found.is_empty(),
        "{} intrinsics out of line: some function that is generic over the lanes is not `#[inline(always)]`",
        found.len()
    );
    println!("no intrinsic out of line");
    Ok(())
}

/// Builds, and returns the paths of the executables.
///
/// One package at a time: built together, their dependencies would have different features, and everything would have
/// to be compiled again.
fn build(packages: &[String]) -> anyhow::Result<Vec<PathBuf>> {
    let mut binaries = Vec::new();
    for package in packages {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["build", "--release", "--bins", "--message-format=json-render-diagnostics", "--package", package]);
        let output = cargo.stderr(std::process::Stdio::inherit()).output().context("cannot run cargo")?;
        ensure!(output.status.success(), "the release build of {package} failed");
        let built = executables(&output.stdout)?;
        ensure!(built.len() == 1, "the build of {package} produced {built:?}; expected one binary");
        binaries.extend(built);
    }
    Ok(binaries)
}

/// The executables named in cargo's messages.
fn executables(messages: &[u8]) -> anyhow::Result<Vec<PathBuf>> {
    let mut binaries = Vec::new();
    for line in messages.split(|&byte| byte == b'\n').filter(|line| !line.is_empty()) {
        let message: serde_json::Value = serde_json::from_slice(line).context("a message of cargo")?;
        binaries.extend(message["executable"].as_str().map(PathBuf::from));
    }
    Ok(binaries)
}

/// Findings in the symbols of a binary.
#[derive(Debug, Default)]
struct Symbols {
    functions: usize,
    /// Functions of `core::arch` that detect the features of the CPU.
    detection: Vec<String>,
    /// Intrinsics that should have been inlined.
    out_of_line: Vec<String>,
}

impl Symbols {
    fn read(path: &Path) -> anyhow::Result<Self> {
        let bytes = std::fs::read(path).with_context(|| format!("{}: cannot be read", path.display()))?;
        let file = object::File::parse(&*bytes).with_context(|| format!("{}: not an object file", path.display()))?;
        let mut symbols = Symbols::default();
        // Functions of other libraries are symbols without a kind.
        if file.architecture() == Architecture::X86_64 {
            let names = file.symbols().chain(file.dynamic_symbols()).filter_map(|symbol| symbol.name().ok());
            symbols.out_of_line.extend(names.filter(|name| is_slow_multiply_add(name)).map(String::from));
        }
        for symbol in file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text) {
            symbols.functions += 1;
            symbols.sort_in(symbol.name().unwrap_or_default());
        }
        if symbols.functions == 0 {
            bail!("{}: no symbols, so it cannot be checked; was it stripped?", path.display());
        }
        Ok(symbols)
    }

    /// Classifies the name of a function.
    fn sort_in(&mut self, mangled: &str) {
        let name = format!("{:#}", rustc_demangle::demangle(mangled));
        if !name.contains("core_arch::") {
            return;
        }
        let function = name.rsplit("::").next().unwrap_or_default();
        // On Arm and in WebAssembly, names of intrinsics begin with a letter; the name of a trait's function begins
        // with `<`.
        let is_elsewhere = ["aarch64::", "arm_shared::", "wasm32::"].iter().any(|part| name.contains(part));
        if function.starts_with("_mm") || (is_elsewhere && !name.starts_with('<')) {
            self.out_of_line.push(name);
        } else if function == "_xgetbv" || function.starts_with("__cpuid") {
            self.detection.push(name);
        }
    }
}

/// The function that a multiply-add of floats becomes if the processor is not known to have the instruction: it
/// computes the result bit by bit.
fn is_slow_multiply_add(name: &str) -> bool {
    // Linkers add the version of the library.
    name.split('@').next() == Some("fmaf")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intrinsics_are_found_in_both_manglings() {
        let mut symbols = Symbols::default();
        symbols.sort_in("_ZN4core9core_arch3x863avx16_mm256_blendv_ps17h0123456789abcdefE");
        symbols.sort_in("_RNvNtNtNtCs1234_4core9core_arch3x864sse210__mm_add_ps");
        assert_eq!(symbols.out_of_line.len(), 2, "{symbols:?}");
        symbols.sort_in("_ZN4core9core_arch10arm_shared4neon9generated9vaddq_f3217h0123456789abcdefE");
        assert_eq!(symbols.out_of_line.len(), 3, "{symbols:?}");
        symbols.sort_in("_ZN4core9core_arch3x865xsave7_xgetbv17h0123456789abcdefE");
        symbols.sort_in("_ZN8lobe_avx5lanes6_mm_no17h0123456789abcdefE");
        assert_eq!((symbols.out_of_line.len(), symbols.detection.len()), (3, 1), "{symbols:?}");
    }

    #[test]
    fn multiply_adds_by_function_call_are_found() {
        for (name, found) in [("fmaf", true), ("fmaf@GLIBC_2.2.5", true), ("fma", false), ("xfmaf", false)] {
            assert_eq!(is_slow_multiply_add(name), found, "{name}");
        }
    }

    #[test]
    fn the_functions_of_an_executable_are_found() {
        let symbols = Symbols::read(&std::env::current_exe().unwrap()).unwrap();
        assert!(symbols.functions > 1000, "{symbols:?}");
    }

    #[test]
    fn executables_are_read_from_the_messages_of_cargo() {
        let messages = b"{\"reason\":\"x\",\"executable\":null}\n{\"executable\":\"/t/lobe\"}\n{\"success\":true}\n";
        assert_eq!(executables(messages).unwrap(), [PathBuf::from("/t/lobe")]);
    }
}
