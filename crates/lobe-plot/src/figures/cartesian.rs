//! Curves against the viewing angle.

use lobe::Scatter;

use super::chart::{Axis, Chart, Hint, Line, Mirror, Panel};
use super::legend::Entry;
use super::shared::{conditions, id, scatter_name};
use crate::in_plane::Curve;
use crate::ink::Ink;
use crate::scale::{Scaling, degrees, short};
use crate::shown::Shown;

/// The distance, in degrees, of hints on a curve between measured points.
const EVERY: f64 = 5.0;

/// Reflection above transmission, with one curve per incidence; for several files, one panel per incidence and one
/// curve per file. `curves` holds the curves of each file.
pub(super) fn chart<'a>(shown: &[Shown<'a>], curves: &[Vec<Curve>], scaling: Option<Scaling>) -> Chart<'a> {
    let scaling = scaling.unwrap_or(Scaling::Log);
    let (panels, legend) = match curves {
        [of_one] => of_incidences(of_one),
        _ => of_files(shown, curves, scaling),
    };
    let transmits = panels.iter().all(|panel| panel.name.starts_with("transmission")) && !panels.is_empty();
    let name = if scaling == Scaling::Log { "curves-log" } else { "curves-linear" };
    Chart {
        id: shown.first().map_or_else(String::new, |first| id(name, first.view)),
        shown: shown.to_vec(),
        what: format!("In the plane of incidence, {}", conditions(shown)),
        title: title(shown, "f against the viewing angle in the plane of incidence"),
        axis: Axis::Angle,
        scaling,
        panels,
        legend,
        ends: ["light side", if transmits { "straight side" } else { "mirror side" }],
        notes: Vec::new(),
    }
}

pub(super) fn title(shown: &[Shown<'_>], what: &str) -> String {
    let names: Vec<&str> = shown.iter().map(|shown| shown.subject.name()).collect();
    format!("{}: {what}", names.join(", "))
}

/// The incidences of some curves, each once.
pub(super) fn incidences<'a>(curves: impl IntoIterator<Item = &'a Curve>) -> Vec<f64> {
    let mut sigmas: Vec<f64> = Vec::new();
    for curve in curves {
        if !sigmas.contains(&curve.sigma) {
            sigmas.push(curve.sigma);
        }
    }
    sigmas
}

/// The scatters of the curves, each once.
fn scatters<'a>(curves: impl IntoIterator<Item = &'a Curve>) -> Vec<Scatter> {
    let mut found: Vec<Scatter> = curves.into_iter().map(|curve| curve.scatter).collect();
    found.sort_by_key(|scatter| *scatter == Scatter::Transmission);
    found.dedup();
    found
}

type Legend = (&'static str, Vec<Entry>);

fn of_incidences(curves: &[Curve]) -> (Vec<Panel>, Legend) {
    let (sigmas, scatters) = (incidences(curves), scatters(curves));
    let ink = |index: usize| Ink::of_order(index, sigmas.len());
    let mut panels = Vec::new();
    for (group, &scatter) in scatters.iter().enumerate() {
        let of = |sigma: f64| curves.iter().find(|curve| curve.sigma == sigma && curve.scatter == scatter);
        let of_incidence = |(index, &sigma): (usize, &f64)| Some(line(of(sigma)?, ink(index), ""));
        let lines = sigmas.iter().enumerate().filter_map(of_incidence).collect();
        let mirrors = sigmas.iter().enumerate().map(|(index, &x)| Mirror { ink: Some(ink(index)), x }).collect();
        let name = match scatters.len() {
            1 if scatter == Scatter::Reflection => "",
            _ => scatter_name(scatter),
        };
        panels.push(Panel { name: name.into(), group, lines, mirrors });
    }
    let entry = |(index, sigma): (usize, &f64)| Entry { ink: ink(index), label: degrees(*sigma) };
    (panels, ("incidence σ", sigmas.iter().enumerate().map(entry).collect()))
}

fn of_files(shown: &[Shown<'_>], curves: &[Vec<Curve>], scaling: Scaling) -> (Vec<Panel>, Legend) {
    let (sigmas, scatters) = (incidences(curves.iter().flatten()), scatters(curves.iter().flatten()));
    let mut panels = Vec::new();
    for (group, &scatter) in scatters.iter().enumerate() {
        for &sigma in &sigmas {
            let of_file = |(index, curves): (usize, &Vec<Curve>)| {
                let curve = curves.iter().find(|curve| curve.sigma == sigma && curve.scatter == scatter)?;
                Some(line(curve, Ink::of_set(index), &format!("{}: ", shown[index].subject.name())))
            };
            let lines = curves.iter().enumerate().filter_map(of_file).collect();
            let name = match scatters.len() {
                1 if scatter == Scatter::Reflection => format!("σ = {}", degrees(sigma)),
                _ => format!("{}, σ = {}", scatter_name(scatter), degrees(sigma)),
            };
            // On a common linear axis, peaks for grazing light would make the other curves invisible.
            let group = if scaling == Scaling::Linear { panels.len() } else { group };
            panels.push(Panel { name, group, lines, mirrors: vec![Mirror { ink: None, x: sigma }] });
        }
    }
    let entry =
        |(index, shown): (usize, &Shown<'_>)| Entry { ink: Ink::of_set(index), label: shown.subject.name().into() };
    (panels, ("file", shown.iter().enumerate().map(entry).collect()))
}

/// A curve with hints at the measured points, if they are few, otherwise every few degrees; and at the largest value.
pub(super) fn line(curve: &Curve, ink: Ink, name: &str) -> Line {
    let text = |at: usize| {
        let kind = if curve.is_measured[at] { "" } else { ", not measured" };
        format!(
            "{name}σ = {}, θ = {}: {} 1/sr{kind}",
            degrees(curve.sigma),
            degrees(curve.theta[at]),
            short(f64::from(curve.f[at]))
        )
    };
    let hint = |at: usize, is_point: bool| Hint { at, is_point, text: text(at) };
    let mut hints: Vec<Hint> = curve.points.iter().map(|&at| hint(at, true)).collect();
    let mut last = f64::NEG_INFINITY;
    for (at, theta) in curve.theta.iter().enumerate() {
        let theta = theta.to_degrees();
        let is_near = |point: &&usize| (curve.theta[**point].to_degrees() - theta).abs() < EVERY;
        if theta >= last + EVERY - 1e-6 && !curve.points.iter().any(|point| is_near(&point)) {
            hints.push(hint(at, false));
            last = theta;
        }
    }
    let peak = (0..curve.f.len()).max_by(|&a, &b| curve.f[a].total_cmp(&curve.f[b]));
    hints.extend(peak.filter(|at| !curve.points.contains(at)).map(|at| hint(at, false)));
    Line { ink, x: curve.theta.clone(), f: curve.f.clone(), is_measured: curve.is_measured.clone(), hints }
}
