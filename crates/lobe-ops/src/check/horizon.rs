//! Values next to the horizon that stand out from all others: quotients by a cosine that is nearly 0.

use lobe_formats::Document;
use lobe_table::{Data, half_diff, rgl, scattered, spherical};

use super::finding::{Finding, Status, part_name};
use crate::directions::spherical as direction;
use crate::samples::{directions, nodes};

/// The height up to which a direction is next to the horizon: 1.1 degrees.
const NEAR: f64 = 0.02;
/// The height above which it is not: 3.4 degrees.
const AWAY: f64 = 0.06;
/// Within this angle of the normal, 30 degrees, half vectors are those of a mirror: peaks there rise toward the
/// horizon.
const PEAK: f64 = std::f64::consts::PI / 6.0;
/// A value that is this many times the largest of all others stands out.
const OUT: f64 = 10.0;

pub(super) fn check(document: &Document) -> Vec<Finding> {
    let of_part = |part| of_data(document, part);
    document.parts.iter().filter_map(of_part).collect()
}

fn of_data(document: &Document, part: &lobe_formats::Part) -> Option<Finding> {
    let mut extremes = Extremes::default();
    match &part.data {
        Data::HalfDiff(data) => of_bins(data, &mut extremes),
        Data::Specular(samples) => {
            for (node, texel) in nodes(samples).zip(samples.values().chunks_exact(samples.channels().count())) {
                extremes.add(directions(samples, node), texel);
            }
        }
        Data::Spherical(grid) => of_grid(grid, &mut extremes),
        Data::Scattered(data) => of_samples(data, &mut extremes),
        Data::Rgl(data) => of_rgl(data, &mut extremes),
        _ => return None,
    }
    let is_product = matches!(part.data, Data::Rgl(_));
    let Extremes { near: values, away } = extremes;
    let near = values.iter().copied().fold(0.0, f64::max);
    let count = values.iter().filter(|value| **value > away).count();
    (away > 0.0 && near > OUT * away).then(|| {
        if is_product {
            let text = format!(
                "within 1.1 degrees of the horizon f grows up to {near:.3e}, against {away:.3e} elsewhere: the file has f times \
                 the cosine, which does not go to 0 there"
            );
            let finding = Finding::new("horizon", &part_name(document, part), Status::Note, text);
            return finding.number("near", near).number("away", away).number("count", count as f64);
        }
        let text = format!(
            "{count} values within 1.1 degrees of the horizon are larger than all values 3.4 degrees above it, up to \
             {near:.3e} against {away:.3e}: probably quotients by a cosine that is nearly 0"
        );
        Finding::new("horizon", &part_name(document, part), Status::Warn, text)
            .number("near", near)
            .number("away", away)
            .number("count", count as f64)
    })
}

/// The values next to the horizon, and the largest away from it.
#[derive(Default)]
struct Extremes {
    near: Vec<f64>,
    away: f64,
}

impl Extremes {
    /// Adds the value for light from `wi` to `wo`, both above the horizon or left out.
    fn add(&mut self, (wi, wo): ([f64; 3], [f64; 3]), texel: &[f32]) {
        let height = wi[2].min(wo[2]);
        let largest = texel.iter().fold(0.0_f64, |most, &value| most.max(f64::from(value)));
        if height >= AWAY {
            self.away = self.away.max(largest);
        } else if height > 0.0 && height < NEAR {
            let h: [f64; 3] = std::array::from_fn(|i| wi[i] + wo[i]);
            let is_peak = h[0].hypot(h[1]) < PEAK.tan() * h[2];
            if !is_peak {
                self.near.push(largest);
            }
        }
    }
}

fn of_bins(data: &half_diff::Data, extremes: &mut Extremes) {
    let [halves, differences, turns] = data.bins();
    for bin in
        (0..halves * differences * turns).map(|i| [i / (differences * turns), i / turns % differences, i % turns])
    {
        if data.is_measured(bin) {
            let middle = |axis: usize| (bin[axis] as f64 + 0.5) / data.bins()[axis] as f64;
            let (sin, cos) = (middle(0).powi(2) * std::f64::consts::FRAC_PI_2).sin_cos();
            let tilted = |[x, y, z]: [f64; 3]| [cos * x + sin * z, y, cos * z - sin * x];
            let (theta_d, phi_d) = (middle(1) * std::f64::consts::FRAC_PI_2, middle(2) * data.period());
            let opposite = phi_d + std::f64::consts::PI;
            extremes.add((tilted(direction(theta_d, phi_d)), tilted(direction(theta_d, opposite))), &data.texel(bin));
        }
    }
}

fn of_grid(grid: &spherical::Data, extremes: &mut Extremes) {
    let [a, b, c, d] = grid.knots();
    let mut texels = grid.values().chunks_exact(grid.channels().count());
    for &theta_i in a {
        for &phi_i in b {
            for &theta_o in c {
                for &phi_o in d {
                    let Some(texel) = texels.next() else { return };
                    extremes.add((direction(theta_i, phi_i), direction(theta_o, phi_o)), texel);
                }
            }
        }
    }
}

/// Evaluates some lights, and viewers all over the hemisphere and near its rim, because texels have no fixed
/// directions.
fn of_rgl(data: &rgl::Data, extremes: &mut Extremes) {
    const HEIGHTS: [f64; 9] = [1e-4, 1e-3, 1e-2, 0.06, 0.1, 0.2, 0.4, 0.7, 0.95];
    const AROUND: u32 = 16;
    let reference = rgl::Reference::new(data);
    let rgl::Parts { theta_i, phi_i, channels, .. } = data.parts();
    let mut texel = vec![0.0; channels.count()];
    let phi_i = phi_i.first().map_or(0.0, |phi| f64::from(*phi));
    for theta_i in theta_i.iter().map(|theta| f64::from(*theta)).filter(|theta| theta.cos() > AWAY) {
        let wi = direction(theta_i, phi_i);
        for height in HEIGHTS {
            for step in 0..AROUND {
                let wo = direction(height.acos(), phi_i + f64::from(step) * std::f64::consts::TAU / f64::from(AROUND));
                reference.eval(wi, wo, &mut texel);
                let values: Vec<f32> = texel.iter().map(|value| *value as f32).collect();
                extremes.add((wi, wo), &values);
            }
        }
    }
}

fn of_samples(data: &scattered::Data, extremes: &mut Extremes) {
    for ([theta_i, phi_i, theta_o, phi_o], texel) in data.samples() {
        extremes.add((direction(theta_i, phi_i), direction(theta_o, phi_o)), texel);
    }
}
