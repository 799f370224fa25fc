//! Scattered samples.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe_backend::Backend;
use lobe_table::scattered::{self, Data};
use lobe_table::{Channels, Directions, Scatter};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::common::{COUNT, Evaluate, NOWHERE, Pairs, evaluate};

impl Evaluate for scattered::Table {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch(backend, wi, wo, out);
    }
}

fn names(count: usize) -> Channels {
    match count {
        1 => Channels::Mono,
        3 => Channels::Rgb,
        _ => Channels::Named((0..count).map(|channel| channel.to_string()).collect()),
    }
}

/// Samples with values that are unrelated, or change slowly.
fn data(scatter: Scatter, channels: usize, angles: &[[f64; 4]]) -> Data {
    let mut rng = Pcg32::seed_from_u64(9);
    let values: Vec<f32> = (0..angles.len() * channels).map(|_| rng.random_range(-0.1..1.0)).collect();
    Data::new(scatter, names(channels), angles, &values).expect("samples")
}

fn check(name: &str, data: &Data) {
    let pairs = Pairs::new(true);
    let table = scattered::Table::new(data).expect("a table");
    let width = data.channels().count();
    for (form, values) in evaluate(&table, &pairs, width) {
        let (mut lit, mut widest, mut sum) = (0, 0.0_f64, 0.0);
        for query in 0..COUNT - NOWHERE {
            let (wi, wo) = pairs.exact(query);
            let (expected, found) = (data.eval(wi, wo), &values[query * width..][..width]);
            let off = |(a, b): (&f32, &f32)| f64::from((a - b).abs());
            let error = expected.iter().zip(found).map(off).fold(0.0, f64::max);
            // Few are off by more than rounding alone.
            if error > 1e-6 {
                let bound = data.bound(wi, wo);
                assert!(
                    error <= bound,
                    "{name} {form} {query}: {found:?}, not {expected:?} within {bound}: {wi:?} {wo:?}"
                );
                widest = widest.max(bound);
            }
            lit += usize::from(found.iter().any(|value| *value != 0.0));
            sum += error;
        }
        println!("{name} {form}: {lit} lit, {:.1e} off on average, bound up to {widest:.1e}", sum / COUNT as f64);
        assert!(lit > COUNT / 5, "{name}: {lit} lit");
    }
}

/// A ring of directions with a gap, closer together near the peak.
fn about_the_peak(theta: f64, phi: f64, rings: usize, sectors: usize, reach: f64) -> Vec<[f64; 4]> {
    let mut angles = Vec::new();
    for ring in 0..rings {
        for sector in 0..sectors {
            let from_peak = reach * (ring as f64 / rings as f64).powi(2);
            let (sin, cos) = ((sector as f64 + 0.3) / sectors as f64 * TAU).sin_cos();
            let (x, y) = (theta + from_peak * cos, from_peak * sin);
            if x.hypot(y) < FRAC_PI_2 {
                angles.push([theta, phi, x.hypot(y), phi + PI + y.atan2(x)]);
            }
        }
    }
    angles
}

#[test]
fn isotropic_samples_agree_with_the_reference() {
    let all = |reach| -> Vec<[f64; 4]> {
        [0.0, 0.2, 0.5, 0.9, 1.3].into_iter().flat_map(|theta| about_the_peak(theta, 0.0, 9, 16, reach)).collect()
    };
    check("isotropic", &data(Scatter::Reflection, 3, &all(1.4)));
    check("a narrow peak", &data(Scatter::Reflection, 1, &all(0.05)));
    check("transmission", &data(Scatter::Transmission, 7, &all(1.0)));
    let mut half = all(1.2);
    half.retain(|[_, _, _, phi]| phi.sin() >= 0.0);
    half.extend((0..20).flat_map(|k| [0.0, PI].map(|phi| [0.5, 0.0, 0.07 * f64::from(k), phi])));
    check("one side", &data(Scatter::Reflection, 2, &half));
}

#[test]
fn samples_on_lines_and_single_ones_agree_with_the_reference() {
    let plane = |theta: f64| {
        (-30..=30).map(move |k: i32| [theta, 0.4, 0.05 * f64::from(k.abs()), if k < 0 { 0.4 } else { 0.4 + PI }])
    };
    let in_plane: Vec<[f64; 4]> = [0.1, 0.7, 1.2].into_iter().flat_map(plane).collect();
    check("in plane", &data(Scatter::Reflection, 1, &in_plane));
    check("one light", &data(Scatter::Reflection, 3, &about_the_peak(0.6, 1.0, 8, 12, 0.9)));
    check("one sample", &data(Scatter::Reflection, 3, &[[0.4, 0.0, 0.5, 2.0]]));
    check("two samples", &data(Scatter::Reflection, 4, &[[0.4, 0.0, 0.5, 2.0], [0.4, 0.0, 0.9, 1.0]]));
}

#[test]
fn anisotropic_samples_agree_with_the_reference() {
    let mut rng = Pcg32::seed_from_u64(4);
    let mut angles = Vec::new();
    let mut lights = vec![[0.0, 0.0], [0.3, 0.0], [0.3, 2.0], [0.3, 4.0], [1.4, 1.0], [1.4, 3.0], [1.4, 5.0]];
    lights.extend((0..30).map(|_| [rng.random_range(0.1..1.5), rng.random_range(0.0..TAU)]));
    for [theta, phi] in lights {
        let count = rng.random_range(5..60);
        angles.extend((0..count).map(|_| [theta, phi, rng.random_range(0.0..1.5), rng.random_range(0.0..TAU)]));
    }
    check("anisotropic", &data(Scatter::Reflection, 3, &angles));
    check("anisotropic transmission", &data(Scatter::Transmission, 12, &angles));
}

/// Points so close together, and triangles so thin, that single precision cannot locate a direction.
#[test]
fn narrow_triangles_are_left_to_double_precision() {
    let mut angles = about_the_peak(0.5, 0.0, 6, 12, 1.2);
    for k in 0..12 {
        let at = f64::from(k);
        angles.push([0.5, 0.0, 0.5 + 3e-6 * at, PI + 2e-6 * (at * at) % 1e-5]);
        angles.push([0.5, 0.0, 0.8 + 0.03 * at, 1.0 + 1e-6 * (at % 3.0)]);
    }
    check("too narrow", &data(Scatter::Reflection, 1, &angles));
}

/// Rings of samples at equal azimuths: each trapezoid has two diagonals that are equally good.
#[test]
fn equally_good_triangles_are_chosen_the_same_way_on_every_system() {
    let angle = |degrees: u32| f64::from(degrees).to_radians();
    let mut angles = Vec::new();
    for light in [0, 30, 60] {
        for ring in 0..6 {
            angles.extend((0..24).map(|sector| [angle(light), 0.0, angle(17 * ring), angle(15 * sector)]));
        }
    }
    let values: Vec<f32> = (0..angles.len()).map(|at| (at * 37 % 101) as f32 / 16.0).collect();
    let data = Data::new(Scatter::Reflection, Channels::Mono, &angles, &values).expect("samples");
    // Directions without a sine, and a hash (FNV-1a) of the bits of their values.
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for at in 0..2000_u32 {
        let part = |step: u32| f64::from(at * step % 199) / 99.5 - 1.0;
        let (wi, wo) = ([part(7), 0.0, 1.0], [part(11), part(31), 0.75]);
        let [value] = data.eval(wi, wo).try_into().expect("one channel");
        for byte in value.to_bits().to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    assert_eq!(hash, 0xc7e3_0060_7448_ef9e, "{hash:#x}");
}
