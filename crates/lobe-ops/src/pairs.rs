//! Evaluation of pairs of directions in `f64`.

use lobe_table::bsdf::OnBackend;
use rayon::prelude::*;

/// The number of pairs that are worth a task.
const TASK: usize = 2048;

/// Evaluates pairs of directions that are `f64`, on all threads.
pub(crate) fn eval_pairs<'a>(bsdf: impl Into<OnBackend<'a>>, pairs: &[([f64; 3], [f64; 3])]) -> Vec<f32> {
    let bsdf = bsdf.into();
    let narrow = |direction: [f64; 3]| direction.map(|c| c as f32);
    let channels = bsdf.channels().count();
    let mut out = vec![0.0; pairs.len() * channels];
    out.par_chunks_mut(TASK * channels).zip(pairs.par_chunks(TASK)).for_each(|(out, pairs)| {
        let (wi, wo): (Vec<_>, Vec<_>) = pairs.iter().map(|&(wi, wo)| (narrow(wi), narrow(wo))).unzip();
        bsdf.eval_batch(&wi, &wo, out);
    });
    out
}
