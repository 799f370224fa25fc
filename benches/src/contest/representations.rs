//! Representations other than specular tables, in lanes, compared with their `f64` reference one pair at a time.

use std::rc::Rc;

use lobe::table::half_diff::{self, Lookup};
use lobe::table::window::tensor_tree::Rank;
use lobe::table::{mueller, polarised, scattered, spherical, utia, window};
use lobe::{Backend, Decode, Directions, Edges, specular};

use super::{Contender, Contest, Tolerance, backends};
use crate::tables;
use crate::workload::{Input, Pairs};

/// Tolerance for cells that are selected and not interpolated: the stored value.
const STORED: Tolerance = Tolerance { max: 1e-7, rms: 1e-7 };
/// Tolerance for interpolated values, of queries whose bound is at most this.
const LINEAR: Tolerance = Tolerance { max: SURE, rms: 2e-5 };
const SURE: f64 = 5e-4;

/// The function that answers a query in `f64`.
type One = dyn Fn([f64; 3], [f64; 3], &mut [f64]);
/// The function that answers all queries on a backend.
type All = dyn Fn(Backend, [Directions<'_>; 2], &mut [f32]);

/// RGB of the nearest bin of a table of the size of the MERL database.
pub fn half_difference(input: Input, count: usize) -> Contest {
    let data = Rc::new(tables::half_difference([90, 90, 180]));
    let table = half_diff::Table::new(&data).expect("a grid that lanes can index");
    let one = data.clone();
    contest(
        (input, count, 3, STORED),
        move |wi, wo| data.candidates(wi, wo).len() == 1,
        Rc::new(move |wi, wo, out| out.copy_from_slice(&one.eval_nearest(wi, wo))),
        Rc::new(move |backend, [wi, wo], out| table.eval_batch(backend, Lookup::Nearest, wi, wo, out)),
    )
}

/// The same table, interpolated between the centres of its bins.
pub fn half_difference_linear(input: Input, count: usize) -> Contest {
    let data = Rc::new(tables::half_difference([90, 90, 180]));
    let table = half_diff::Table::new(&data).expect("a grid that lanes can index");
    let one = data.clone();
    contest(
        (input, count, 3, LINEAR),
        move |wi, wo| data.bound(wi, wo) < SURE,
        Rc::new(move |wi, wo, out| out.copy_from_slice(&one.eval_linear(wi, wo))),
        Rc::new(move |backend, [wi, wo], out| table.eval_batch(backend, Lookup::Linear, wi, wo, out)),
    )
}

/// RGB of half a grid in spherical coordinates.
pub fn spherical(input: Input, count: usize) -> Contest {
    let data = Rc::new(tables::spherical());
    let table = spherical::Table::new(&data).expect("a small grid");
    let one = data.clone();
    contest(
        (input, count, 3, LINEAR),
        move |wi, wo| data.bound(wi, wo) < SURE,
        Rc::new(move |wi, wo, out| one.eval_into(wi, wo, out)),
        Rc::new(move |backend, [wi, wo], out| table.eval_batch(backend, wi, wo, out)),
    )
}

/// RGB of scattered samples.
pub fn scattered(input: Input, count: usize) -> Contest {
    let data = Rc::new(tables::scattered());
    let table = scattered::Table::new(&data).expect("few samples");
    let one = data.clone();
    contest(
        (input, count, 3, LINEAR),
        move |wi, wo| data.bound(wi, wo) < SURE,
        Rc::new(move |wi, wo, out| {
            let (mut sum, mut values) = ([0.0; 3], [0.0; 3]);
            one.eval_into(wi, wo, &mut sum, &mut values);
            out.copy_from_slice(&values.map(f64::from));
        }),
        Rc::new(move |backend, [wi, wo], out| table.eval_batch(backend, wi, wo, out)),
    )
}

/// RGB of the grid of the UTIA database.
pub fn utia(input: Input, count: usize) -> Contest {
    let data = Rc::new(tables::utia());
    let table = utia::Table::new(&data, Decode::Raw).expect("a valid grid");
    let one = data.clone();
    contest(
        (input, count, 3, LINEAR),
        move |wi, wo| data.bound(wi, wo) < SURE,
        Rc::new(move |wi, wo, out| out.copy_from_slice(&one.eval(wi, wo, Decode::Raw))),
        Rc::new(move |backend, [wi, wo], out| table.eval_batch(backend, wi, wo, out)),
    )
}

/// Five wavelengths of Mueller matrices, for unpolarised light.
pub fn mueller(input: Input, count: usize) -> Contest {
    let data = Rc::new(tables::mueller());
    let table = mueller::Table::new(&data).expect("a small table");
    let (one, width) = (data.clone(), table.channel_count());
    let in_f64 = move |wi, wo, out: &mut [f64]| {
        for (out, nm) in out.iter_mut().zip(&one.knots()[3]) {
            *out = one.in_plane(wi, wo, f64::from(*nm)).map_or(0.0, |matrix| matrix[0][0]);
        }
    };
    contest(
        (input, count, width, LINEAR),
        move |wi, wo| data.bound(wi, wo) < SURE,
        Rc::new(in_f64),
        Rc::new(move |backend, [wi, wo], out| table.eval_batch(backend, wi, wo, out)),
    )
}

/// Four wavelengths of whole Mueller matrices.
pub fn matrices(input: Input, count: usize) -> Contest {
    let data = Rc::new(tables::matrices());
    let table = mueller::Matrices::new(&data).expect("a small table");
    let (one, width) = (data.clone(), 16 * table.wavelength_count());
    let in_f64 = move |wi, wo, out: &mut [f64]| {
        for (out, nm) in out.chunks_exact_mut(16).zip(&one.knots()[3]) {
            out.copy_from_slice(one.eval(wi, wo, f64::from(*nm)).as_flattened());
        }
    };
    contest(
        (input, count, width, LINEAR),
        move |wi, wo| data.bound(wi, wo) + 4.0 * mueller::turned(wi, wo) < SURE,
        Rc::new(in_f64),
        Rc::new(move |backend, [wi, wo], out| table.eval_batch(backend, wi, wo, out)),
    )
}

/// The same in specular coordinates.
pub fn polarised(input: Input, count: usize) -> Contest {
    let data = Rc::new(tables::polarised());
    let edges = Edges::default();
    let table = polarised::Matrices::new(&data, &edges).expect("a small table");
    let width = 16 * table.wavelength_count();
    let in_f64 = move |wi, wo, out: &mut [f64]| {
        for (out, nm) in out.chunks_exact_mut(16).zip(data.wavelengths()) {
            out.copy_from_slice(data.eval(&edges, wi, wo, *nm).as_flattened());
        }
    };
    contest(
        (input, count, width, LINEAR),
        move |wi, wo| 4.0 * mueller::turned(wi, wo) < 0.1 * SURE,
        Rc::new(in_f64),
        Rc::new(move |backend, [wi, wo], out| table.eval_batch(backend, wi, wo, out)),
    )
}

/// One band of the full Klems basis.
pub fn klems(input: Input, count: usize) -> Contest {
    sheet(tables::klems(), input, count)
}

/// One band of a tree over two squares.
pub fn tensor_tree(input: Input, count: usize) -> Contest {
    sheet(tables::tensor_tree(Rank::Four), input, count)
}

fn sheet(window: window::Blocks, input: Input, count: usize) -> Contest {
    let table = window::Table::new(vec![window.clone()]).expect("a small sheet");
    let window = Rc::new(window);
    let one = window.clone();
    let sure = move |wi, wo| {
        let candidates = window.candidates(wi, wo);
        candidates.iter().all(|value| *value == candidates[0])
    };
    contest(
        (input, count, 1, STORED),
        sure,
        Rc::new(move |wi, wo, out| out[0] = one.eval(wi, wo)),
        Rc::new(move |backend, [wi, wo], out| table.eval_batch(backend, wi, wo, out)),
    )
}

/// Replaces queries next to the border of two cells, for which the result of lanes is not `sure`, by the preceding
/// query.
fn contest(
    (input, count, width, tolerance): (Input, usize, usize, Tolerance),
    sure: impl Fn([f64; 3], [f64; 3]) -> bool,
    one: Rc<One>,
    all: Rc<All>,
) -> Contest {
    let pairs = Rc::new(only(input.pairs(count), sure));
    let in_f64 = {
        let pairs = pairs.clone();
        move |out: &mut Vec<f64>| {
            for (query, out) in out.chunks_exact_mut(width).enumerate() {
                let (wi, wo) = pairs.get(query);
                one(unit(wi), unit(wo), out);
            }
        }
    };
    let mut expected = vec![f64::NAN; width * count];
    in_f64(&mut expected);
    let contenders = backends().into_iter().map(|named| {
        let (pairs, all) = (pairs.clone(), all.clone());
        let run = move |out: &mut Vec<f32>| {
            all(named.backend, [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z)), out);
        };
        Contender::new(named.name, tolerance, vec![f32::NAN; width * count], run, Vec::clone)
    });
    let contenders = contenders.collect();
    let baseline = Contender::new("f64", STORED, vec![f64::NAN; width * count], in_f64, |out| {
        out.iter().map(|&value| value as f32).collect()
    });
    Contest { count, baselines: vec![baseline, table(&pairs, width)], contenders, expected }
}

/// A specular table of the paper's size on the best backend, for comparison: its values are compared elsewhere.
fn table(pairs: &Rc<Pairs>, width: usize) -> Contender {
    let table = specular::Table::new(&tables::isotropic(), &Edges::default()).expect("a small table");
    let (pairs, backend, count) = (pairs.clone(), Backend::best(), pairs.len());
    let run = move |out: &mut Vec<f32>| {
        let [wi, wo] = [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z));
        table.eval_batch(backend, wi, wo, out);
    };
    let room = vec![f32::NAN; 3 * count];
    Contender::new("table", Contender::UNCHECKED, room, run, move |_| vec![0.0; width * count])
}

fn only(mut pairs: Pairs, sure: impl Fn([f64; 3], [f64; 3]) -> bool) -> Pairs {
    let is_sure = |pairs: &Pairs, at: usize| {
        let (wi, wo) = pairs.get(at);
        sure(unit(wi), unit(wo))
    };
    let mut last = (0..pairs.len()).find(|&at| is_sure(&pairs, at)).expect("a query far from any border");
    for at in 0..pairs.len() {
        if is_sure(&pairs, at) {
            last = at;
            continue;
        }
        for k in 0..3 {
            pairs.wi[k][at] = pairs.wi[k][last];
            pairs.wo[k][at] = pairs.wo[k][last];
        }
    }
    pairs
}

fn unit(w: [f32; 3]) -> [f64; 3] {
    let w = w.map(f64::from);
    let length = w.iter().map(|x| x * x).sum::<f64>().sqrt();
    w.map(|x| x / length)
}
