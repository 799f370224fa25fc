//! Samples of a table with their weights.

use lobe_lane::{Floats, Lanes};

use super::given::{Given, pair};
use crate::passes::block::BLOCK;

/// The outputs of a batch of samples.
#[derive(Debug)]
pub struct Sampled<'a> {
    /// The sampled directions.
    pub directions: &'a mut [[f32; 3]],
    /// `f` times cosine over density, `weights[query * channels + channel]`.
    pub weights: &'a mut [f32],
    /// The densities, per steradian.
    pub pdfs: &'a mut [f32],
}

impl Sampled<'_> {
    /// Turns values of `f`, stored in place of the weights, into weights: times cosine over density. There must be a
    /// whole number of weights per direction.
    pub fn times_cosine_over_density(&mut self) {
        let channels = self.weights.len().checked_div(self.directions.len()).unwrap_or(0);
        weigh(self.weights, channels.max(1), self.directions, self.pdfs);
    }
}

/// Turns values into weights: times cosine over density, or 0 if the density is 0.
fn weigh(values: &mut [f32], channels: usize, directions: &[[f32; 3]], pdfs: &[f32]) {
    for ((texel, direction), &pdf) in values.chunks_exact_mut(channels).zip(directions).zip(pdfs) {
        let factor = if 0.0 < pdf { direction[2].abs() / pdf } else { 0.0 };
        for value in texel {
            *value *= factor;
        }
    }
}

/// The factor from `f` to a weight: cosine over density, or 0 if the density is 0.
#[inline(always)]
pub(super) fn factor<L: Lanes>(lanes: L, z: L::F, pdf: L::F) -> L::F {
    (z.abs() / pdf).masked(lanes.splat(0.0).lt(pdf))
}

/// Draws directions and densities from the known directions and random numbers.
pub(super) type Draw<'a> = dyn Fn(&[[f32; 3]], &[[f32; 2]], &mut [[f32; 3]], &mut [f32]) + 'a;

/// Evaluates a table: `[pair][channel]`.
pub(super) type Values<'a> = dyn Fn(&[[f32; 3]], &[[f32; 3]], &mut [f32]) + 'a;

/// The number of queries per step of drawing and evaluating: few enough that their directions stay in the first-level
/// cache.
const CHUNK: usize = 8 * BLOCK;

/// All samples of a batch, with directions from `draw` and `f` from `values`, each of which enters the backend.
pub(super) fn sample(
    draw: &Draw<'_>,
    values: &Values<'_>,
    given: Given,
    known: &[[f32; 3]],
    u: &[[f32; 2]],
    out: Sampled<'_>,
) {
    let channels = out.weights.len().checked_div(known.len()).unwrap_or(0);
    let mut at = 0;
    while at < known.len() {
        let end = known.len().min(at + CHUNK);
        let (sampled, pdfs) = (&mut out.directions[at..end], &mut out.pdfs[at..end]);
        draw(&known[at..end], &u[at..end], sampled, pdfs);
        let weights = &mut out.weights[at * channels..end * channels];
        let (wi, wo) = pair(given, &known[at..end], &*sampled);
        values(wi, wo, weights);
        weigh(weights, channels, sampled, pdfs);
        at = end;
    }
}
