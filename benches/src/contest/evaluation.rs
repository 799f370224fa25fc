//! Whole evaluations, from two directions to RGB, of tables of the paper's sizes.

use std::rc::Rc;

use lobe::table::paper::PaperTable;
use lobe::table::specular::reference;
use lobe::{Backend, Directions, Edges, specular};

use super::{Contender, Contest, Tolerance, backends};
use crate::baseline::{self, ScalarTable};
use crate::tables;
use crate::workload::{Input, Pairs};

// The tables of the contests hold random values, so that the steepest cells change by their largest value over 0.012
// rad of theta, and by as much over any phi at the mirror peak, where phi means nothing. The largest errors come from
// there; the mean ones reveal a wrong kernel, which would be off by about a third.

/// Angles from differences of vectors, within 4e-7 rad.
const ACCURATE: Tolerance = Tolerance { max: 2e-3, rms: 2e-5 };
/// Angles from arc cosines of rounded cosines, up to 5e-4 rad off near the peak.
const COSINES: Tolerance = Tolerance { max: 1e-1, rms: 5e-4 };
/// The same with four terms, up to 1.4e-4 rad off anywhere.
const FOUR_TERMS: Tolerance = Tolerance { max: 1e-1, rms: 2e-3 };

/// Isotropic, in batches.
pub fn iso(input: Input, count: usize) -> Contest {
    contest(tables::isotropic(), input, count, batch)
}

/// Isotropic, one query per call.
pub fn iso_single(input: Input, count: usize) -> Contest {
    contest(tables::isotropic(), input, count, single)
}

/// Isotropic, the paper's kernel.
pub fn iso_paper(input: Input, count: usize) -> Contest {
    contest(tables::isotropic(), input, count, paper)
}

/// Anisotropic, in batches.
pub fn aniso(input: Input, count: usize) -> Contest {
    contest(tables::anisotropic(), input, count, batch)
}

/// Anisotropic, one query per call.
pub fn aniso_single(input: Input, count: usize) -> Contest {
    contest(tables::anisotropic(), input, count, single)
}

/// Anisotropic, the paper's kernel.
pub fn aniso_paper(input: Input, count: usize) -> Contest {
    contest(tables::anisotropic(), input, count, paper)
}

/// Isotropic, in batches: the strict form and the fused one.
pub fn iso_strict(input: Input, count: usize) -> Contest {
    let mut whole = iso(input, count);
    let (strict, fused): (Vec<_>, Vec<_>) = whole.contenders.into_iter().partition(|c| c.name.ends_with("-strict"));
    whole.baselines = fused.into_iter().filter(|f| strict.iter().any(|s| s.name.starts_with(f.name))).collect();
    Contest { contenders: strict, ..whole }
}

/// The input shared by all contenders.
struct Setup {
    pairs: Pairs,
    wi: Vec<[f32; 3]>,
    wo: Vec<[f32; 3]>,
    scalar: ScalarTable,
    table: specular::Table,
    paper: PaperTable,
}

impl Setup {
    fn columns(&self) -> [Directions<'_>; 2] {
        [&self.pairs.wi, &self.pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z))
    }
}

fn contest(
    samples: specular::Data,
    input: Input,
    count: usize,
    contender: fn(&'static str, Backend, Rc<Setup>) -> Contender,
) -> Contest {
    let pairs = input.pairs(count);
    let (wi, wo) = pairs.vectors();
    let mut expected = vec![0.0; 3 * count];
    for ((wi, wo), out) in wi.iter().zip(&wo).zip(expected.chunks_exact_mut(3)) {
        reference::eval(&samples, &Edges::default(), wi.map(f64::from), wo.map(f64::from), out);
    }
    let setup = Rc::new(Setup {
        pairs,
        wi,
        wo,
        scalar: ScalarTable::new(&samples),
        table: specular::Table::new(&samples, &Edges::default()).expect("a small table"),
        paper: PaperTable::new(&samples).expect("a small RGB table"),
    });
    let baselines = vec![
        scalar("libm", baseline::libm::eval, setup.clone()),
        #[cfg(target_arch = "x86_64")]
        scalar("x87", baseline::x87::eval, setup.clone()),
    ];
    let contenders = backends().into_iter().map(|named| contender(named.name, named.backend, setup.clone()));
    Contest { count, baselines, contenders: contenders.collect(), expected }
}

fn scalar(name: &'static str, eval: fn(&ScalarTable, [f32; 3], [f32; 3]) -> [f32; 3], setup: Rc<Setup>) -> Contender {
    let out = vec![[f32::NAN; 3]; setup.pairs.len()];
    let run = move |out: &mut Vec<[f32; 3]>| {
        for ((out, wi), wo) in out.iter_mut().zip(&setup.wi).zip(&setup.wo) {
            *out = eval(&setup.scalar, *wi, *wo);
        }
    };
    Contender::new(name, COSINES, out, run, |out| out.as_flattened().to_vec())
}

fn batch(name: &'static str, backend: Backend, setup: Rc<Setup>) -> Contender {
    let out = vec![f32::NAN; 3 * setup.pairs.len()];
    let run = move |out: &mut Vec<f32>| {
        let [wi, wo] = setup.columns();
        setup.table.eval_batch(backend, wi, wo, out);
    };
    Contender::new(name, ACCURATE, out, run, Vec::clone)
}

fn single(name: &'static str, backend: Backend, setup: Rc<Setup>) -> Contender {
    let out = vec![[f32::NAN; 3]; setup.pairs.len()];
    let run = move |out: &mut Vec<[f32; 3]>| {
        for ((out, wi), wo) in out.iter_mut().zip(&setup.wi).zip(&setup.wo) {
            setup.table.eval(backend, *wi, *wo, out);
        }
    };
    Contender::new(name, ACCURATE, out, run, |out| out.as_flattened().to_vec())
}

fn paper(name: &'static str, backend: Backend, setup: Rc<Setup>) -> Contender {
    let out = [(); 3].map(|()| vec![f32::NAN; setup.pairs.len()]);
    let run = move |[r, g, b]: &mut [Vec<f32>; 3]| {
        let [wi, wo] = setup.columns();
        backend.run(setup.paper.batch(wi, wo, [r, g, b]));
    };
    let values = |[r, g, b]: &[Vec<f32>; 3]| (0..r.len()).flat_map(|i| [r[i], g[i], b[i]]).collect();
    Contender::new(name, FOUR_TERMS, out, run, values)
}
