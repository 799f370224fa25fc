//! Complete evaluations of tables larger than the caches, in single and in half precision.

use std::rc::Rc;

use lobe::table::specular::reference;
use lobe::{Directions, Edges, Precision, specular};

use super::{Contender, Contest, Tolerance, backends};
use crate::baseline::{self, ScalarTable};
use crate::tables;
use crate::workload::{Input, Pairs};

// Smooth tables, whose values change by 0.4 per radian: an error of an angle is an error of about that size.

/// Angles within 4e-7 rad, and rounding.
const SINGLE: Tolerance = Tolerance { max: 2e-6, rms: 2e-7 };
/// Eleven bits of each value.
const HALF: Tolerance = Tolerance { max: 5e-4, rms: 2e-4 };
/// Arc cosines of rounded cosines, up to 5e-4 rad off near the peak.
const COSINES: Tolerance = Tolerance { max: 5e-4, rms: 1e-5 };

/// Isotropic, 90 x 90 x 180.
pub fn iso(input: Input, count: usize) -> Contest {
    contest(&tables::large(), input, count)
}

/// Anisotropic, 16 x 36 x 90 x 108.
pub fn aniso(input: Input, count: usize) -> Contest {
    contest(&tables::large_anisotropic(), input, count)
}

fn contest(samples: &specular::Data, input: Input, count: usize) -> Contest {
    let pairs = Rc::new(input.pairs(count));
    let (wi, wo) = pairs.vectors();
    let mut expected = vec![0.0; 3 * count];
    for ((wi, wo), out) in wi.iter().zip(&wo).zip(expected.chunks_exact_mut(3)) {
        reference::eval(samples, &Edges::default(), wi.map(f64::from), wo.map(f64::from), out);
    }
    let scalar = ScalarTable::new(samples);
    let run = move |out: &mut Vec<[f32; 3]>| {
        for ((out, wi), wo) in out.iter_mut().zip(&wi).zip(&wo) {
            *out = baseline::libm::eval(&scalar, *wi, *wo);
        }
    };
    let baseline = Contender::new("libm", COSINES, vec![[f32::NAN; 3]; count], run, |out| out.as_flattened().to_vec());
    let single = batches(samples, Precision::Single, &pairs);
    let half = batches(samples, Precision::Half, &pairs);
    Contest { count, baselines: vec![baseline], contenders: single.into_iter().chain(half).collect(), expected }
}

/// The backends in their fastest forms, with one table in this precision.
fn batches(samples: &specular::Data, precision: Precision, pairs: &Rc<Pairs>) -> Vec<Contender> {
    let table =
        specular::Table::with_precision(samples, &Edges::default(), precision).expect("a table that can be indexed");
    let table = Rc::new(table);
    let fastest = backends().into_iter().filter(|named| !named.name.ends_with("-strict"));
    let contender = |named: super::Named| {
        let (table, pairs) = (table.clone(), pairs.clone());
        let out = vec![f32::NAN; 3 * pairs.len()];
        let run = move |out: &mut Vec<f32>| {
            let [wi, wo] = [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z));
            table.eval_batch(named.backend, wi, wo, out);
        };
        let (name, tolerance) = match precision {
            Precision::Single => (named.name, SINGLE),
            Precision::Half => (half(named.name), HALF),
        };
        Contender::new(name, tolerance, out, run, Vec::clone)
    };
    fastest.map(contender).collect()
}

/// The name of a backend with values in half precision. The names are few, and live as long as the program.
fn half(backend: &'static str) -> &'static str {
    format!("{backend}-f16").leak()
}
