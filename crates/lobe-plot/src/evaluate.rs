//! Evaluation of many pairs of directions on all threads.

use lobe::Material;
use rayon::prelude::*;

/// Called with the progress of a drawing.
pub trait Progress: Sync {
    /// A figure of this many steps begins, usually pairs of directions.
    fn begin(&self, figure: &str, steps: u64);
    /// This many more steps are done.
    fn advance(&self, steps: u64);
}

/// Ignores progress.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _figure: &str, _steps: u64) {}
    fn advance(&self, _steps: u64) {}
}

/// The number of pairs per task: enough to be worth a task, and fewer than the material itself would divide among
/// threads.
const TASK: usize = 2048;

/// The value of every pair of directions, reduced from its channels to `N` numbers at once, because a picture of a
/// spectral material would not fit into memory.
pub(crate) fn evaluate<const N: usize>(
    material: &Material,
    count: usize,
    pair: impl Fn(usize) -> ([f64; 3], [f64; 3]) + Sync,
    reduce: impl Fn(&[f32]) -> [f32; N] + Sync,
    progress: &dyn Progress,
) -> Vec<[f32; N]> {
    let channels = material.channel_count();
    let mut out = vec![[0.0; N]; count];
    out.par_chunks_mut(TASK).enumerate().for_each(|(task, out)| {
        let pairs = (0..out.len()).map(|at| pair(task * TASK + at));
        let narrow = |d: [f64; 3]| d.map(|c| c as f32);
        let (wi, wo): (Vec<_>, Vec<_>) = pairs.map(|(wi, wo)| (narrow(wi), narrow(wo))).unzip();
        let mut texels = vec![0.0; wi.len() * channels];
        material.eval_batch(&wi, &wo, &mut texels);
        for (out, texel) in out.iter_mut().zip(texels.chunks_exact(channels)) {
            *out = reduce(texel);
        }
        progress.advance(out.len() as u64);
    });
    out
}
