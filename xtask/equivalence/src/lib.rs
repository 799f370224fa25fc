//! `cargo xtask equivalence`: checks every backend against the scalar reference.
//!
//! A [`Property`] records, generic over the lanes, rows of results that must not depend on the backend. In strict form
//! they must have the same bits as those of [`Scalar<1>`](lobe_scalar::Scalar), with all NaNs treated as equal; in
//! fused form floats may differ within a stated bound.
#![forbid(unsafe_code)]

mod axes;
mod bound;
mod evaluation;
mod interpolation;
mod lanes;
mod machine;
mod math;
mod memory;
mod record;
mod report;
mod representations;
mod rgl;
mod sampling;
mod subject;
mod tables;
mod texels;

use std::path::PathBuf;

use machine::Machine;
pub use record::{Bound, Check, Record, Values};
pub use subject::{Form, Subject, facade_agrees, reference};

/// A group of results on which all backends must agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// Arithmetic and comparison of floats.
    Floats,
    /// Arithmetic and comparison of integers.
    Ints,
    /// Masks, and operations that depend on the number of lanes.
    Masks,
    /// Loads, stores and gathers.
    Memory,
    /// Quads and octs.
    Texels,
    /// The functions of `lobe_math`.
    Math,
    /// Searches of axes.
    Axes,
    /// Whole evaluations of specular tables.
    Evaluation,
    /// Interpolation at known angles.
    Interpolation,
    /// Materials of the EPFL database: values, densities and samples.
    Rgl,
    /// Samples of tables and their densities.
    Sampling,
    /// Whole evaluations of other representations.
    Representations,
}

impl Property {
    /// All of them.
    pub const ALL: [Property; 12] = [
        Self::Floats,
        Self::Ints,
        Self::Masks,
        Self::Memory,
        Self::Texels,
        Self::Math,
        Self::Axes,
        Self::Evaluation,
        Self::Interpolation,
        Self::Rgl,
        Self::Sampling,
        Self::Representations,
    ];

    /// The name in the printed table.
    pub fn name(self) -> &'static str {
        match self {
            Property::Floats => "floats",
            Property::Ints => "ints",
            Property::Masks => "masks",
            Property::Memory => "memory",
            Property::Texels => "texels",
            Property::Math => "math",
            Property::Axes => "axes",
            Property::Evaluation => "evaluation",
            Property::Interpolation => "interpolation",
            Property::Rgl => "rgl",
            Property::Sampling => "sampling",
            Property::Representations => "representations",
        }
    }

    /// Computes all results in one way of running them.
    fn record(self, machine: impl Machine) -> Vec<Record> {
        match self {
            Property::Floats => machine.run(lanes::FloatLanes),
            Property::Ints => machine.run(lanes::IntLanes),
            Property::Masks => machine.run(lanes::Masks),
            Property::Memory => machine.run(memory::Memory),
            Property::Texels => machine.run(texels::QuadsAndOcts),
            Property::Math => machine.run(math::Functions),
            Property::Axes => machine.run(axes::Searches),
            Property::Evaluation => evaluation::record(machine),
            Property::Interpolation => interpolation::record(machine),
            Property::Rgl => rgl::record(machine),
            Property::Sampling => sampling::record(machine),
            Property::Representations => representations::record(machine),
        }
    }
}

/// Compares what a backend recorded with the reference, record by record; records of the same name become one check.
pub fn compare(found: &[Record], reference: &[Record], backend: &str, form: Form) -> Vec<Check> {
    assert_eq!(found.len(), reference.len(), "{backend}: its records differ from those of the reference");
    let mut checks: Vec<Check> = Vec::new();
    for (found, reference) in found.iter().zip(reference) {
        let Some(check) = found.compare(reference, backend, form) else { continue };
        match checks.iter_mut().find(|earlier| earlier.what == check.what) {
            Some(earlier) => earlier.merge(check),
            None => checks.push(check),
        }
    }
    checks
}

/// Check every backend of this CPU against the scalar reference, bit by bit
#[derive(clap::Parser, Debug)]
#[command(bin_name = "cargo xtask equivalence")]
pub struct Args {
    /// Check only this backend, which must be available
    #[arg(long = "backend", value_name = "NAME")]
    backends: Vec<String>,
    /// Write all checks to this file, as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write a line for each backend to this file, as JSON, and print nothing
    #[arg(long, value_name = "FILE", hide = true)]
    summary: Option<PathBuf>,
}

/// Runs everything, prints a table, and writes the requested file.
///
/// # Errors
/// If a check fails, a backend does not run that was requested or that this CPU should have, or the file cannot be
/// written.
pub fn run(args: &Args) -> anyhow::Result<()> {
    let outcome = report::Outcome::measure(&args.backends);
    if let Some(path) = &args.summary {
        return report::write(path, &outcome.summary());
    }
    outcome.print();
    if let Some(path) = &args.json {
        report::write(path, &outcome)?;
    }
    outcome.verdict()
}
