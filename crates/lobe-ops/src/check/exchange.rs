//! Reciprocity: whether light and viewer may be exchanged.

use lobe_table::Scatter;

use super::finding::{Finding, Status, Thoroughness, degrees, percent};
use crate::Subject;
use crate::reciprocity::reciprocity;

/// Few instruments measure anything beyond this, 80 degrees.
const LIMIT: f64 = 80.0 * std::f64::consts::PI / 180.0;
/// A relative difference (root mean square) that interpolation alone can cause.
const SAME: f64 = 0.02;
/// A difference beyond measurement error.
const APART: f64 = 0.15;

pub(super) fn check(subject: &Subject, thoroughness: &Thoroughness) -> Vec<Finding> {
    let aspects = subject.aspects();
    let mut findings = Vec::new();
    for (at, &aspect) in aspects.iter().enumerate() {
        let part = if aspects.len() > 1 { aspect.to_string() } else { String::new() };
        let way_back = aspects.iter().position(|&other| other == aspect.reversed());
        // A measurement and its reverse are compared once.
        if way_back.is_some_and(|back| back < at) {
            continue;
        }
        if way_back.is_none() && aspect.scatter == Scatter::Transmission {
            let text = "only one direction of transmission was measured: nothing to exchange it with".into();
            findings.push(Finding::new("reciprocity", &part, Status::Note, text));
            continue;
        }
        let index = subject.data(aspect).map_or(1.0, |data| data.representation().refractive_index());
        if aspect.scatter == Scatter::Transmission && index != 1.0 {
            let text = format!("light passes into a medium of index {index}: the two directions differ by its square");
            findings.push(Finding::new("reciprocity", &part, Status::Note, text));
            continue;
        }
        let limit = subject.measured_up_to(aspect).min(subject.measured_up_to(aspect.reversed())).min(LIMIT);
        if limit < 0.1 {
            let text = "fewer than two angles of incidence: nothing to exchange".into();
            findings.push(Finding::new("reciprocity", &part, Status::Note, text));
            continue;
        }
        let found = reciprocity(&subject.material, aspect, limit, thoroughness.pairs);
        let [wi, wo] = found.worst.map(|w| degrees(w[2].clamp(-1.0, 1.0).acos()));
        let text = format!(
            "up to {} degrees, f(wi, wo) and f(wo, wi) differ by {} (rms), by {} in the median, and at most by {:.3e}, \
             between {wi} and {wo} degrees",
            degrees(limit),
            percent(found.relative_rms),
            percent(found.relative_median),
            found.max
        );
        let status = match found.relative_rms {
            rms if rms <= SAME => Status::Pass,
            rms if rms <= APART => Status::Note,
            _ => Status::Warn,
        };
        let finding = Finding::new("reciprocity", &part, status, text);
        findings.push(
            finding
                .number("relative rms", found.relative_rms)
                .number("relative median", found.relative_median)
                .number("largest", found.max),
        );
    }
    findings
}
