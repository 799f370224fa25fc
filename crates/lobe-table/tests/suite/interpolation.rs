//! Interpolation at given angles against the `f64` reference, for every layout and policy of the edges.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe_backend::Backend;
use lobe_table::{Channels, Edge, Edges, Scatter, specular, specular::reference};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// Not a multiple of any number of lanes, and more than one block.
const COUNT: usize = 203;

/// A smooth table whose knots leave out both ends of sigma and theta, so that policies matter.
fn samples(psi: usize, channels: Channels) -> specular::Data {
    let knots = |count: usize, from: f64, to: f64| -> Vec<f64> {
        (0..count).map(|i| from + (to - from) * (i as f64 / (count - 1).max(1) as f64).powf(1.3)).collect()
    };
    let knots = [knots(6, 0.1, 1.4), knots(psi, 0.0, TAU), knots(9, 0.2, 2.5), knots(12, 0.0, TAU)];
    let mut values = Vec::new();
    for sigma in &knots[0] {
        for psi in &knots[1] {
            for theta in &knots[2] {
                for phi in &knots[3] {
                    for channel in 0..channels.count() {
                        values.push((sigma * psi.cos() + theta * (phi + channel as f64).cos()) as f32);
                    }
                }
            }
        }
    }
    specular::Data::new(Scatter::Reflection, knots, channels, values).expect("a valid table")
}

/// Points throughout the table and outside it; the first eight have an angle that is not finite.
fn angles() -> [Vec<f32>; 4] {
    let mut rng = Pcg32::seed_from_u64(3);
    let mut angles = [FRAC_PI_2, TAU, PI, TAU].map(|end| {
        let any = (0..COUNT).map(|_| rng.random_range(0.0..end as f32));
        any.collect::<Vec<_>>()
    });
    for (axis, angles) in angles.iter_mut().enumerate() {
        angles[axis] = f32::NAN;
        angles[4 + axis] = f32::INFINITY;
    }
    angles
}

fn check(samples: &specular::Data, edges: &Edges) {
    let table = specular::Table::new(samples, edges).expect("a small table");
    let (angles, channels) = (angles(), table.channel_count());
    let anisotropic = table.is_anisotropic();
    let mut out = vec![f32::NAN; COUNT * channels];
    let [sigma, psi, theta, phi] = angles.each_ref().map(Vec::as_slice);
    let psi = if anisotropic { psi } else { &[] };
    for backend in Backend::forms() {
        table.interpolate_batch(backend, [sigma, psi, theta, phi], &mut out);
        compare(samples, edges, &angles, &out);
    }
}

fn compare(samples: &specular::Data, edges: &Edges, angles: &[Vec<f32>; 4], out: &[f32]) {
    let (channels, anisotropic) = (samples.channels().count(), samples.knots()[1].len() > 1);
    for (query, texel) in out.chunks_exact(channels).enumerate() {
        let at = angles.each_ref().map(|angles| f64::from(angles[query]));
        let mut expected = vec![0.0; channels];
        // With one psi knot, psi is not read, so it may have any value.
        let at = if anisotropic { at } else { [at[0], 0.0, at[2], at[3]] };
        if at.iter().all(|angle| angle.is_finite()) {
            reference::eval_angles(samples, edges, at, &mut expected);
        }
        for (got, expected) in texel.iter().zip(expected) {
            assert!((f64::from(*got) - expected).abs() < 1e-5, "query {query} at {at:?}: {got}, not {expected}");
        }
    }
}

#[test]
fn values_at_angles_agree_with_the_reference() {
    for psi in [1, 5] {
        for channels in [Channels::Mono, Channels::Rgb, Channels::Named((0..9).map(|i| format!("band {i}")).collect())]
        {
            for edge in [Edge::Clamp, Edge::Zero] {
                let samples = samples(psi, channels.clone());
                check(&samples, &Edges { axes: [edge, Edge::Clamp, edge, Edge::Clamp], ..Edges::default() });
            }
        }
    }
}

#[test]
#[should_panic(expected = "as many angles of each kind")]
fn a_missing_angle_is_refused() {
    let table = specular::Table::new(&samples(5, Channels::Mono), &Edges::default()).expect("a small table");
    table.interpolate_batch(Backend::scalar(), [&[0.1], &[], &[0.1], &[0.1]], &mut [0.0]);
}
