//! Grids in spherical coordinates.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes};
use lobe_scalar::Scalar;
use lobe_table::spherical::{Data, Table};
use lobe_table::{Channels, Directions, Scatter};

use super::common::{COUNT, Evaluate, Pairs, evaluate};

impl Evaluate for Table {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch(backend, wi, wo, out);
    }
}

/// Values between -0.25 and 0.75 at these knots.
fn grid(scatter: Scatter, knots: [Vec<f64>; 4], channels: Channels) -> Data {
    let count = channels.count() * knots.iter().map(Vec::len).product::<usize>();
    let values = (0..count).map(|i| ((i * 37) % 1009) as f32 / 1008.0 - 0.25).collect();
    Data::new(scatter, knots, channels, values).expect("a grid")
}

fn steps(count: usize, last: f64) -> Vec<f64> {
    (0..count).map(|i| last * i as f64 / (count - 1) as f64).collect()
}

/// Uneven polar angles, which end before the horizon.
fn polar() -> Vec<f64> {
    vec![0.0, 0.1, 0.35, 0.6, 0.9, 1.15, 1.3, 1.45]
}

/// Azimuths that leave a gap of one cell at the seam, and start above 0.
fn open() -> Vec<f64> {
    vec![0.3, 0.9, 1.6, 2.5, 3.3, 4.2, 5.0, 5.8]
}

/// Every edge rule, layout and lookup of azimuths.
fn grids() -> Vec<(&'static str, Data)> {
    let bands = Channels::Spectral(vec![400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 750.0, 800.0]);
    let half = [polar(), vec![0.7], steps(10, FRAC_PI_2), steps(13, PI)];
    let narrow = [polar(), vec![0.0], vec![0.2, 1.0], vec![0.4, 1.1, 2.6]];
    let closed = steps(17, TAU);
    vec![
        ("half, Y", grid(Scatter::Reflection, half.clone(), Channels::Mono).mirrored().expect("half")),
        ("half, RGB", grid(Scatter::Transmission, half, Channels::Rgb).mirrored().expect("half")),
        ("a part of half", grid(Scatter::Reflection, narrow, Channels::Xyz).mirrored().expect("half")),
        ("isotropic, Y", grid(Scatter::Transmission, [polar(), vec![2.1], polar(), open()], Channels::Mono)),
        ("isotropic, RGB", grid(Scatter::Reflection, [polar(), vec![0.0], polar(), closed.clone()], Channels::Rgb)),
        ("isotropic, bands", grid(Scatter::Reflection, [polar(), vec![5.0], polar(), open()], bands.clone())),
        ("anisotropic, Y", grid(Scatter::Reflection, [polar(), open(), polar(), closed.clone()], Channels::Mono)),
        ("anisotropic, RGB", grid(Scatter::Transmission, [polar(), closed, polar(), open()], Channels::Rgb)),
        ("anisotropic, bands", grid(Scatter::Transmission, [polar(), open(), vec![0.5], open()], bands)),
        ("constant", grid(Scatter::Reflection, [vec![0.0], vec![0.0], vec![0.0], vec![0.0]], Channels::Mono)),
    ]
}

#[test]
fn values_agree_with_the_reference() {
    let pairs = Pairs::new(true);
    for (name, data) in grids() {
        let table = Table::new(&data).expect("a small grid");
        let width = table.channel_count();
        for (form, values) in evaluate(&table, &pairs, width) {
            let (mut worst, mut largest, mut dark, mut unsure) = (0.0_f64, 0.0_f64, 0, 0);
            for query in 0..COUNT - super::common::NOWHERE {
                let (wi, wo) = pairs.exact(query);
                let (expected, bound) = (data.eval(wi, wo), 0.75 * data.bound(wi, wo));
                dark += usize::from(expected.iter().all(|value| *value == 0.0));
                unsure += usize::from(bound >= 1.0);
                for channel in 0..width {
                    let error = (f64::from(values[width * query + channel]) - expected[channel]).abs();
                    assert!(error <= bound, "{name}, {form} {query}: {error:e} > {bound:e}: {wi:?} {wo:?}");
                    worst = worst.max(error / bound);
                    largest = largest.max(if bound < 1.0 { error } else { 0.0 });
                }
            }
            println!("{name}, {form}: off by at most {largest:.1e}, {worst:.2} of the bound");
            assert!(2 * dark < COUNT + COUNT / 2 && unsure < 40, "{name}: {dark} dark, {unsure} unsure");
        }
    }
}

/// Evaluates as a vectorised renderer does.
struct InLanes<'a> {
    table: &'a Table,
    wi: &'a [[f32; 3]],
    wo: &'a [[f32; 3]],
}

impl Kernel for InLanes<'_> {
    type Out = Vec<f32>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<f32> {
        let width = self.table.channel_count();
        let mut out = vec![f32::NAN; width * self.wi.len()];
        for at in (0..self.wi.len() - L::LANES).step_by(L::LANES) {
            let mut channels = vec![lanes.splat(f32::NAN); width];
            let (wi, wo) = (lanes.load_xyz(&self.wi[at..]), lanes.load_xyz(&self.wo[at..]));
            // Every lane but the first.
            let mask = !lanes.first_n(1);
            self.table.eval_lanes(lanes, wi, wo, mask, &mut channels);
            for lane in 0..L::LANES {
                for channel in 0..width {
                    out[width * (at + lane) + channel] = lanes.extract(channels[channel], lane);
                }
            }
        }
        out
    }
}

#[test]
fn lanes_of_a_callers_kernel_have_the_bits_of_a_batch() {
    let pairs = Pairs::new(true);
    for (name, data) in grids() {
        let table = Table::new(&data).expect("a small grid");
        let width = table.channel_count();
        let mut batch = vec![f32::NAN; width * COUNT];
        table.eval_batch(Backend::scalar(), (&pairs.wi).into(), (&pairs.wo).into(), &mut batch);
        let lanes = InLanes { table: &table, wi: &pairs.wi, wo: &pairs.wo }.run(Scalar::<8>);
        for (query, (a, b)) in batch.chunks_exact(width).zip(lanes.chunks_exact(width)).enumerate().take(COUNT - 8) {
            for (a, b) in a.iter().zip(b) {
                let expected = if query % 8 == 0 { 0.0_f32 } else { *a };
                assert_eq!(expected.to_bits(), b.to_bits(), "{name}: query {query}");
            }
        }
    }
}
