//! Queries of all kinds, and their evaluation on every backend.

use lobe_backend::Backend;
use lobe_table::Directions;
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
    /// normal, the horizon and each other, some of other lengths, followed by invalid ones.
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

/// The number of queries at the end whose directions are invalid and have no value.
pub const NOWHERE: usize = 28;

/// An evaluation of many pairs, which is compared.
pub trait Evaluate {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]);
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|x| x.to_bits()).collect()
}

/// The values of all pairs, `width` per pair, in strict form and in the fused form of the backends that have one.
/// Asserts that strict values have the same bits on every backend and for every layout of directions, and that no value
/// depends on its neighbours.
pub fn evaluate<E: Evaluate>(evaluator: &E, pairs: &Pairs, width: usize) -> Vec<(&'static str, Vec<f32>)> {
    let Pairs { wi, wo } = pairs;
    let strict = on(evaluator, Backend::scalar().strict(), pairs, width);
    let split = |w: &[[f32; 3]]| [0, 1, 2].map(|k| w.iter().map(|v| v[k]).collect::<Vec<f32>>());
    let ([ix, iy, iz], [ox, oy, oz]) = (split(wi), split(wo));
    let mut forms = Vec::new();
    for backend in Backend::forms() {
        let values = on(evaluator, backend, pairs, width);
        let mut columns = vec![f32::NAN; values.len()];
        let of_columns = [Directions::columns(&ix, &iy, &iz), Directions::columns(&ox, &oy, &oz)];
        let [wi_columns, wo_columns] = of_columns;
        evaluator.run(backend, wi_columns, wo_columns, &mut columns);
        assert_eq!(bits(&columns), bits(&values), "columns on {backend}");
        for query in (0..COUNT).step_by(97) {
            let mut single = vec![f32::NAN; width];
            evaluator.run(backend, (&wi[query..=query]).into(), (&wo[query..=query]).into(), &mut single);
            assert_eq!(bits(&single), bits(&values[query * width..][..width]), "query {query} alone on {backend}");
        }
        if backend.is_strict() {
            assert_eq!(bits(&strict), bits(&values), "{backend}");
        } else {
            forms.push(("fused", values));
        }
    }
    for (query, value) in strict.chunks_exact(width).enumerate().skip(COUNT - NOWHERE) {
        assert!(value.iter().all(|x| *x == 0.0), "query {query}: {value:?}");
    }
    forms.insert(0, ("strict", strict));
    forms
}

fn on<E: Evaluate>(evaluator: &E, backend: Backend, pairs: &Pairs, width: usize) -> Vec<f32> {
    let mut out = vec![f32::NAN; COUNT * width];
    evaluator.run(backend, (&pairs.wi).into(), (&pairs.wo).into(), &mut out);
    out
}
