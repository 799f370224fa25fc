//! Energy: the albedo of every slice, the total integrated scatter that a file states, and their implications for the
//! unit.

use std::f64::consts::PI;

use lobe_table::{Data, Representation};
use rayon::prelude::*;

use super::coverage::{is_in_plane, sparse};
use super::finding::{Finding, Status, Thoroughness, degrees, percent};
use crate::albedo::{Albedo, albedo_of};
use crate::directions::spherical;
use crate::hemisphere::Effort;
use crate::pairs::eval_pairs;
use crate::{Aspect, Subject};

/// The number of albedos between two reports of progress.
const AT_ONCE: usize = 16;
/// Light beyond 85 degrees is extrapolated in most measurements, and not checked.
const GRAZING: f64 = 85.5 * PI / 180.0;
/// The excess above 1 at which an albedo fails: instruments are calibrated to about a per cent.
const CALIBRATION: f64 = 0.01;
/// The blackest coatings reflect about half as much.
const BLACK: f64 = 1e-3;
/// A stated total that deviates by more than this share is not the integral of the values.
const TIS_APART: f64 = 0.05;
/// The relative deviation from pi up to which a ratio counts as pi.
const NEAR: f64 = 0.15;

pub(super) fn check(subject: &Subject, thoroughness: &Thoroughness, progress: impl Fn(f64)) -> Vec<Finding> {
    let effort = Effort { tolerance: thoroughness.tolerance, evaluations: thoroughness.evaluations };
    let aspects = subject.aspects();
    let mut findings = Vec::new();
    let mut all: Vec<(Aspect, Vec<Albedo>)> = Vec::new();
    for (index, &aspect) in aspects.iter().enumerate() {
        let part = if aspects.len() > 1 { aspect.to_string() } else { String::new() };
        let data = subject.data(aspect).map(Data::representation);
        if let Some(data) = data.filter(|data| is_in_plane(*data)) {
            findings.extend(in_plane(data, &part));
            continue;
        }
        let mut incidences = subject.incidences(aspect);
        incidences.retain(|[theta, _]| *theta <= GRAZING);
        let sparse = subject.data(aspect).map(|data| sparse(data.representation())).unwrap_or_default();
        let all_incidences = incidences.len();
        incidences.retain(|incidence| !sparse.contains(incidence));
        if incidences.len() < all_incidences {
            let text = format!(
                "too few outgoing directions for an albedo, for {} of {all_incidences} incident directions",
                all_incidences - incidences.len()
            );
            findings.push(Finding::new("energy", &part, Status::Note, text));
        }
        let step = incidences.len().div_ceil(thoroughness.incidences.max(1)).max(1);
        let chosen: Vec<[f64; 2]> = incidences.into_iter().step_by(step).collect();
        let mut albedos: Vec<Albedo> = Vec::new();
        for some in chosen.chunks(AT_ONCE) {
            let of_some = some.par_iter().map(|&incidence| albedo_of(subject, aspect, incidence, effort));
            albedos.extend(of_some.collect::<Vec<_>>());
            progress((index as f64 + albedos.len() as f64 / chosen.len() as f64) / aspects.len() as f64);
        }
        all.push((aspect, albedos));
    }
    let names = subject.material.channels().names();
    for (aspect, albedos) in all.iter().filter(|(_, albedos)| !albedos.is_empty()) {
        let part = if aspects.len() > 1 { aspect.to_string() } else { String::new() };
        findings.push(energy(&part, aspect, albedos, &names));
        findings.extend(unit(&part, albedos));
        findings.extend(cosine(subject, *aspect, &part));
    }
    findings.extend(sides(&all));
    findings.extend(tis(subject, effort));
    if !subject.document.parts.iter().all(|part| part.data.representation().has_known_unit()) {
        let text = "the unit of this database is not documented; albedos are those of the stored numbers";
        findings.push(Finding::new("unit", "", Status::Warn, text.into()));
    }
    findings
}

/// A bound without an integral: no albedo is above pi times the largest value.
fn in_plane(data: &dyn Representation, part: &str) -> Vec<Finding> {
    let text = "measured only in the plane of incidence, so there is no albedo".into();
    let mut findings = vec![Finding::new("energy", part, Status::Note, text)];
    let values = data.samples().into_iter().flatten().flat_map(|(_, texel)| texel);
    let largest = values.fold(0.0, |most: f64, &value| most.max(f64::from(value)));
    if largest * PI < BLACK {
        let text = format!(
            "values are at most {largest:.1e}, so no albedo is above {:.1e}, less than that of the blackest coatings: \
             they are not in 1/sr",
            PI * largest
        );
        findings.push(Finding::new("unit", part, Status::Warn, text).number("largest", largest));
    }
    findings
}

fn energy(part: &str, aspect: &Aspect, albedos: &[Albedo], names: &[String]) -> Finding {
    let (mut high, mut low) = (&albedos[0], &albedos[0]);
    for albedo in albedos {
        if albedo.largest() > high.largest() {
            high = albedo;
        }
        if albedo.smallest() < low.smallest() {
            low = albedo;
        }
    }
    let error = albedos.iter().map(|albedo| albedo.error).fold(0.0, f64::max);
    let what = match aspect.scatter {
        lobe_table::Scatter::Reflection => "albedo",
        lobe_table::Scatter::Transmission => "transmittance",
    };
    let channel = high.values.iter().position(|&value| value == high.largest()).unwrap_or(0);
    let name = names.get(channel).filter(|_| names.len() > 1).map(|name| format!(" in {name}")).unwrap_or_default();
    let mut text = format!(
        "{what} {:.4} to {:.4} over {}, largest for light at {} degrees{name}",
        low.smallest(),
        high.largest(),
        match albedos.len() {
            1 => "one incident direction".into(),
            n => format!("{n} incident directions"),
        },
        degrees(high.theta)
    );
    if error > 0.01 * high.largest().abs() {
        text.push_str(&format!(", within {error:.1e}"));
    }
    let above = albedos.iter().filter(|albedo| albedo.largest() > 1.0 + CALIBRATION + albedo.error).count();
    let below = albedos.iter().filter(|albedo| albedo.smallest() < -CALIBRATION * 0.1 - albedo.error).count();
    let status = match (above, below) {
        (0, 0) => Status::Pass,
        (above, below) => {
            let more = if above > 0 { format!("; {above} of {} above 1", albedos.len()) } else { String::new() };
            let less = if below > 0 { format!("; {below} of {} below 0", albedos.len()) } else { String::new() };
            text = format!("{text}{more}{less}");
            Status::Fail
        }
    };
    let finding = Finding::new("energy", part, status, text);
    finding.number("smallest", low.smallest()).number("largest", high.largest()).number("error", error)
}

/// `true` if the albedos are plausible for values in 1/sr.
fn unit(part: &str, albedos: &[Albedo]) -> Option<Finding> {
    let mut means: Vec<f64> =
        albedos.iter().map(|albedo| albedo.values.iter().sum::<f64>() / albedo.values.len() as f64).collect();
    means.sort_by(f64::total_cmp);
    let (median, largest) = (means[means.len() / 2], means[means.len() - 1]);
    let text = if median > 1.0 + CALIBRATION && median / PI <= 1.0 + CALIBRATION {
        format!(
            "half of the incident directions have an albedo of {median:.3} or more; divided by pi it is {:.3}: the values \
             may be luminance factors, pi f",
            median / PI
        )
    } else if median > 1.0 + CALIBRATION {
        format!("half of the incident directions have an albedo of {median:.3} or more: the values are not in 1/sr")
    } else if largest < BLACK && largest > 0.0 {
        format!(
            "the largest albedo is {largest:.1e}, less than that of the blackest coatings: the values are not in 1/sr"
        )
    } else {
        return None;
    };
    Some(Finding::new("unit", part, Status::Warn, text).number("albedo", median))
}

/// `true` if values fall off toward the horizon like a cosine, as values of `f cos` would and values of `f` seldom do.
fn cosine(subject: &Subject, aspect: Aspect, part: &str) -> Option<Finding> {
    let incidences = subject.incidences(aspect);
    let [theta, phi] = *incidences.iter().min_by(|a, b| (a[0] - 0.5).abs().total_cmp(&(b[0] - 0.5).abs()))?;
    // Across the plane of incidence, away from the peak.
    let viewers: Vec<f64> = (0..7).map(|step| (50.0 + 4.0 * f64::from(step)).to_radians()).collect();
    let across = phi + PI / 2.0;
    let pairs: Vec<_> =
        viewers.iter().map(|&viewer| aspect.place(spherical(theta, phi), spherical(viewer, across))).collect();
    let count = subject.material.channels().count();
    let values = eval_pairs(&subject.material, &pairs);
    let sums: Vec<f64> = values.chunks_exact(count).map(|texel| texel.iter().map(|&v| f64::from(v)).sum()).collect();
    if sums.iter().any(|&sum| sum <= 0.0) {
        return None;
    }
    let quotient = |(sum, viewer): (&f64, &f64)| (sum / sums[0]) / (viewer.cos() / viewers[0].cos());
    let off = sums.iter().zip(&viewers).map(quotient).map(|quotient| (quotient - 1.0).abs()).fold(0.0, f64::max);
    (off < 0.05).then(|| {
        let text =
            "values fall off toward the horizon like a cosine: they may be f cos (cosine-corrected), not f".into();
        Finding::new("unit", part, Status::Note, text).number("off", off)
    })
}

/// Reflected and transmitted light together cannot exceed the incident light.
fn sides(all: &[(Aspect, Vec<Albedo>)]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (index, (one, albedos)) in all.iter().enumerate() {
        for (other, more) in &all[index + 1..] {
            let is_same_light = one.light == other.light && one.scatter != other.scatter;
            let is_same_grid = albedos.len() == more.len()
                && albedos
                    .iter()
                    .zip(more)
                    .all(|(a, b)| (a.theta - b.theta).abs() < 1e-3 && (a.phi - b.phi).abs() < 1e-3);
            if !is_same_light || !is_same_grid {
                continue;
            }
            let sum = |(a, b): (&Albedo, &Albedo)| {
                let largest = a.values.iter().zip(&b.values).map(|(a, b)| a + b).fold(f64::MIN, f64::max);
                (largest, a.theta, a.error + b.error)
            };
            let worst = albedos.iter().zip(more).map(sum).max_by(|a, b| a.0.total_cmp(&b.0));
            let Some((largest, theta, error)) = worst else { continue };
            let status = if largest > 1.0 + CALIBRATION + error { Status::Fail } else { Status::Pass };
            let text =
                format!("{one} and {other} together are at most {largest:.4}, for light at {} degrees", degrees(theta));
            findings.push(Finding::new("energy", "", status, text).number("largest", largest));
        }
    }
    findings
}

/// The total integrated scatter that a Zemax file states, `[channel][psi][sigma]`, against the integral of its values.
fn tis(subject: &Subject, effort: Effort) -> Option<Finding> {
    let stated = &subject.document.tis;
    let knots = subject.document.only()?.representation().grid().filter(|grid| grid.is_specular)?.knots;
    let (sigmas, psis) = (knots[0].len(), knots[1].len());
    if stated.is_empty() || !stated.len().is_multiple_of(sigmas * psis) {
        return None;
    }
    let aspect = *subject.aspects().first()?;
    let mut ratios = Vec::new();
    let (mut worst, mut at) = (0.0_f64, (0.0, 0.0, 0.0));
    for (s, &sigma) in knots[0].iter().enumerate().filter(|(_, sigma)| **sigma <= GRAZING) {
        for (p, &psi) in knots[1].iter().enumerate() {
            let albedo = albedo_of(subject, aspect, [sigma, psi], effort);
            for (channel, &integral) in albedo.values.iter().enumerate() {
                let tis = f64::from(*stated.get((channel * psis + p) * sigmas + s)?);
                if tis > 0.0 {
                    ratios.push(integral / tis);
                    if (integral / tis - 1.0).abs() > worst {
                        (worst, at) = ((integral / tis - 1.0).abs(), (tis, integral, sigma));
                    }
                }
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    let median = *ratios.get(ratios.len() / 2)?;
    let (tis, integral, sigma) = at;
    let near = |ratio: f64| (median / ratio - 1.0).abs() < NEAR;
    let text = format!(
        "{} stated totals; the integral of the values is {median:.3} times them in the median; the worst is {tis:.4} \
         stated, {integral:.4} integrated, for light at {} degrees",
        ratios.len(),
        degrees(sigma)
    );
    let (status, hint) = match worst {
        worst if worst <= TIS_APART => (Status::Pass, ""),
        _ if near(PI) => (Status::Warn, ": a factor of pi"),
        _ if near(1.0 / PI) => (Status::Warn, ": a factor of 1/pi"),
        _ => (Status::Warn, ""),
    };
    let finding = Finding::new("TIS", "", status, format!("{text}{hint} ({} off)", percent(worst)));
    Some(finding.number("median ratio", median).number("worst", worst))
}
