//! Values against the wavelength.

use lobe::Scatter;

use super::cartesian::title;
use super::channels;
use super::chart::{Axis, Chart, Hint, Line, Panel};
use super::legend::Entry;
use super::shared::{id, scatter_name, side_name};
use crate::evaluate::Progress;
use crate::ink::Ink;
use crate::scale::{Scaling, degrees, short};
use crate::shown::Shown;
use crate::spectra::{Spectrum, spectra};

/// If there are more wavelengths than this, not each has a dot and a hint.
const FEW: usize = 48;
/// If the largest value of one line is this many times that of another, a linear axis shows only the first.
const WIDE: f32 = 20.0;

/// One panel per incidence, one line per viewing angle; `None` if the channels are not wavelengths.
pub(super) fn chart<'a>(shown: Shown<'a>, progress: &dyn Progress) -> Option<Chart<'a>> {
    let Shown { subject, view } = shown;
    let sigmas = channels::sigmas(shown);
    let spectra = spectra(subject, view, &sigmas, progress)?;
    let scatters = subject.scatters(view.side);
    // Viewing angles that are relative to the mirror direction are the same series at every incidence.
    let count = sigmas.first().map_or(0, |&sigma| view.viewing_angles(sigma).len());
    let ink = |at: usize| Ink::of_channel(at, count);
    let panels_of = || spectra.chunks(count.max(1));
    let is_wide = panels_of().any(is_wide);
    let scaling = view.scaling.unwrap_or(if is_wide { Scaling::Log } else { Scaling::Linear });
    let mut panels = Vec::new();
    for of_incidence in panels_of() {
        let Spectrum { sigma, scatter, .. } = &of_incidence[0];
        let name = match scatters.len() {
            1 if *scatter == Scatter::Reflection => format!("σ = {}", degrees(*sigma)),
            _ => format!("{}, σ = {}", scatter_name(*scatter), degrees(*sigma)),
        };
        let lines = of_incidence.iter().enumerate().map(|(at, spectrum)| line(spectrum, ink(at))).collect();
        // On a common linear axis, peaks for grazing light would make the other lines invisible.
        let group =
            if scaling == Scaling::Linear { panels.len() } else { usize::from(*scatter == Scatter::Transmission) };
        panels.push(Panel { name, group, lines, mirrors: Vec::new() });
    }
    let entry = |(at, label): (usize, String)| Entry { ink: ink(at), label };
    let nm = spectra.first().map(|spectrum| spectrum.nm.clone()).unwrap_or_default();
    let bounds = nm.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), nm| (a.min(*nm), b.max(*nm)));
    let has_extent = bounds.1 > bounds.0;
    if !has_extent {
        return None;
    }
    let mut what = format!("At {} wavelengths, ψ\u{a0}=\u{a0}{}", nm.len(), degrees(view.psi));
    if subject.sides().len() > 1 {
        what = format!("{what}, light from the {}", side_name(view.side));
    }
    Some(Chart {
        id: id("spectra", view),
        shown: vec![shown],
        what,
        title: title(&[shown], "f against the wavelength at several viewing angles"),
        axis: Axis::Wavelength(bounds.0, bounds.1),
        scaling,
        panels,
        legend: ("viewing angle θ_{o} in the plane of incidence", {
            view.angle_names().into_iter().enumerate().map(entry).collect()
        }),
        ends: ["", ""],
        notes: Vec::new(),
    })
}

/// Whether lines of one panel are so different that some would lie on a linear axis.
fn is_wide(lines: &[Spectrum]) -> bool {
    let peaks = lines.iter().map(|line| line.f.iter().copied().fold(0.0, f32::max)).filter(|peak| *peak > 0.0);
    let (least, most) =
        peaks.fold((f32::INFINITY, 0.0), |(least, most): (f32, f32), peak| (least.min(peak), most.max(peak)));
    most > WIDE * least
}

fn line(spectrum: &Spectrum, ink: Ink) -> Line {
    let mut order: Vec<usize> = (0..spectrum.nm.len()).collect();
    order.sort_by(|&a, &b| spectrum.nm[a].total_cmp(&spectrum.nm[b]));
    let (x, f): (Vec<f64>, Vec<f32>) = order.iter().map(|&at| (spectrum.nm[at], spectrum.f[at])).unzip();
    let step = x.len().div_ceil(FEW);
    let kind = if spectrum.is_measured { "" } else { ", not measured" };
    let hint = |at: usize| Hint {
        at,
        is_point: step == 1 && spectrum.is_measured,
        text: format!(
            "σ = {}, θ = {}, {} nm: {} 1/sr{kind}",
            degrees(spectrum.sigma),
            degrees(spectrum.theta),
            short(x[at]),
            short(f64::from(f[at]))
        ),
    };
    let hints = (0..x.len()).step_by(step.max(1)).map(hint).collect();
    let is_measured = vec![spectrum.is_measured; x.len()];
    Line { ink, x, f, is_measured, hints }
}
