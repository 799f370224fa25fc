//! Evaluation in lanes against the `f64` reference, for every layout, edge policy and kind of search.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes};
use lobe_scalar::Scalar;
use lobe_table::{
    Channels, Directions, Edge, Edges, Precision, Scatter, specular, specular::coords, specular::reference,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// A function that is smooth in all angles, so that an error in an angle causes an error of the same size in the value;
/// it has equal values around each pole, and is negative in places.
fn smooth(knots: [Vec<f64>; 4], channels: Channels, scatter: Scatter) -> specular::Data {
    let mut values = Vec::new();
    for sigma in &knots[0] {
        for psi in &knots[1] {
            for theta in &knots[2] {
                for phi in &knots[3] {
                    for channel in 0..channels.count() {
                        let around = theta.sin() * (phi + channel as f64).cos() + sigma.sin() * (2.0 * psi).cos();
                        values.push((0.4 * around + (sigma + 2.0 * theta).cos() * 0.3) as f32);
                    }
                }
            }
        }
    }
    specular::Data::new(scatter, knots, channels, values).unwrap()
}

/// Angles in `[from, to]`, closer together near `from` unless `power` is 1.
fn knots(count: usize, from: f64, to: f64, power: f64) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * (i as f64 / (count - 1).max(1) as f64).powf(power)).collect()
}

fn directions(count: usize) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let mut rng = Pcg32::seed_from_u64(11);
    let mut any = || loop {
        let v: [f32; 3] = std::array::from_fn(|_| rng.random_range(-1.0..1.0f32));
        let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
        if (0.1..1.0).contains(&length) {
            return [v[0] / length, v[1] / length, (v[2] / length).abs()];
        }
    };
    let (mut wi, mut wo): (Vec<_>, Vec<_>) = (0..count).map(|_| (any(), any())).unzip();
    // The mirror direction and the normal, exactly and nearly; a direction below the horizon; and invalid directions.
    wo[0] = [-wi[0][0], -wi[0][1], wi[0][2]];
    (wi[1], wo[2]) = ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
    wi[3] = [1e-4, 0.0, 1.0];
    wo[4] = [wo[4][0], wo[4][1], -wo[4][2]];
    wi[5] = [f32::NAN, 0.0, 1.0];
    wo[6] = [0.0, f32::INFINITY, 1.0];
    wo[7] = [0.0; 3];
    (wi, wo)
}

/// The backend or lanes on which a table is evaluated.
trait Machine: Copy {
    fn name(self) -> String;

    fn run<K: Kernel>(self, kernel: K) -> K::Out;

    fn eval(self, table: &specular::Table, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]);

    fn eval_batch(self, table: &specular::Table, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]);
}

impl Machine for Backend {
    fn name(self) -> String {
        Backend::name(&self).to_string()
    }

    fn run<K: Kernel>(self, kernel: K) -> K::Out {
        Backend::run(&self, kernel)
    }

    fn eval(self, table: &specular::Table, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        table.eval(self, wi, wo, out);
    }

    fn eval_batch(self, table: &specular::Table, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        table.eval_batch(self, wi, wo, out);
    }
}

/// Lanes that are not a backend, which run the kernels directly.
#[derive(Clone, Copy)]
struct Emulated<L>(L);

impl<L: Lanes> Machine for Emulated<L> {
    fn name(self) -> String {
        L::NAME.to_string()
    }

    fn run<K: Kernel>(self, kernel: K) -> K::Out {
        self.0.vectorize(kernel)
    }

    fn eval(self, table: &specular::Table, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.run(table.single(wi, wo, out));
    }

    fn eval_batch(self, table: &specular::Table, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.run(table.batch(wi, wo, out));
    }
}

struct OneLane<'a>(&'a specular::Table, [f32; 3], [f32; 3], &'a mut [f32]);

impl Kernel for OneLane<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let OneLane(table, wi, wo, out) = self;
        let mut values = vec![lanes.splat(f32::NAN); out.len()];
        let last = L::LANES - 1;
        // Only the last lane takes part.
        let mask = lanes.first_n(L::LANES) ^ lanes.first_n(last);
        table.eval_lanes(lanes, wi.map(|x| lanes.splat(x)), wo.map(|x| lanes.splat(x)), mask, &mut values);
        for (target, value) in out.iter_mut().zip(values) {
            *target = lanes.extract(value, last);
            assert!(last == 0 || lanes.extract(value, 0) == 0.0, "a lane that the mask leaves out");
        }
    }
}

fn check(machine: impl Machine, samples: &specular::Data, edges: &Edges, name: &str) {
    check_stored(machine, samples, edges, Precision::Single, 2e-5, name);
}

fn check_stored(
    machine: impl Machine,
    samples: &specular::Data,
    edges: &Edges,
    precision: Precision,
    tolerance: f64,
    name: &str,
) {
    let channels = samples.channels().count();
    let table = specular::Table::with_precision(samples, edges, precision).unwrap();
    // Not a multiple of any number of lanes, and more than one block.
    let (wi, wo) = directions(515);
    let mut batch = vec![f32::NAN; wi.len() * channels];
    machine.eval_batch(&table, (&wi).into(), (&wo).into(), &mut batch);

    let component = |w: &[[f32; 3]], k: usize| w.iter().map(|v| v[k]).collect::<Vec<f32>>();
    let [ix, iy, iz] = [0, 1, 2].map(|k| component(&wi, k));
    let [ox, oy, oz] = [0, 1, 2].map(|k| component(&wo, k));
    let mut separate = vec![f32::NAN; batch.len()];
    let columns = [Directions::columns(&ix, &iy, &iz), Directions::columns(&ox, &oy, &oz)];
    machine.eval_batch(&table, columns[0], columns[1], &mut separate);
    let bits = |values: &[f32]| values.iter().map(|x| x.to_bits()).collect::<Vec<u32>>();
    assert_eq!(bits(&batch), bits(&separate), "{name}: vectors and components differ");

    let scale = samples.values().iter().fold(0f64, |largest, v| largest.max(v.abs() as f64));
    let mut largest = 0f64;
    for query in 0..wi.len() {
        let got = &batch[query * channels..][..channels];
        let (mut single, mut lane) = (vec![f32::NAN; channels], vec![f32::NAN; channels]);
        machine.eval(&table, wi[query], wo[query], &mut single);
        assert_eq!(bits(got), bits(&single), "{name}: one pair, query {query}: {:?} {:?}", wi[query], wo[query]);
        machine.run(OneLane(&table, wi[query], wo[query], &mut lane));
        assert_eq!(bits(got), bits(&lane), "{name}: lanes, query {query}");

        let mut expected = vec![0.0; channels];
        let exact = |w: [f32; 3]| {
            let w = w.map(f64::from);
            let length = w.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length.is_finite() && length > 0.0 { w.map(|x| x / length) } else { w }
        };
        let (wi, wo) = (exact(wi[query]), exact(wo[query]));
        reference::eval(samples, edges, wi, wo, &mut expected);
        // If the ends of phi are not joined, an angle just to either side of 0 gives the value of one end or the other.
        let [.., phi] = coords::directions_to_angles(wi, wo, |sigma| reference::zenith(samples, edges, sigma));
        if edges.axes[3] != Edge::Periodic && phi.min(TAU - phi) < 1e-6 {
            continue;
        }
        for (got, expected) in got.iter().zip(&expected) {
            let error = (*got as f64 - expected).abs() / scale;
            assert!(error < tolerance, "{name}: query {query}, {got} is not {expected}: {wi:?} {wo:?}");
            largest = largest.max(error);
        }
    }
    println!("{:>10} {name}: largest error {largest:.1e} of the largest value", machine.name());
}

fn check_all(machine: impl Machine) {
    let gap = Edges { axes: [Edge::Clamp, Edge::Periodic, Edge::Clamp, Edge::Periodic], non_negative: false };
    let policies =
        [("default", Edges::default()), ("extrapolate", Edges::extrapolate()), ("zero", Edges::zero()), ("gap", gap)];
    for (policy, edges) in policies {
        for channels in [1, 2, 3, 4, 11] {
            let colour = match channels {
                1 => Channels::Mono,
                3 => Channels::Rgb,
                n => Channels::Spectral((0..n).map(|i| 400.0 + 10.0 * i as f64).collect()),
            };
            // Small axes, which are searched in registers; the last angle of phi leaves a gap in the circle.
            let small = [knots(7, 0.0, 1.4, 1.2), vec![0.0], knots(9, 0.0, 3.0, 2.0), knots(13, 0.0, 6.0, 1.1)];
            let samples = smooth(small, colour.clone(), Scatter::Reflection);
            check(machine, &samples, &edges, &format!("{policy} {channels} isotropic"));
            let turning = [
                knots(17, 0.1, FRAC_PI_2, 1.2),
                knots(5, 0.3, 5.9, 1.3),
                knots(20, 0.0, PI, 2.0),
                knots(4, 0.0, TAU, 1.5),
            ];
            let samples = smooth(turning, colour, Scatter::Reflection);
            check(machine, &samples, &edges, &format!("{policy} {channels} anisotropic"));
            // Weights add up to 1, so an interpolated value has no larger error than a stored one: 2^-11 of it.
            let half = 2e-5 + 1.0 / 2048.0;
            check_stored(machine, &samples, &edges, Precision::Half, half, &format!("{policy} {channels} half"));
        }
        // Equal cells, one knot only, and so many knots that a guide table is needed.
        let large = [knots(90, 0.0, FRAC_PI_2, 2.0), vec![0.0], knots(50, 0.0, PI, 1.0), knots(200, 0.0, TAU, 1.3)];
        check(machine, &smooth(large, Channels::Rgb, Scatter::Reflection), &edges, &format!("{policy} large"));
        let flat = [knots(3, 0.0, FRAC_PI_2, 1.0), vec![0.0], knots(30, 0.0, PI, 1.7), vec![0.0]];
        check(machine, &smooth(flat, Channels::Mono, Scatter::Reflection), &edges, &format!("{policy} one phi"));

        let through = || {
            [knots(6, 0.0, FRAC_PI_2, 1.0), knots(3, 0.0, TAU, 1.0), knots(12, 0.0, PI, 1.5), knots(9, 0.0, TAU, 1.0)]
        };
        let samples = smooth(through(), Channels::Rgb, Scatter::Transmission);
        check(machine, &samples, &edges, &format!("{policy} transmission"));
        let bent = |sigma: &f64| (sigma.sin() / 1.5).asin() - sigma;
        let refracted = samples.clone().with_refraction(through()[0].iter().map(bent).collect()).unwrap();
        check(machine, &refracted, &edges, &format!("{policy} refraction"));
    }
}

#[test]
fn strict() {
    Backend::available().into_iter().map(Backend::strict).for_each(check_all);
}

#[test]
fn fused() {
    let fusing: Vec<_> = Backend::available().into_iter().filter(Backend::has_fused_form).collect();
    if fusing.is_empty() {
        println!("SKIP: this CPU has no backend that fuses");
    }
    fusing.into_iter().map(Backend::fused).for_each(check_all);
}

#[test]
fn emulated4() {
    check_all(Emulated(Scalar::<4>));
}

#[test]
fn emulated8() {
    check_all(Emulated(Scalar::<8>));
}

#[test]
fn emulated16() {
    check_all(Emulated(Scalar::<16>));
}
