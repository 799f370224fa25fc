//! Directions sampled in proportion to a table, with their densities and weights, compared with single samples in
//! `f64`.

use std::rc::Rc;
use std::sync::Arc;

use lobe::table::{Given, Sampled, Sampler, SamplerOptions};
use lobe::{Backend, Edges, specular};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::{Contender, Contest, Tolerance, backends};
use crate::baseline::{self, ScalarTable};
use crate::tables;
use crate::workload::Input;

/// Tolerance of directions. If a cell is dark, few numbers lead into it, and rounding moves a sample far within it.
const TOLERANCE: Tolerance = Tolerance { max: 5e-2, rms: 5e-4 };

/// From an isotropic table.
pub fn iso(input: Input, count: usize) -> Contest {
    contest(tables::isotropic(), input, count)
}

/// From an anisotropic table.
pub fn aniso(input: Input, count: usize) -> Contest {
    contest(tables::anisotropic(), input, count)
}

struct Setup {
    known: Vec<[f32; 3]>,
    u: Vec<[f32; 2]>,
    sampler: Sampler,
    scalar: ScalarTable,
}

/// The samples: directions, densities, weights.
type Drawn = (Vec<[f32; 3]>, Vec<f32>, Vec<f32>);

fn contest(samples: specular::Data, input: Input, count: usize) -> Contest {
    let table = Arc::new(specular::Table::new(&samples, &Edges::default()).expect("a small table"));
    let sampler = Sampler::new(Backend::scalar(), table, &SamplerOptions::default()).expect("options that make sense");
    let mut rng = Pcg32::seed_from_u64(2005);
    let setup = Rc::new(Setup {
        known: input.pairs(count).vectors().0,
        u: (0..count).map(|_| [rng.random(), rng.random()]).collect(),
        sampler,
        scalar: ScalarTable::new(&samples),
    });
    let draw = |query: usize| {
        let (known, u) = (setup.known[query].map(f64::from), setup.u[query].map(f64::from));
        setup.sampler.distribution().draw_reference(known, u).map_or([0.0; 3], |(direction, _)| direction)
    };
    let expected = (0..count).flat_map(draw).collect();
    let contenders = backends().into_iter().map(|named| {
        let setup = setup.clone();
        let run = move |(directions, pdfs, weights): &mut Drawn| {
            let out = Sampled { directions, pdfs, weights };
            setup.sampler.sample_batch(named.backend, Given::Light, &setup.known, &setup.u, out);
        };
        Contender::new(named.name, TOLERANCE, empty(count), run, |out| out.0.as_flattened().to_vec())
    });
    Contest { count, contenders: contenders.collect(), expected, baselines: vec![one_by_one(setup.clone(), count)] }
}

fn empty(count: usize) -> Drawn {
    (vec![[f32::NAN; 3]; count], vec![f32::NAN; count], vec![f32::NAN; 3 * count])
}

/// One sample at a time, with its value from the scalar evaluation.
fn one_by_one(setup: Rc<Setup>, count: usize) -> Contender {
    let run = move |(directions, pdfs, weights): &mut Drawn| {
        let (weights, _) = weights.as_chunks_mut::<3>();
        for (query, weight) in weights.iter_mut().enumerate() {
            let known = setup.known[query];
            let u = setup.u[query].map(f64::from);
            let drawn = setup.sampler.distribution().draw_reference(known.map(f64::from), u);
            let (direction, pdf) = drawn.unwrap_or_default();
            (directions[query], pdfs[query]) = (direction.map(|x| x as f32), pdf as f32);
            let f = baseline::libm::eval(&setup.scalar, known, directions[query]);
            *weight = f.map(|f| f * directions[query][2] / pdfs[query]);
        }
    };
    Contender::new("f64", TOLERANCE, empty(count), run, |out| out.0.as_flattened().to_vec())
}
