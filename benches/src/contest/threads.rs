//! A large batch shared among threads.

use std::rc::Rc;

use lobe::table::specular::reference;
use lobe::{Directions, Edges, Material, Options};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::{Contender, Contest, Tolerance};
use crate::tables;
use crate::workload::{Input, Pairs};

/// On average as for a short batch. The nearest of a million pairs is ten times as near to the mirror peak as that of
/// ten thousand, and the error of phi there is ten times as large.
const TOLERANCE: Tolerance = Tolerance { max: 2e-2, rms: 2e-5 };

/// Isotropic, two threads compared with one; no contender on a machine with one core.
pub fn iso(input: Input, count: usize) -> Contest {
    let samples = tables::isotropic();
    let pairs = Rc::new(input.pairs(count));
    let mut expected = vec![0.0; 3 * count];
    for (query, out) in expected.chunks_exact_mut(3).enumerate() {
        let (wi, wo) = pairs.get(query);
        reference::eval(&samples, &Edges::default(), wi.map(f64::from), wo.map(f64::from), out);
    }
    let material = Rc::new(Material::from_samples(samples, &Options::default()).expect("a small table and a backend"));
    let two = std::thread::available_parallelism().is_ok_and(|cores| cores.get() > 1);
    Contest {
        count,
        baselines: vec![contender("1 thread", pool(1), &material, &pairs)],
        contenders: two.then(|| contender("2 threads", pool(2), &material, &pairs)).into_iter().collect(),
        expected,
    }
}

fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

fn contender(name: &'static str, pool: ThreadPool, material: &Rc<Material>, pairs: &Rc<Pairs>) -> Contender {
    let (material, pairs) = (material.clone(), pairs.clone());
    let out = vec![f32::NAN; 3 * pairs.len()];
    let run = move |out: &mut Vec<f32>| {
        let [wi, wo] = [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z));
        let material: &Material = &material;
        pool.install(|| material.eval_batch(wi, wo, out));
    };
    Contender::new(name, TOLERANCE, out, run, Vec::clone)
}
