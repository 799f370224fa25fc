//! Large batches, shared among threads and compared with small ones.

use std::rc::Rc;

use lobe::table::specular::reference;
use lobe::{Backend, Buffer, Directions, Edges, Material, Options, specular};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::{Contender, Contest, Tolerance};
use crate::tables;
use crate::workload::{Input, Pairs};

/// The mean tolerance is the same as for a short batch. The nearest of a million pairs is ten times as close to the
/// mirror peak as the nearest of ten thousand, and the error of phi there is ten times as large.
const TOLERANCE: Tolerance = Tolerance { max: 2e-2, rms: 2e-5 };

/// An isotropic table, two threads compared with one; there is no contender on a machine with one core.
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

/// An isotropic table on one thread: a batch larger than the caches on huge pages and on pages of 4 KB, compared with
/// the same number of pairs in batches that stay in the caches, the same ones again and again.
pub fn pages(input: Input, count: usize) -> Contest {
    const SMALL: usize = 1 << 13;
    let samples = tables::isotropic();
    let small = input.pairs(SMALL);
    let pairs: Pairs = (0..count).map(|query| small.get(query % SMALL)).collect();
    let mut expected = vec![0.0; 3 * SMALL];
    for (query, out) in expected.chunks_exact_mut(3).enumerate() {
        let (wi, wo) = small.get(query);
        reference::eval(&samples, &Edges::default(), wi.map(f64::from), wo.map(f64::from), out);
    }
    let table = Rc::new(specular::Table::new(&samples, &Edges::default()).expect("a small table"));
    let backend = Backend::best();
    let vectors = [&pairs.wi, &pairs.wo].map(|columns| columns.each_ref().map(|column| column.to_vec()));
    let first = |out: &[f32]| out[..3 * SMALL].to_vec();
    let again = {
        let table = table.clone();
        let run = move |out: &mut Vec<f32>| {
            let [wi, wo] = [&small.wi, &small.wo].map(|[x, y, z]| Directions::columns(x, y, z));
            for _ in 0..count / SMALL {
                table.eval_batch(backend, wi, wo, out);
            }
        };
        Contender::new("8192 pairs", TOLERANCE, vec![f32::NAN; 3 * SMALL], run, move |out| first(out))
    };
    let small_pages = {
        let table = table.clone();
        let run = move |out: &mut Vec<f32>| {
            let [wi, wo] = vectors.each_ref().map(|[x, y, z]| Directions::columns(x, y, z));
            table.eval_batch(backend, wi, wo, out);
        };
        Contender::new("small pages", TOLERANCE, vec![f32::NAN; 3 * count], run, move |out| first(out))
    };
    let run = move |out: &mut Buffer<f32>| {
        let [wi, wo] = [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z));
        table.eval_batch(backend, wi, wo, out);
    };
    let out = Buffer::copied(&vec![f32::NAN; 3 * count]);
    let huge_pages = Contender::new("huge pages", TOLERANCE, out, run, move |out| first(out));
    Contest { count, baselines: vec![again], contenders: vec![huge_pages, small_pages], expected }
}

fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

fn contender(name: &'static str, pool: ThreadPool, material: &Rc<Material>, pairs: &Rc<Pairs>) -> Contender {
    let (material, pairs) = (material.clone(), pairs.clone());
    let out = Buffer::copied(&vec![f32::NAN; 3 * pairs.len()]);
    let run = move |out: &mut Buffer<f32>| {
        let [wi, wo] = [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z));
        let material: &Material = &material;
        pool.install(|| material.eval_batch(wi, wo, out));
    };
    Contender::new(name, TOLERANCE, out, run, |out| out.to_vec())
}
