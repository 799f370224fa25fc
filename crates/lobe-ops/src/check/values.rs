//! The numbers themselves: negative ones, gaps, and numbers that occur too often.

use std::collections::BTreeMap;

use lobe_formats::Document;
use lobe_formats::sheet::Data;
use lobe_table::window::{Block, Component};

use super::{Finding, Status, part_name, percent};
use crate::subject::aspect_of;

/// A number that is this share of all, and is not 0, did not come from a measurement alone.
const OFTEN: f64 = 0.02;
/// Below this many numbers, nothing is said about how often one occurs.
const FEW: usize = 100;

pub(super) fn check(document: &Document) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (part, values) in numbers(document) {
        findings.extend(negative(&part, &values));
        findings.extend(repeated(&part, &values));
    }
    if let Some(gaps) = gaps(document) {
        findings.push(gaps);
    }
    findings
}

/// The numbers that stand for light, with their meaning for people; without those that mean a gap.
fn numbers(document: &Document) -> Vec<(String, Vec<f32>)> {
    let data = |data: &Data| match data {
        Data::Table(data) => data.values().to_vec(),
        Data::Spherical(data) => data.values().to_vec(),
        Data::Scattered(data) => data.samples().flat_map(|(_, texel)| texel.to_vec()).collect(),
        Data::Specular(data) => data.values().to_vec(),
    };
    let whole = |values: Vec<f32>| vec![(String::new(), values)];
    match document {
        Document::Table(measured) => whole(measured.data.values().to_vec()),
        Document::Specular(measured) => whole(measured.data.values().to_vec()),
        Document::Spherical(measured) => whole(measured.data.values().to_vec()),
        Document::Scattered(measured) => whole(measured.data.samples().flat_map(|(_, texel)| texel.to_vec()).collect()),
        Document::Sheet(measured) => measured.data.iter().map(|part| (part_name(part), data(&part.data))).collect(),
        Document::Rgl(measured) => whole(measured.data.parts().spectra.texels().to_vec()),
        // A negative number in any channel is a gap, not a value.
        Document::HalfDiff(measured) => {
            let [h, d, p] = measured.data.bins();
            let bins = (0..h * d * p).map(|i| [i / (d * p), i / p % d, i % p]);
            whole(bins.filter(|&bin| measured.data.is_measured(bin)).flat_map(|bin| measured.data.texel(bin)).collect())
        }
        Document::Utia(measured) => whole(measured.data.values().iter().map(|&value| value as f32).collect()),
        // The first element is the light; the others have a sign.
        Document::Mueller(measured) => {
            whole(measured.data.values().iter().copied().step_by(16).filter(|value| !value.is_nan()).collect())
        }
        Document::Window(measured) => {
            let mut parts = Vec::new();
            for band in &measured.data.bands {
                for block in Block::ALL {
                    let values = match band.window.block(block) {
                        Some(Component::Klems(matrix)) => matrix.values(),
                        Some(Component::Tree(tree)) => tree.values(),
                        None => continue,
                    };
                    parts.push((format!("{} {}", band.wavelength, aspect_of(block)), values.to_vec()));
                }
            }
            parts
        }
        _ => Vec::new(),
    }
}

fn negative(part: &str, values: &[f32]) -> Option<Finding> {
    let negative = values.iter().filter(|value| **value < 0.0).count();
    let share = negative as f64 / values.len().max(1) as f64;
    let (least, most) = values.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
    let (status, text) = match share {
        _ if values.is_empty() => return None,
        0.0 => (Status::Pass, format!("none of {} values, {least:.3e} to {most:.3e}", values.len())),
        share if share > 0.5 => (Status::Fail, format!("{negative} of {} values, more than half", values.len())),
        share => {
            let of_peak = f64::from(-least / most);
            let text = format!(
                "{negative} of {} values ({}), down to {least:.3e}, which is {} of the largest",
                values.len(),
                percent(share),
                percent(of_peak)
            );
            (Status::Warn, text)
        }
    };
    let finding = Finding::new("negative values", part, status, text);
    Some(
        finding
            .number("negative", negative as f64)
            .number("smallest", f64::from(least))
            .number("largest", f64::from(most)),
    )
}

/// A number that many samples share is a floor, a ceiling, or a stand-in for what was not measured.
fn repeated(part: &str, values: &[f32]) -> Option<Finding> {
    if values.len() < FEW {
        return None;
    }
    let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
    // Both zeros are one number.
    values.iter().for_each(|value| *counts.entry((value + 0.0).to_bits()).or_default() += 1);
    if counts.len() == 1 {
        let text = format!("all {} values are {}", values.len(), values[0]);
        return Some(Finding::new("repeated values", part, Status::Note, text));
    }
    let (&bits, &count) = counts.iter().max_by_key(|(_, count)| **count)?;
    let value = f32::from_bits(bits);
    let share = count as f64 / values.len() as f64;
    if share < OFTEN {
        return None;
    }
    let (least, most) = values.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
    let reading = match value {
        0.0 => "below the horizon, below the noise, or not measured; the interpolation takes them for dark",
        value if value == least => "a floor, below which nothing was kept",
        value if value == most => "a ceiling, above which the instrument was blind",
        _ => "more often than a measurement would have it",
    };
    let text = format!("{count} of {} values ({}) are {value}: {reading}", values.len(), percent(share));
    let finding = Finding::new("repeated values", part, Status::Note, text);
    Some(finding.number("value", f64::from(value)).number("share", share))
}

/// What the file itself says was not measured.
fn gaps(document: &Document) -> Option<Finding> {
    let (gaps, all, what) = match document {
        Document::HalfDiff(measured) => {
            let [h, d, p] = measured.data.bins();
            let bins = (0..h * d * p).map(|i| [i / (d * p), i / p % d, i % p]);
            (bins.filter(|&bin| !measured.data.is_measured(bin)).count(), h * d * p, "bins")
        }
        Document::Mueller(measured) => {
            let first = measured.data.values().iter().step_by(16);
            (first.clone().filter(|value| value.is_nan()).count(), first.count(), "matrices")
        }
        Document::Rgl(measured) => {
            let valid = measured.data.parts().valid.as_ref()?;
            let set: usize = valid.iter().map(|byte| byte.count_ones() as usize).sum();
            let text =
                format!("the mask in the file marks {set} of {} texels as valid; no program uses it", 8 * valid.len());
            let finding = Finding::new("gaps", "", Status::Note, text);
            return Some(finding.number("valid", set as f64).number("of", 8.0 * valid.len() as f64));
        }
        _ => return None,
    };
    let share = gaps as f64 / all.max(1) as f64;
    let text =
        format!("{gaps} of {all} {what} ({}) were not measured, those below the horizon among them", percent(share));
    let status = if gaps == 0 { Status::Pass } else { Status::Note };
    Some(Finding::new("gaps", "", status, text).number("gaps", gaps as f64).number("of", all as f64))
}
