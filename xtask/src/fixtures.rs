//! `xtask fixtures`: the small tables that tests and benchmarks share, and the meshes that materials are shown on, made
//! from nothing but a seed.
//!
//! The sizes are those of the tables that the paper behind this project timed: 7 x 8 x 13 and 17 x 7 x 17 x 13.

mod compare;
mod provenance;
mod scenes;
mod tables;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use crate::steps::Steps;

/// Make the tables and meshes in fixtures/ from their seeds, or check those that are there.
#[derive(clap::Args)]
pub struct Args {
    /// Write nothing; fail if a file differs from what its seed gives: in a word, or in a number by more than 1e-4 of
    /// it (sine and cosine differ in the last bits from platform to platform); meshes must be the same bytes
    #[arg(long)]
    check: bool,
    /// Where the files are [default: fixtures]
    #[arg(long, value_name = "DIR", hide_default_value = true)]
    #[arg(default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures"))]
    directory: PathBuf,
}

/// Makes every fixture and writes or checks it.
pub fn run(args: &Args) -> Result<()> {
    let fixtures = [tables::conductor(), tables::paint(), tables::cloth()];
    let of_tables = fixtures.iter().map(|fixture| fixture.steps() as u64).sum::<u64>();
    let steps = Steps::new(of_tables + scenes::SCENES.len() as u64);
    let mut different = Vec::new();
    let mut hashes = Vec::new();
    for fixture in &fixtures {
        steps.begin(fixture.file);
        let path = args.directory.join(fixture.file);
        let made = lobe_formats::ddr::text(&fixture.measure(|| steps.done(1))?, &path)?;
        if args.check {
            let there = fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))?;
            if let Err(difference) = compare::compare(&there, &made) {
                different.push(format!("{}: {difference}", fixture.file));
            }
            hashes.push(provenance::hash(&there));
        } else {
            write_whole(&path, made.as_bytes())?;
            hashes.push(provenance::hash(&made));
        }
    }
    for scene in &scenes::SCENES {
        steps.begin(scene.file);
        let path = args.directory.join(scene.file);
        let made = (scene.make)();
        if !args.check {
            write_whole(&path, &made)?;
        } else if fs::read(&path).with_context(|| format!("reading {}", path.display()))? != made {
            different.push(format!("{}: other bytes", scene.file));
        }
        hashes.push(provenance::hash(&made));
        steps.done(1);
    }
    drop(steps);

    let readme = provenance::readme(&fixtures, &hashes);
    let path = args.directory.join("README.md");
    if !args.check {
        write_whole(&path, readme.as_bytes())?;
    } else if fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))? != readme {
        different.push("README.md: does not describe these files (parameters or hashes)".into());
    }
    if !different.is_empty() {
        bail!("fixtures differ from their seeds; `cargo xtask fixtures` makes them anew:\n{}", different.join("\n"));
    }
    let done = if args.check { "checked" } else { "written" };
    let (tables, meshes) = (fixtures.len(), scenes::SCENES.len());
    println!("{tables} tables, {meshes} meshes and README.md {done} in {}", args.directory.display());
    Ok(())
}

/// Writes a file in one step, into a folder that may not be there yet.
fn write_whole(path: &Path, content: &[u8]) -> Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).with_context(|| format!("making {}", folder.display()))?;
    Ok(lobe_formats::write_whole(path, content)?)
}
