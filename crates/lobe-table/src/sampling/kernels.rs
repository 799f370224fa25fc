//! Samples of a table with their weights.

use lobe_lane::{Floats, Kernel, Lanes};

use super::distribution::{self, load};
use super::{Given, Sampler};
use crate::passes::block::BLOCK;

/// Where the samples of a batch go.
#[derive(Debug)]
pub struct Sampled<'a> {
    /// The sampled directions.
    pub directions: &'a mut [[f32; 3]],
    /// `f` times cosine over density, `weights[query * channels + channel]`.
    pub weights: &'a mut [f32],
    /// The densities, per steradian.
    pub pdfs: &'a mut [f32],
}

/// What `f` times becomes a weight: cosine over density, 0 where the density is.
#[inline(always)]
pub(super) fn factor<L: Lanes>(lanes: L, z: L::F, pdf: L::F) -> L::F {
    (z.abs() / pdf).masked(lanes.splat(0.0).lt(pdf))
}

/// `(wi, wo)` from the known and the other direction, and the other way round.
#[inline(always)]
pub(super) fn pair<T>(given: Given, known: T, other: T) -> (T, T) {
    match given {
        Given::Light => (known, other),
        Given::Viewer => (other, known),
    }
}

/// All samples of a batch.
pub(super) struct Draws<'a> {
    pub(super) sampler: &'a Sampler,
    pub(super) given: Given,
    pub(super) directions: &'a [[f32; 3]],
    pub(super) u: &'a [[f32; 2]],
    pub(super) out: Sampled<'a>,
}

/// Queries between the two halves of the work: few enough that their directions stay in the first cache.
const CHUNK: usize = 8 * BLOCK;

impl Kernel for Draws<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Draws { sampler, given, directions, u, out } = self;
        let channels = sampler.table.channel_count();
        let mut factors = [0.0f32; CHUNK];
        let mut at = 0;
        while at < directions.len() {
            let n = CHUNK.min(directions.len() - at);
            let known = &directions[at..][..n];
            let sampled = &mut out.directions[at..][..n];
            let pdfs = &mut out.pdfs[at..][..n];
            let u = &u[at..][..n];
            let draws =
                distribution::Draws { distribution: &sampler.distribution, known, u, directions: sampled, pdfs };
            draws.run(lanes);
            let sampled = &out.directions[at..][..n];
            fill_factors(lanes, sampled, &out.pdfs[at..][..n], &mut factors);
            let weights = &mut out.weights[at * channels..][..n * channels];
            let (wi, wo) = pair(given, known, sampled);
            sampler.table.batch(wi.into(), wo.into(), weights).run(lanes);
            scale(&factors[..n], weights);
            at += n;
        }
    }
}

/// Values to weights.
#[inline(always)]
fn scale(factors: &[f32], weights: &mut [f32]) {
    let channels = weights.len() / factors.len();
    let mut query = 0;
    while query < factors.len() {
        let texel = &mut weights[query * channels..][..channels];
        let mut channel = 0;
        while channel < channels {
            texel[channel] *= factors[query];
            channel += 1;
        }
        query += 1;
    }
}

/// What makes a weight of each `f`.
#[inline(always)]
fn fill_factors<L: Lanes>(lanes: L, directions: &[[f32; 3]], pdfs: &[f32], factors: &mut [f32; CHUNK]) {
    let mut at = 0;
    while at < directions.len() {
        let end = directions.len().min(at + L::LANES);
        let [_, _, z] = load(lanes, &directions[at..end]);
        lanes.store_partial(&mut factors[at..end], factor(lanes, z, lanes.load_partial(&pdfs[at..end])));
        at = end;
    }
}
