//! Queries of all kinds, and their evaluation on every backend.

use lobe_lane::Lanes;
use lobe_scalar::Scalar;
use lobe_table::Soa;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// Not a multiple of any number of lanes, and many blocks.
pub const COUNT: usize = 20_011;

/// Pairs of directions.
pub struct Pairs {
    pub wi: Vec<[f32; 3]>,
    pub wo: Vec<[f32; 3]>,
}

impl Pairs {
    /// Pairs on both sides of the surface, or on the upper one: a quarter around the mirror direction, some along the
    /// normal, the horizon and each other, some of other lengths, and behind them such as are none.
    pub fn new(two_sided: bool) -> Self {
        let mut rng = Pcg32::seed_from_u64(7);
        let mut any = |spread: f32| loop {
            let v: [f32; 3] = std::array::from_fn(|_| rng.random_range(-1.0..1.0f32));
            let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
            if (0.1..1.0).contains(&length) {
                let z = if two_sided { v[2] } else { v[2].abs() };
                return [v[0] / length * spread, v[1] / length * spread, z / length];
            }
        };
        let (mut wi, mut wo): (Vec<_>, Vec<_>) = (0..COUNT).map(|_| (any(1.0), any(1.0))).unzip();
        for query in (0..COUNT - NOWHERE).step_by(4) {
            let [x, y, z] = wi[query];
            let [dx, dy, dz] = any(1.0).map(|c| c * 10f32.powi(-((query / 4 % 7) as i32)));
            wo[query] = [dx - x, dy - y, if two_sided { z + dz } else { (z + dz).abs() }];
        }
        let fixed = [[0.0, 0.0, 1.0], [-0.0, 0.0, 1.0], [1e-7, -1e-7, 1.0], [1.0, 0.0, 1e-6], [0.0, -1.0, 1e-20]];
        for (i, a) in fixed.into_iter().enumerate() {
            for (j, b) in fixed.into_iter().enumerate() {
                (wi[1000 + 5 * i + j], wo[1000 + 5 * i + j]) = (a, b);
            }
            wo[1100 + i] = wi[1100 + i];
            let [x, y, z] = wi[1200 + i];
            wo[1200 + i] = [-x, -y, z];
            wi[1300 + i] = wi[1300 + i].map(|c| 1e6 * c);
            wo[1400 + i] = wo[1400 + i].map(|c| 1e-6 * c);
        }
        let last = COUNT - NOWHERE;
        for (k, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX].into_iter().enumerate() {
            for axis in 0..3 {
                wi[last + 6 * k + axis][axis] = bad;
                wo[last + 6 * k + 3 + axis][axis] = bad;
            }
        }
        (wi[last + 24], wo[last + 25]) = ([0.0; 3], [0.0; 3]);
        (wi[last + 26], wo[last + 27]) = ([0.6, 0.8, 0.0], [0.6, 0.8, -0.0]);
        Pairs { wi, wo }
    }

    /// Unit vectors in `f64`.
    pub fn exact(&self, query: usize) -> ([f64; 3], [f64; 3]) {
        let unit = |w: [f32; 3]| {
            let w = w.map(f64::from);
            let length = w.iter().map(|x| x * x).sum::<f64>().sqrt();
            w.map(|x| x / length)
        };
        (unit(self.wi[query]), unit(self.wo[query]))
    }
}

/// How many of the last queries have directions that point nowhere, and no value.
pub const NOWHERE: usize = 28;

/// What is compared: an evaluation of many pairs.
pub trait Evaluate {
    fn run<L: Lanes>(&self, lanes: L, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]);
    fn run_columns<L: Lanes>(&self, lanes: L, wi: Soa<'_>, wo: Soa<'_>, out: &mut [f32]);
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|x| x.to_bits()).collect()
}

/// The values of all pairs, `width` a pair, in strict and, where there is such a backend, in fused form. Asserts that strict
/// ones are the same bits on every backend, however the directions lie in memory, and that none depends on its neighbours.
pub fn evaluate<E: Evaluate>(evaluator: &E, pairs: &Pairs, width: usize) -> Vec<(&'static str, Vec<f32>)> {
    let Pairs { wi, wo } = pairs;
    let scalar = on(evaluator, Scalar::<1>, pairs, width);
    let same = |other: &[f32], what: &str| assert_eq!(bits(&scalar), bits(other), "{what}");
    same(&on(evaluator, Scalar::<8>, pairs, width), "emulated8");

    let split = |w: &[[f32; 3]]| [0, 1, 2].map(|k| w.iter().map(|v| v[k]).collect::<Vec<f32>>());
    let ([ix, iy, iz], [ox, oy, oz]) = (split(wi), split(wo));
    let mut columns = vec![f32::NAN; scalar.len()];
    evaluator.run_columns(Scalar::<4>, Soa::new(&ix, &iy, &iz), Soa::new(&ox, &oy, &oz), &mut columns);
    same(&columns, "columns");
    for query in (0..COUNT).step_by(97) {
        let mut single = vec![f32::NAN; width];
        evaluator.run(Scalar::<8>, &wi[query..=query], &wo[query..=query], &mut single);
        assert_eq!(bits(&single), bits(&scalar[query * width..][..width]), "query {query} alone");
    }
    for (query, value) in scalar.chunks_exact(width).enumerate().skip(COUNT - NOWHERE) {
        assert!(value.iter().all(|x| *x == 0.0), "query {query}: {value:?}");
    }

    let fused = native(evaluator, pairs, width, &same);
    [("strict", scalar.clone())].into_iter().chain(fused.map(|values| ("fused", values))).collect()
}

/// Holds the backends of this processor to the strict values; the fused ones, where it has them.
#[cfg(target_arch = "x86_64")]
fn native<E: Evaluate>(evaluator: &E, pairs: &Pairs, width: usize, same: &dyn Fn(&[f32], &str)) -> Option<Vec<f32>> {
    same(&on(evaluator, lobe_sse::Sse2::new(), pairs, width), "sse2");
    match lobe_sse::Sse41::detect() {
        Some(lanes) => same(&on(evaluator, lanes, pairs, width), "sse4.1"),
        None => println!("SKIPPED: this CPU has no SSE4.1"),
    }
    let Some(lanes) = lobe_avx::Avx2::detect() else {
        println!("SKIPPED: this CPU has no AVX2");
        return None;
    };
    same(&on(evaluator, lanes.strict(), pairs, width), "avx2 strict");
    Some(on(evaluator, lanes, pairs, width))
}

#[cfg(not(target_arch = "x86_64"))]
fn native<E: Evaluate>(_: &E, _: &Pairs, _: usize, _: &dyn Fn(&[f32], &str)) -> Option<Vec<f32>> {
    None
}

fn on<E: Evaluate, L: Lanes>(evaluator: &E, lanes: L, pairs: &Pairs, width: usize) -> Vec<f32> {
    let mut out = vec![f32::NAN; COUNT * width];
    evaluator.run(lanes, &pairs.wi, &pairs.wo, &mut out);
    out
}
