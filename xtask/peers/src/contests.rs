//! All contests, with the files that the peers need for them.

use std::path::Path;

use super::contest::Contest;
use super::exchange::Exchange;
use super::{analytic, frames, interpolation, material, python, tracing, trigonometry};

/// The contests whose names begin with one of `only`, or all. Files and tasks go to `exchange`.
///
/// # Errors
/// If a measured material cannot be read, or a file cannot be written.
pub fn all(data: &Path, exchange: &mut Exchange, only: &[String]) -> anyhow::Result<Vec<Contest>> {
    let mut contests = vec![trigonometry::acos(exchange)?];
    contests.extend(interpolation::all(exchange)?);
    contests.extend(analytic::all(exchange)?);
    contests.extend(material::all(data, exchange)?);
    contests.extend(python::all(data, exchange)?);
    // Scenes are large, so they are made only if they are needed.
    let wants = |prefix: &str| {
        only.is_empty() || only.iter().any(|start| start.starts_with(prefix) || prefix.starts_with(start.as_str()))
    };
    if wants(tracing::PREFIX) {
        contests.extend(tracing::all(data, exchange)?);
    }
    if wants(frames::PREFIX) {
        contests.extend(frames::all(data, exchange)?);
    }
    contests.retain(|contest| only.is_empty() || only.iter().any(|start| contest.name().starts_with(start.as_str())));
    Ok(contests)
}
