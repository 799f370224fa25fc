//! The numbers themselves: negative ones, gaps, and numbers that occur too often.

use std::collections::BTreeMap;

use lobe_formats::{Document, Part};
use lobe_table::data::Gaps;

use super::finding::{Finding, Status, part_name, percent};

/// A non-zero number that is this share of all did not come from a measurement alone.
const OFTEN: f64 = 0.02;
/// With fewer numbers than this, repeated ones are not reported.
const FEW: usize = 100;

pub(super) fn check(document: &Document) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (part, values) in numbers(document) {
        findings.extend(negative(&part, &values));
        findings.extend(repeated(&part, &values));
    }
    findings.extend(document.parts.iter().filter_map(|part| gaps(document, part)));
    findings.extend(document.doubts.iter().map(|doubt| Finding::new("reading", "", Status::Warn, doubt.clone())));
    findings
}

/// The numbers that represent light, with the names of the parts, without those that mark a gap.
fn numbers(document: &Document) -> Vec<(String, Vec<f32>)> {
    let mut numbers = Vec::new();
    for part in &document.parts {
        let data = part.data.representation();
        for section in data.sections() {
            let name = match data.is_two_sided() {
                true => format!("{} {}", section.channels.names().join(" "), section.aspect),
                false => part_name(document, part),
            };
            numbers.push((name, section.measured().to_vec()));
        }
    }
    numbers
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

/// A number that many samples share is a floor, a ceiling, or a placeholder for unmeasured values.
fn repeated(part: &str, values: &[f32]) -> Option<Finding> {
    if values.len() < FEW {
        return None;
    }
    let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
    // Zeros of both signs are one number.
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
        0.0 => "below the horizon, below the noise, or not measured; the interpolation treats them as dark",
        value if value == least => "a floor, below which nothing was kept",
        value if value == most => "a ceiling, above which the instrument saturated",
        _ => "more often than is plausible for a measurement",
    };
    let text = format!("{count} of {} values ({}) are {value}: {reading}", values.len(), percent(share));
    let finding = Finding::new("repeated values", part, Status::Note, text);
    Some(finding.number("value", f64::from(value)).number("share", share))
}

/// Values that the file itself marks as not measured.
fn gaps(document: &Document, part: &Part) -> Option<Finding> {
    let Gaps { missing, all, of, is_used } = part.data.representation().gaps()?;
    let name = part_name(document, part);
    if !is_used {
        let set = all - missing;
        let text = format!("the mask in the file marks {set} of {all} {of} as valid; no program uses it");
        let finding = Finding::new("gaps", &name, Status::Note, text);
        return Some(finding.number("valid", set as f64).number("of", all as f64));
    }
    let share = missing as f64 / all.max(1) as f64;
    let text =
        format!("{missing} of {all} {of} ({}) were not measured, including those below the horizon", percent(share));
    let status = if missing == 0 { Status::Pass } else { Status::Note };
    Some(Finding::new("gaps", &name, status, text).number("gaps", missing as f64).number("of", all as f64))
}
