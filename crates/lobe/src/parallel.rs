//! The one rule by which batches are divided among threads.
//!
//! A batch of [`PARALLEL_FROM`] queries or more is split into tasks of a fixed size, which the threads of the current
//! rayon pool run (feature `rayon`). No query depends on another, so results have the same bits for any number of
//! threads.

use std::ops::Range;

use lobe_table::Sampled;

/// Batches of at least this many queries are divided among threads; for smaller ones, starting threads would cost more
/// than it saves.
pub const PARALLEL_FROM: usize = 16_384;

/// Queries per task: a few tens of microseconds of work.
#[cfg(feature = "rayon")]
const TASK: usize = 4_096;

/// Fills `out`, which has `width` elements per query, with the results of `run` for ranges of queries.
pub(crate) fn fill<T: Send>(width: usize, out: &mut [T], run: &(dyn Fn(Range<usize>, &mut [T]) + Sync)) {
    let width = width.max(1);
    let count = out.len() / width;
    #[cfg(feature = "rayon")]
    if count >= PARALLEL_FROM {
        use rayon::prelude::*;
        out.par_chunks_mut(TASK * width).enumerate().for_each(|(task, out)| {
            let from = task * TASK;
            run(from..from + out.len() / width, out);
        });
        return;
    }
    run(0..count, out);
}

/// Fills two outputs for a range of queries.
type BothTask<'a, T, U> = dyn Fn(Range<usize>, &mut [T], &mut [U]) + Sync + 'a;

/// Like [`fill`], with two outputs, the first with `width` elements per query, and the second with one.
pub(crate) fn fill_both<T: Send, U: Send>(width: usize, first: &mut [T], second: &mut [U], run: &BothTask<'_, T, U>) {
    #[cfg(feature = "rayon")]
    if second.len() >= PARALLEL_FROM {
        use rayon::prelude::*;
        let tasks = first.par_chunks_mut(TASK * width.max(1)).zip(second.par_chunks_mut(TASK));
        tasks.enumerate().for_each(|(task, (first, second))| {
            let from = task * TASK;
            run(from..from + second.len(), first, second);
        });
        return;
    }
    let _ = width;
    run(0..second.len(), first, second);
}

/// Like [`fill`], with samples of `channels` channels.
pub(crate) fn sample(channels: usize, out: Sampled<'_>, run: &(dyn Fn(Range<usize>, Sampled<'_>) + Sync)) {
    let count = out.directions.len();
    #[cfg(feature = "rayon")]
    if count >= PARALLEL_FROM {
        use rayon::prelude::*;
        let directions = out.directions.par_chunks_mut(TASK);
        let weights = out.weights.par_chunks_mut(TASK * channels.max(1));
        let tasks = directions.zip(weights).zip(out.pdfs.par_chunks_mut(TASK));
        tasks.enumerate().for_each(|(task, ((directions, weights), pdfs))| {
            let from = task * TASK;
            run(from..from + directions.len(), Sampled { directions, weights, pdfs });
        });
        return;
    }
    let _ = channels;
    run(0..count, out);
}
