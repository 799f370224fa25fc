//! Materials of the EPFL database: values, densities and samples, compared with the `f64` reference one query at a
//! time.

use std::rc::Rc;

use lobe::Directions;
use lobe::table::rgl::{self, Drawn, Reference, UniformOrder};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::{Contender, Contest, Tolerance, backends};
use crate::tables;
use crate::workload::{Input, Pairs};

// A direction is rounded to 6e-8, which moves the half vector of grazing pairs, and with it the texels, by some 1e-5 of
// the square.

/// Tolerances of the lanes.
const TOLERANCE: Tolerance = Tolerance { max: 1e-4, rms: 1e-6 };
/// Tolerances of the reference, which is finally rounded to `f32`.
const EXACT: Tolerance = Tolerance { max: 1e-7, rms: 1e-7 };

struct Setup {
    pairs: Pairs,
    uniforms: Vec<[f32; 2]>,
    reference: Reference,
    table: rgl::Table,
}

impl Setup {
    fn new(input: Input, count: usize) -> Rc<Self> {
        let rgl = tables::rgl();
        let mut rng = Pcg32::seed_from_u64(2018);
        Rc::new(Setup {
            pairs: input.pairs(count),
            uniforms: (0..count).map(|_| [rng.random(), rng.random()]).collect(),
            reference: Reference::new(&rgl),
            table: rgl::Table::new(&rgl, rgl::Options::default()).expect("a small material"),
        })
    }

    fn columns(&self) -> [Directions<'_>; 2] {
        [&self.pairs.wi, &self.pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z))
    }

    fn pair(&self, query: usize) -> ([f64; 3], [f64; 3]) {
        let (wi, wo) = self.pairs.get(query);
        (wi.map(f64::from), wo.map(f64::from))
    }
}

/// `f` in 1/sr.
pub fn eval(input: Input, count: usize) -> Contest {
    let one = |setup: &Setup, query: usize, out: &mut [f64]| {
        let (wi, wo) = setup.pair(query);
        setup.reference.eval(wi, wo, out);
    };
    contest(input, count, 3, one, |named, setup| {
        let run = move |out: &mut Vec<f32>| {
            let [wi, wo] = setup.columns();
            setup.table.eval_batch(named.backend, wi, wo, out);
        };
        Contender::new(named.name, TOLERANCE, vec![f32::NAN; 3 * count], run, Vec::clone)
    })
}

/// Densities of sampling, 1/sr.
pub fn pdf(input: Input, count: usize) -> Contest {
    let one = |setup: &Setup, query: usize, out: &mut [f64]| {
        let (wi, wo) = setup.pair(query);
        out[0] = setup.reference.pdf(wi, wo);
    };
    contest(input, count, 1, one, |named, setup| {
        let run = move |out: &mut Vec<f32>| {
            let [wi, wo] = setup.columns();
            setup.table.pdf_batch(named.backend, wi, wo, out);
        };
        Contender::new(named.name, TOLERANCE, vec![f32::NAN; count], run, Vec::clone)
    })
}

/// Sampled directions, with their densities and weights.
pub fn sample(input: Input, count: usize) -> Contest {
    let one = |setup: &Setup, query: usize, out: &mut [f64]| {
        let uniform = setup.uniforms[query].map(f64::from);
        match setup.reference.sample(setup.pair(query).0, uniform, UniformOrder::default()) {
            Some(drawn) => {
                out[..3].copy_from_slice(&drawn.wo);
                out[3..].copy_from_slice(&drawn.weight);
            }
            None => out.fill(0.0),
        }
    };
    contest(input, count, 6, one, |named, setup| {
        let out = (vec![[f32::NAN; 3]; count], vec![f32::NAN; count], vec![f32::NAN; 3 * count]);
        let run = move |(wo, pdf, weights): &mut (Vec<[f32; 3]>, Vec<f32>, Vec<f32>)| {
            let [wi, _] = setup.columns();
            let drawn = Drawn { wo, pdf, weights };
            setup.table.sample_batch(named.backend, wi, &setup.uniforms, UniformOrder::default(), drawn);
        };
        Contender::new(named.name, TOLERANCE, out, run, |(wo, _, weights)| {
            let (weights, _) = weights.as_chunks::<3>();
            wo.iter().zip(weights).flat_map(|(wo, weight)| wo.iter().chain(weight).copied()).collect()
        })
    })
}

/// `one` answers a query in `f64`, as `width` numbers.
fn contest(
    input: Input,
    count: usize,
    width: usize,
    one: fn(&Setup, usize, &mut [f64]),
    contender: impl Fn(super::Named, Rc<Setup>) -> Contender,
) -> Contest {
    let setup = Setup::new(input, count);
    let all = move |setup: &Setup, out: &mut [f64]| {
        out.chunks_exact_mut(width).enumerate().for_each(|(query, out)| one(setup, query, out));
    };
    let mut expected = vec![0.0; width * count];
    all(&setup, &mut expected);
    let contenders = backends().into_iter().map(|named| contender(named, setup.clone())).collect();
    let run = move |out: &mut Vec<f64>| all(&setup, out);
    let baseline = Contender::new("f64", EXACT, vec![f64::NAN; width * count], run, |out| {
        out.iter().map(|&value| value as f32).collect()
    });
    Contest { count, baselines: vec![baseline], contenders, expected }
}
