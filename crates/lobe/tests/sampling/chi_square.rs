//! Samples follow their density: histograms of samples against the integrated density, by Pearson's test.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use lobe::table::coords;
use lobe::{Given, Material, Sampler, Scatter};
use rayon::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::materials::{made, sampler, shared};
use crate::{below, incidents, numbers};

/// Bins in theta and phi about the mirror direction, which are not the coordinates sampled in.
const THETAS: usize = 40;
const PHIS: usize = 24;

/// Points a bin over which the density is summed: as the density is not continuous, no two at the same theta or phi.
const POINTS: usize = 1600;

/// Samples an incident direction: what the variable `LOBE_SAMPLES` says, which tests all files there are and takes half
/// an hour for a million; without it fewer, and two files of each kind.
fn asked() -> Option<usize> {
    std::env::var("LOBE_SAMPLES").ok().map(|count| count.parse().expect("LOBE_SAMPLES is a number"))
}

fn sample_count() -> usize {
    asked().unwrap_or(100_000)
}

/// What is tested.
fn materials() -> Vec<(String, Material)> {
    let mut kinds = HashMap::new();
    let is_asked = |(_, material): &(String, Material)| {
        let seen = kinds.entry(material.kind()).or_insert(0);
        *seen += 1;
        asked().is_some() || *seen <= 2
    };
    made().into_iter().chain(shared().into_iter().filter(is_asked)).collect()
}

/// The theta at a part of the way: bins are finer near the peak.
fn theta_at(part: f64) -> f64 {
    PI * part * part
}

/// An incident direction with its side up.
fn raised([x, y, z]: [f32; 3]) -> [f64; 3] {
    [x, y, z.abs()].map(f64::from)
}

/// The integral of the density over each bin, those of reflection before those of transmission; and how far from the
/// truth their sum may be, by the difference of two halves.
fn expected(sampler: &Sampler, incident: [f32; 3]) -> (Vec<f64>, f64) {
    let [sigma, psi, ..] = coords::directions_to_angles(raised(incident), [0.0, 0.0, 1.0], |s| s);
    let front = incident[2] > 0.0;
    let incidents = vec![incident; POINTS];
    let mut pdfs = vec![0.0f32; POINTS];
    let (mut bins, mut doubt) = (Vec::new(), 0.0);
    for scatter in [Scatter::Reflection, Scatter::Transmission] {
        if !sampler.material().holds(front, scatter) {
            bins.extend([0.0; THETAS * PHIS]);
            continue;
        }
        let side = if front == (scatter == Scatter::Reflection) { 1.0 } else { -1.0 };
        for i in 0..THETAS {
            let [low, high] = [i, i + 1].map(|i| theta_at(i as f64 / THETAS as f64).cos());
            for j in 0..PHIS {
                let shift = (i * PHIS + j) as f64;
                let scattered: Vec<[f32; 3]> = (0..POINTS)
                    .map(|point| {
                        // The additive recurrence of the plastic number (Roberts 2018), begun elsewhere in each bin.
                        let at = shift * 0.618_033_988_749_895 + point as f64;
                        let [u, w] = [0.754_877_666_246_693, 0.569_840_290_998_053].map(|step| (at * step).fract());
                        let phi = (j as f64 + w) / PHIS as f64 * TAU;
                        let theta = (low + u * (high - low)).acos();
                        let wo = coords::angles_to_directions([sigma, psi, theta, phi], |s| s).1;
                        let above = if wo[2] > 0.0 { side } else { f64::NAN };
                        [wo[0], wo[1], wo[2] * above].map(|x| x as f32)
                    })
                    .collect();
                sampler.pdf_batch(Given::Light, &incidents, &scattered, &mut pdfs);
                let [a, b] = [0, POINTS / 2].map(|from| {
                    let half = &pdfs[from..from + POINTS / 2];
                    half.iter().map(|&pdf| f64::from(pdf)).sum::<f64>() / POINTS as f64
                });
                let solid_angle = (low - high) * TAU / PHIS as f64;
                bins.push((a + b) * solid_angle);
                doubt += (a - b).abs() * solid_angle;
            }
        }
    }
    (bins, doubt)
}

/// How many samples fall into each bin, and how many lead nowhere.
fn observed(sampler: &Sampler, incident: [f32; 3], seed: u64) -> (Vec<f64>, usize) {
    const CHUNK: usize = 20_000;
    let (mut bins, mut nowhere) = (vec![0.0; 2 * THETAS * PHIS], 0);
    let known = vec![incident; CHUNK];
    let (mut directions, mut pdfs) = (vec![[0.0; 3]; CHUNK], vec![0.0; CHUNK]);
    for u in numbers(seed, sample_count()).chunks(CHUNK) {
        let n = u.len();
        sampler.draw_batch(&known[..n], u, &mut directions[..n], &mut pdfs[..n]);
        for (wo, &pdf) in directions[..n].iter().zip(&pdfs) {
            if pdf == 0.0 {
                nowhere += 1;
                continue;
            }
            let [.., theta, phi] = coords::directions_to_angles(raised(incident), raised(*wo), |s| s);
            let way = usize::from((wo[2] > 0.0) != (incident[2] > 0.0));
            let i = ((theta / PI).sqrt() * THETAS as f64) as usize;
            let j = (phi / TAU * PHIS as f64) as usize;
            bins[(way * THETAS + i.min(THETAS - 1)) * PHIS + j.min(PHIS - 1)] += 1.0;
        }
    }
    (bins, nowhere)
}

/// The probability of a worse fit, bins of less than 10 samples lumped together.
fn p_value(expected: &[f64], observed: &[f64]) -> f64 {
    let (total, count) = (expected.iter().sum::<f64>(), observed.iter().sum::<f64>());
    let (mut statistic, mut freedom) = (0.0, -1.0);
    let mut lump = (0.0, 0.0);
    let mut add = |(e, o): (f64, f64)| {
        statistic += (o - e) * (o - e) / e;
        freedom += 1.0;
    };
    for (e, o) in expected.iter().zip(observed) {
        let e = e / total * count;
        if e < 10.0 {
            lump = (lump.0 + e, lump.1 + o);
        } else {
            add((e, *o));
        }
    }
    if lump.0 >= 5.0 {
        add(lump);
    }
    1.0 - ChiSquared::new(freedom).unwrap().cdf(statistic)
}

#[test]
fn samples_follow_the_density() {
    let samplers: Vec<_> = materials().into_iter().map(|(name, m)| (name, sampler(m))).collect();
    let mut cases = Vec::new();
    for (name, sampler) in &samplers {
        let reaches = |front| {
            let material = sampler.material();
            [Scatter::Reflection, Scatter::Transmission].iter().any(|&scatter| material.holds(front, scatter))
        };
        let above = if reaches(true) { incidents() } else { Vec::new() };
        let below = if reaches(false) && above.is_empty() { below(&incidents()) } else { Vec::new() };
        cases.extend(above.into_iter().chain(below).map(|incident| (name, sampler, incident)));
    }
    // Sidak: all tests together pass with probability 0.99 where all hypotheses hold.
    let significance = 1.0 - 0.99f64.powf(1.0 / cases.len() as f64);
    println!("{} materials, {} tests, p at least {significance:.1e}", samplers.len(), cases.len());
    let failures: Vec<String> = cases
        .par_iter()
        .enumerate()
        .flat_map_iter(|(seed, &(name, sampler, incident))| {
            let (expected, doubt) = expected(sampler, incident);
            let (observed, nowhere) = observed(sampler, incident, seed as u64);
            let (total, p) = (expected.iter().sum::<f64>(), p_value(&expected, &observed));
            // What leads nowhere is missing from the density too.
            let count = sample_count() as f64;
            let deficit = nowhere as f64 / count;
            let noise = 4.0 * (deficit * (1.0 - deficit) / count).sqrt();
            let mut failures = Vec::new();
            if p < significance {
                failures.push(format!("{name} {incident:?}: p = {p:.1e}"));
            }
            if (total + deficit - 1.0).abs() > 1e-3 + noise + doubt {
                failures.push(format!("{name} {incident:?}: density {total}, nowhere {deficit}"));
            }
            failures
        })
        .collect();
    assert!(failures.is_empty(), "{} of {}: {failures:#?}", failures.len(), cases.len());
}
