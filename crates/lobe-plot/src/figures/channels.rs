//! Curves of each channel.

use lobe::{Channels, Scatter};

use super::cartesian::{line, title};
use super::chart::{Axis, Chart, Mirror, Panel};
use super::legend::Entry;
use super::shared::{id, scatter_name, side_name};
use crate::evaluate::Progress;
use crate::in_plane::{Curve, MOST, channel_curves};
use crate::ink::Ink;
use crate::scale::{Scaling, degrees};
use crate::shown::Shown;

/// More panels than this, one per incidence and scatter, make the figure too long.
const PANELS: usize = 4;
/// At most this many incidences.
const INCIDENCES: usize = 3;
/// A channel is dark if its largest value is at most this share of the largest value of all.
const DARK: f64 = 1e-6;

/// The incidences to draw, each a panel.
pub(super) fn sigmas(shown: Shown<'_>) -> Vec<f64> {
    let most = (PANELS / shown.subject.scatters(shown.view.side).len().max(1)).min(INCIDENCES);
    // With one more, the last incidence is so low that it says more about the horizon than about the material.
    let mut sigmas = shown.view.incidences(shown.subject, most + 1);
    if shown.view.sigmas.is_empty() {
        sigmas.truncate(most);
    }
    sigmas
}

/// One panel per incidence, one curve per channel. If there are many channels, some of them are drawn, evenly chosen.
/// Dark channels have no curve, but are named in a line below the figure.
pub(super) fn chart<'a>(shown: Shown<'a>, progress: &dyn Progress) -> Chart<'a> {
    let Shown { subject, view } = shown;
    let channels = subject.material().channels();
    let chosen = chosen(channels.count());
    let curves = channel_curves(subject, view, &sigmas(shown), &chosen, progress);
    let is_dark = dark(&curves, chosen.len());
    let names = channels.names();
    let ink = |at: usize| match channels {
        Channels::Rgb => Ink::of_rgb(chosen[at]),
        Channels::Spectral(_) => Ink::of_channel(at, chosen.len()),
        Channels::Mono | Channels::Xyz | Channels::Named(_) => Ink::of_set(at),
    };
    let scatters = subject.scatters(view.side);
    let mut panels = Vec::new();
    for of_incidence in &curves {
        let Some(Curve { scatter, sigma, .. }) = of_incidence.first() else { continue };
        let lines = of_incidence
            .iter()
            .enumerate()
            .filter(|(at, _)| !is_dark[*at])
            .map(|(at, curve)| line(curve, ink(at), &format!("{}: ", names[chosen[at]])));
        let name = match scatters.len() {
            1 if *scatter == Scatter::Reflection => format!("σ = {}", degrees(*sigma)),
            _ => format!("{}, σ = {}", scatter_name(*scatter), degrees(*sigma)),
        };
        let group = usize::from(*scatter == Scatter::Transmission);
        panels.push(Panel { name, group, lines: lines.collect(), mirrors: vec![Mirror { ink: None, x: *sigma }] });
    }
    let entry = |at: usize| Entry { ink: ink(at), label: names[chosen[at]].clone() };
    let mut notes = Vec::new();
    if chosen.len() < channels.count() {
        notes.push(format!("{} of {} channels, evenly chosen.", chosen.len(), channels.count()));
    }
    let dark: Vec<&str> = (0..chosen.len()).filter(|&at| is_dark[at]).map(|at| names[chosen[at]].as_str()).collect();
    if !dark.is_empty() {
        notes.push(format!(
            "Not drawn, because no value is above a millionth of the largest value: {}.",
            dark.join(", ")
        ));
    }
    let mut what = format!("Channels in the plane of incidence, ψ\u{a0}=\u{a0}{}", degrees(view.psi));
    if subject.sides().len() > 1 {
        what = format!("{what}, light from the {}", side_name(view.side));
    }
    Chart {
        id: id("channels", view),
        shown: vec![shown],
        what,
        title: title(&[shown], "each channel of f against the viewing angle"),
        axis: Axis::Angle,
        scaling: view.scaling.unwrap_or(Scaling::Log),
        panels,
        legend: ("channel", (0..chosen.len()).filter(|&at| !is_dark[at]).map(entry).collect()),
        ends: ["light side", if scatters == [Scatter::Transmission] { "straight side" } else { "mirror side" }],
        notes,
    }
}

/// At most [`MOST`] channels, including the first and the last.
fn chosen(count: usize) -> Vec<usize> {
    match count {
        0..=MOST => (0..count).collect(),
        _ => (0..MOST).map(|at| at * (count - 1) / (MOST - 1)).collect(),
    }
}

/// `true` if each channel is dark everywhere.
fn dark(curves: &[Vec<Curve>], channels: usize) -> Vec<bool> {
    let largest = |at: usize| {
        let of = curves.iter().filter_map(|curves| curves.get(at)).flat_map(|curve| &curve.f);
        of.fold(0.0_f64, |largest, &f| largest.max(f64::from(f)))
    };
    let largest: Vec<f64> = (0..channels).map(largest).collect();
    let most = largest.iter().copied().fold(0.0, f64::max);
    largest.into_iter().map(|of_one| of_one <= DARK * most).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_channels_are_thinned_evenly() {
        assert_eq!(chosen(3), [0, 1, 2]);
        let of_many = chosen(195);
        assert_eq!((of_many.len(), of_many[0], of_many[7]), (8, 0, 194));
    }
}
