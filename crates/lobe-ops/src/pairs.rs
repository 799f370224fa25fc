//! Evaluation of pairs of directions in `f64`.

use lobe_table::bsdf::OnBackend;

/// Evaluates pairs of directions that are `f64`.
pub(crate) fn eval_pairs<'a>(bsdf: impl Into<OnBackend<'a>>, pairs: &[([f64; 3], [f64; 3])]) -> Vec<f32> {
    let bsdf = bsdf.into();
    let narrow = |direction: [f64; 3]| direction.map(|c| c as f32);
    let (wi, wo): (Vec<_>, Vec<_>) = pairs.iter().map(|&(wi, wo)| (narrow(wi), narrow(wo))).unzip();
    let mut out = vec![0.0; pairs.len() * bsdf.channels().count()];
    bsdf.eval_batch(&wi, &wo, &mut out);
    out
}
