//! The one place where the program evaluates a table.

use lobe_table::reference::eval;
use lobe_table::{Edges, Samples};

use crate::pairs::Pair;

/// `f` in 1/sr of every pair: `[pair][channel]`.
pub fn evaluate(samples: &Samples, edges: &Edges, pairs: &[Pair]) -> Vec<f32> {
    let mut texel = vec![0.0; samples.channels().count()];
    let mut values = Vec::with_capacity(pairs.len() * texel.len());
    for pair in pairs {
        eval(samples, edges, pair.wi, pair.wo, &mut texel);
        values.extend(texel.iter().map(|&value| value as f32));
    }
    values
}
