//! Whole evaluations of tables of many wavelengths, most of whose time goes into moving texels.

use std::rc::Rc;

use lobe::table::specular::reference;
use lobe::{Channels, Directions, Edges, specular};

use super::{Contender, Contest, Tolerance, angles, backends};
use crate::baseline::libm::locate;
use crate::tables;
use crate::workload::Input;

/// Random tables of the paper's size, as in `evaluation`.
const ACCURATE: Tolerance = Tolerance { max: 2e-3, rms: 2e-5 };

/// Every 10 nm of visible light.
pub fn visible(input: Input, count: usize) -> Contest {
    contest(input, count, (0..31).map(|k| 400.0 + 10.0 * f64::from(k)).collect())
}

/// As many wavelengths as the spectral files of the EPFL database have.
pub fn full(input: Input, count: usize) -> Contest {
    contest(input, count, (0..195).map(|k| 360.0 + 3.3 * f64::from(k)).collect())
}

fn contest(input: Input, count: usize, nanometres: Vec<f64>) -> Contest {
    let samples = Rc::new(tables::random([7, 1, 8, 13], Channels::Spectral(nanometres)));
    let width = samples.channels().count();
    let pairs = Rc::new(input.pairs(count));
    let (wi, wo) = pairs.vectors();
    let in_f64 = {
        let samples = samples.clone();
        move |out: &mut Vec<f64>| {
            for ((wi, wo), out) in wi.iter().zip(&wo).zip(out.chunks_exact_mut(width)) {
                reference::eval(&samples, &Edges::default(), wi.map(f64::from), wo.map(f64::from), out);
            }
        }
    };
    let mut expected = vec![0.0; width * count];
    in_f64(&mut expected);
    let one_by_one = Contender::new("f64", ACCURATE, vec![f64::NAN; width * count], in_f64, |out| {
        out.iter().map(|&value| value as f32).collect()
    });
    let table = Rc::new(specular::Table::new(&samples, &Edges::default()).expect("a small table"));
    let contenders = backends().into_iter().map(|named| {
        let (table, pairs) = (table.clone(), pairs.clone());
        let run = move |out: &mut Vec<f32>| {
            let [wi, wo] = [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z));
            table.eval_batch(named.backend, wi, wo, out);
        };
        Contender::new(named.name, ACCURATE, vec![f32::NAN; width * count], run, Vec::clone)
    });
    let contenders = contenders.collect();
    Contest { count, baselines: vec![one_by_one, copies(&samples, input, count)], contenders, expected }
}

/// Copies the eight texels of each query, whose places are known, and the first of them to the output: as many bytes as
/// an evaluation reads and writes.
fn copies(samples: &specular::Data, input: Input, count: usize) -> Contender {
    let width = samples.channels().count();
    let nodes = samples.knots().each_ref().map(Vec::len);
    let knots = samples.knots().each_ref().map(|knots| knots.iter().map(|&x| x as f32).collect::<Vec<f32>>());
    let [sigma, _, theta, phi] = angles(input, count);
    // The lower of two neighbours along phi, whose texels are side by side.
    let mut rows: Vec<[usize; 4]> = Vec::with_capacity(count);
    for query in 0..count {
        let [a, b, c] =
            [(0, sigma[query]), (2, theta[query]), (3, phi[query])].map(|(axis, angle)| locate(&knots[axis], angle).0);
        let row = |sigma: usize, theta: usize| ((sigma * nodes[2] + theta) * nodes[3] + c) * width;
        rows.push([row(a, b), row(a, b + 1), row(a + 1, b), row(a + 1, b + 1)]);
    }
    let texels = samples.values().to_vec();
    let mut copy = vec![0.0f32; 8 * width];
    let run = move |out: &mut Vec<f32>| {
        for (rows, out) in rows.iter().zip(out.chunks_exact_mut(width)) {
            for (&row, copy) in rows.iter().zip(copy.chunks_exact_mut(2 * width)) {
                copy.copy_from_slice(&texels[row..row + 2 * width]);
            }
            std::hint::black_box(&mut copy);
            out.copy_from_slice(&copy[..width]);
        }
    };
    Contender::new("memcpy", Contender::UNCHECKED, vec![f32::NAN; width * count], run, Vec::clone)
}
