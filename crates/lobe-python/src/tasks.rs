//! Splits batches into tasks for the threads of this process.

use std::sync::atomic::{AtomicUsize, Ordering};

use lobe::{Directions, Given, PARALLEL_FROM, Sampled, Sampler};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::batches::Source;
use crate::threads;

/// Queries per task: copies of their directions stay in the second-level cache.
const TASK: usize = 4096;

/// Fills `out`, which has `width` numbers per query, with the results of `work` for pairs of directions.
///
/// # Errors
/// The same as for [`threads::batches`].
pub fn evaluate(
    py: Python<'_>,
    [wi, wo]: [&Source<'_, 3>; 2],
    width: usize,
    out: &mut [f32],
    work: &(dyn Fn(Directions<'_>, Directions<'_>, &mut [f32]) + Sync),
) -> PyResult<()> {
    let run = |[room_i, room_o]: &mut [Vec<[f32; 3]>; 2], from: usize, out: &mut [f32]| {
        let range = from..from + out.len() / width;
        work(wi.directions(range.clone(), room_i), wo.directions(range, room_o), out);
    };
    threads::batches(py, wi.count(), |part| {
        let out = &mut out[part.start * width..part.end * width];
        // Vectors that are read in place need no tasks here, because evaluation has its own.
        if part.len() < PARALLEL_FROM || wi.is_near() && wo.is_near() {
            return run(&mut Default::default(), part.start, out);
        }
        let tasks = out.par_chunks_mut(TASK * width).enumerate();
        tasks.for_each_init(Default::default, |room, (task, out)| run(room, part.start + task * TASK, out));
    })
}

/// Samples a direction for each of `known` from the numbers `u`, into `out`. If numbers are not in [0, 1), returns the
/// index of the first such pair, and samples nothing near it.
///
/// # Errors
/// The same as for [`threads::batches`].
pub fn sample(
    py: Python<'_>,
    sampler: &Sampler,
    given: Given,
    known: &Source<'_, 3>,
    u: &Source<'_, 2>,
    out: Sampled<'_>,
) -> PyResult<Option<usize>> {
    let width = sampler.material().channel_count();
    let Sampled { directions, weights, pdfs } = out;
    let unfit = AtomicUsize::new(usize::MAX);
    let run = |(room_w, room_u): &mut (Vec<[f32; 3]>, Vec<[f32; 2]>), from: usize, out: Sampled<'_>| {
        let range = from..from + out.pdfs.len();
        let u = u.draws(range.clone(), room_u);
        match u.iter().position(|u| !u.iter().all(|u| (0.0..1.0).contains(u))) {
            Some(index) => drop(unfit.fetch_min(from + index, Ordering::Relaxed)),
            None => sampler.sample_batch(given, known.rows(range, room_w), u, out),
        }
    };
    threads::batches(py, known.count(), |part| {
        let directions = &mut directions[part.clone()];
        let weights = &mut weights[part.start * width..part.end * width];
        let pdfs = &mut pdfs[part.clone()];
        if part.len() < PARALLEL_FROM {
            return run(&mut Default::default(), part.start, Sampled { directions, weights, pdfs });
        }
        let tasks = directions.par_chunks_mut(TASK).zip(weights.par_chunks_mut(TASK * width));
        let tasks = tasks.zip(pdfs.par_chunks_mut(TASK)).enumerate();
        tasks.for_each_init(Default::default, |room, (task, ((directions, weights), pdfs))| {
            run(room, part.start + task * TASK, Sampled { directions, weights, pdfs });
        });
    })?;
    let unfit = unfit.into_inner();
    Ok((unfit != usize::MAX).then_some(unfit))
}
