//! Samples follow their density: histograms of samples against the integrated density, by Pearson's test.

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe::table::specular::coords;
use lobe::{Aspect, Given, Sampler, Scatter, Side};
use lobe_testing::emulation::draws;
use rayon::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::materials::{Named, samplers};
use super::{below, incidents, numbers};

/// Bins in theta and phi about the mirror direction; samples are drawn in other coordinates.
const THETAS: usize = 40;
const PHIS: usize = 24;

/// The fewest points per bin at which the density is summed: with a sixteenth of them, sums miss 1 by more than 0.001.
const FEWEST_POINTS: usize = 1024;
/// The most points per bin.
const MOST_POINTS: usize = 1 << 19;

/// Samples per incident direction, unless [another number](asked) is asked for; fewer on emulated processors.
const SAMPLES: usize = 100_000;

/// The value of `LOBE_SAMPLES`, with which all files are tested (or those whose names contain `LOBE_FILES`), which
/// takes half an hour for a million. Without the variable there are two files of each kind.
fn asked() -> Option<usize> {
    std::env::var("LOBE_SAMPLES").ok().map(|count| count.parse().expect("LOBE_SAMPLES is a number"))
}

fn sample_count() -> usize {
    asked().unwrap_or_else(|| draws(SAMPLES))
}

/// The subject of a test.
fn tested() -> Vec<&'static Named> {
    let mut kinds = HashMap::new();
    let mut is_asked = |named: &Named| {
        let seen = kinds.entry(named.sampler.material().kind()).or_insert(0);
        *seen += usize::from(named.is_shared);
        asked().is_some() || *seen <= 2
    };
    let part = std::env::var("LOBE_FILES").unwrap_or_default();
    samplers().iter().filter(|named| named.name.contains(&part) && is_asked(named)).collect()
}

/// The theta at a fraction of the range: bins are finer near the peak.
fn theta_at(part: f64) -> f64 {
    PI * part * part
}

/// An incident direction with its side up.
fn raised([x, y, z]: [f32; 3]) -> [f64; 3] {
    [x, y, z.abs()].map(f64::from)
}

/// A density for one incident direction, and the frame in which it is summed: toward phi = 0, toward phi = 90 degrees,
/// and the mirror direction.
struct Density<'a> {
    sampler: &'a Sampler,
    incident: [f32; 3],
    frame: [[f64; 3]; 3],
}

/// A region of scattered directions: the side of the surface, and the ranges of `1 - cos theta` and phi.
struct Bin {
    side: f64,
    rest: [f64; 2],
    phi: [f64; 2],
    /// The offset of its points.
    start: f64,
}

impl Density<'_> {
    /// The sum of the density over some of the points of a bin, each multiplied by its share of the solid angle.
    /// Because the density is not continuous, no two points have the same theta or phi.
    fn sum(&self, bin: &Bin, points: std::ops::Range<usize>) -> f64 {
        let [rest, phi] = [bin.rest, bin.phi].map(|[low, high]| (low, high - low));
        let [x, y, z] = self.frame;
        let place = |point: usize| {
            // The additive recurrence of the plastic number (Roberts 2018), with a different start in each bin.
            let at = bin.start + point as f64;
            let [u, w] = [0.754_877_666_246_693, 0.569_840_290_998_053].map(|step| (at * step).fract());
            // At the mirror direction, the density of an EPFL material may grow without bound, as theta^(-3/2): points
            // are denser there.
            let (u, share) = if rest.0 == 0.0 { (u.powi(4), 4.0 * u.powi(3)) } else { (u, 1.0) };
            let versine = rest.0 + u * rest.1;
            let (sin_theta, cos_theta) = ((versine * (2.0 - versine)).max(0.0).sqrt(), 1.0 - versine);
            let (sin_phi, cos_phi) = (phi.0 + w * phi.1).sin_cos();
            let [a, b] = [sin_theta * cos_phi, sin_theta * sin_phi];
            let wo: [f64; 3] = std::array::from_fn(|k| a * x[k] + b * y[k] + cos_theta * z[k]);
            let above = if wo[2] > 0.0 { bin.side } else { f64::NAN };
            ([wo[0], wo[1], wo[2] * above].map(|x| x as f32), share * rest.1 * phi.1)
        };
        let (scattered, shares): (Vec<[f32; 3]>, Vec<f64>) = points.map(place).unzip();
        let mut pdfs = vec![0.0; scattered.len()];
        self.sampler.pdf_batch(Given::Light, &vec![self.incident; scattered.len()], &scattered, &mut pdfs);
        pdfs.into_iter().zip(shares).map(|(pdf, share)| f64::from(pdf) * share).sum()
    }

    /// The integral of the density over a bin, with so many points that the sums of the two halves differ by at most a
    /// tenth of the noise of the samples.
    fn integral(&self, bin: &Bin, samples: f64) -> f64 {
        let mut points = FEWEST_POINTS / 2;
        let mut first = self.sum(bin, 0..points);
        loop {
            let second = self.sum(bin, points..2 * points);
            let scale = 1.0 / (2 * points) as f64;
            let (integral, doubt) = ((first + second) * scale, (first - second).abs() * scale);
            if doubt <= 0.1 * (integral / samples).sqrt() || 2 * points >= MOST_POINTS {
                return integral;
            }
            (first, points) = (first + second, 2 * points);
        }
    }
}

/// The integral of the density over each bin, reflection before transmission.
fn expected(sampler: &Sampler, incident: [f32; 3]) -> Vec<f64> {
    let [sigma, psi, ..] = coords::directions_to_angles(raised(incident), [0.0, 0.0, 1.0], |s| s);
    let axis = |theta: f64, phi: f64| coords::angles_to_directions([sigma, psi, theta, phi], |s| s).1;
    let frame = [axis(FRAC_PI_2, 0.0), axis(FRAC_PI_2, FRAC_PI_2), axis(0.0, 0.0)];
    let density = Density { sampler, incident, frame };
    let front = incident[2] > 0.0;
    let mut bins = Vec::new();
    for scatter in [Scatter::Reflection, Scatter::Transmission] {
        if !sampler.material().holds(Aspect { scatter, light: Side::of(incident) }) {
            bins.extend([0.0; THETAS * PHIS]);
            continue;
        }
        let side = if front == (scatter == Scatter::Reflection) { 1.0 } else { -1.0 };
        for i in 0..THETAS {
            let rest = [i, i + 1].map(|i| 2.0 * (0.5 * theta_at(i as f64 / THETAS as f64)).sin().powi(2));
            for j in 0..PHIS {
                let phi = [j, j + 1].map(|j| j as f64 / PHIS as f64 * TAU);
                let start = (i * PHIS + j) as f64 * 0.618_033_988_749_895;
                bins.push(density.integral(&Bin { side, rest, phi, start }, asked().unwrap_or(SAMPLES) as f64));
            }
        }
    }
    bins
}

/// The number of samples in each bin, and the number of failed draws.
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

/// The probability of a worse fit, with bins of fewer than 10 samples merged.
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
    let tested = tested();
    let mut cases = Vec::new();
    for Named { name, sampler, .. } in &tested {
        let reaches = |light| {
            let aspects = Aspect::ALL.into_iter().filter(|aspect| aspect.light == light);
            aspects.into_iter().any(|aspect| sampler.material().holds(aspect))
        };
        let above = if reaches(Side::Front) { incidents() } else { Vec::new() };
        let below = if reaches(Side::Back) && above.is_empty() { below(&incidents()) } else { Vec::new() };
        cases.extend(above.into_iter().chain(below).map(|incident| (name, sampler, incident)));
    }
    // Šidák: if all hypotheses are true, all tests together pass with probability 0.99.
    let significance = 1.0 - 0.99f64.powf(1.0 / cases.len() as f64);
    assert!(!cases.is_empty(), "nothing to test");
    println!("{} materials, {} tests, p at least {significance:.1e}", tested.len(), cases.len());
    let failures: Vec<String> = cases
        .par_iter()
        .enumerate()
        .flat_map_iter(|(seed, &(name, sampler, incident))| {
            let expected = expected(sampler, incident);
            let (observed, nowhere) = observed(sampler, incident, seed as u64);
            let (total, p) = (expected.iter().sum::<f64>(), p_value(&expected, &observed));
            // The probability of failed draws is missing from the density too.
            let count = sample_count() as f64;
            let deficit = nowhere as f64 / count;
            let noise = 4.0 * (deficit * (1.0 - deficit) / count).sqrt();
            if asked().is_some() {
                println!("{name} {incident:?}: p = {p:.1e}, density {total:.5}, nowhere {deficit:.5}");
            }
            let mut failures = Vec::new();
            if p < significance {
                failures.push(format!("{name} {incident:?}: p = {p:.1e}"));
            }
            if (total + deficit - 1.0).abs() > 1e-3 + noise {
                failures.push(format!("{name} {incident:?}: density {total}, nowhere {deficit}"));
            }
            failures
        })
        .collect();
    assert!(failures.is_empty(), "{} of {}: {failures:#?}", failures.len(), cases.len());
}
