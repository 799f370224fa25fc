//! Sampling and densities in lanes, and the loops over them.

use lobe_lane::{Floats, Kernel, Lanes};

use super::incident::{Incident, Local};
use super::slices::{Draw, Place};
use super::{Given, Sampler, block};
use crate::Table;
use crate::axis::Axis;
use crate::layout::{PSI, SIGMA};
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

/// The cell of an angle and how far into it, never outside.
#[inline(always)]
fn cell<L: Lanes>(lanes: L, axis: &Axis, angle: L::F) -> (L::I, L::F) {
    let cell = axis.cell(lanes, axis.bring_inside(lanes, angle));
    (cell.index, cell.fraction.max(lanes.splat(0.0)).min(lanes.splat(1.0)))
}

/// The slices about an incident direction, in the angles that the table interpolates in.
#[inline(always)]
pub(super) fn place<L: Lanes>(lanes: L, table: &Table, incident: &Incident<L>) -> Place<L> {
    let one = lanes.splat(1.0);
    let rest = incident.sin2 / (one + incident.cos);
    let (sigma, up) = cell(lanes, &table.axes[SIGMA], lobe_math::acos_from(lanes, incident.cos, rest));
    let down = one - up;
    if !table.is_anisotropic() {
        let zero = lanes.splat(0.0);
        return Place { block: sigma, weights: [down, up, zero, zero] };
    }
    let [cos_psi, sin_psi] = incident.psi;
    let (psi, on) = cell(lanes, &table.axes[PSI], lobe_math::azimuth(lanes, sin_psi, cos_psi));
    let back = one - on;
    let block = sigma * lanes.splat_int(table.axes[PSI].cells().len() as i32) + psi;
    Place { block, weights: [down * back, down * on, up * back, up * on] }
}

/// A direction and its density; zeros where `direction` is none above the surface and where `mask` leaves out.
#[inline(always)]
pub(super) fn draw<L: Lanes>(
    lanes: L,
    sampler: &Sampler,
    direction: [L::F; 3],
    u: [L::F; 2],
    mask: L::M,
) -> ([L::F; 3], L::F) {
    let Sampler { table, slices } = sampler;
    let incident = Incident::new(lanes, table, direction);
    let place = place(lanes, table, &incident);
    let draw = match slices.width {
        2 => slices.pairs().draw(lanes, &place, u),
        _ => slices.quads().draw(lanes, &place, u),
    };
    leave(lanes, &incident, draw, mask)
}

/// From a sample of the slices to a direction and its density; zeros as [`draw`].
#[inline(always)]
pub(super) fn leave<L: Lanes>(lanes: L, incident: &Incident<L>, draw: Draw<L>, mask: L::M) -> ([L::F; 3], L::F) {
    let (sin, cos) = lobe_math::sin_cos(lanes, draw.phi);
    let height = incident.height(lanes, cos);
    let valid = incident.valid & mask;
    let sampled = incident.direction(lanes, draw.v * height, [cos, sin]).map(|x| x.masked(valid));
    (sampled, (draw.density / height).masked(valid))
}

/// The density of `other` given `known`; 0 where one of them is none above the surface.
#[inline(always)]
pub(super) fn density<L: Lanes>(lanes: L, sampler: &Sampler, known: [L::F; 3], other: [L::F; 3]) -> L::F {
    let Sampler { table, slices } = sampler;
    let incident = Incident::new(lanes, table, known);
    let place = place(lanes, table, &incident);
    let Local { v, phi, height, valid } = incident.locate(lanes, other);
    let density = match slices.width {
        2 => slices.pairs().density(lanes, &place, v, phi),
        _ => slices.quads().density(lanes, &place, v, phi),
    };
    (density / height).masked(valid)
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

/// One sample.
pub(super) struct One<'a> {
    pub(super) sampler: &'a Sampler,
    pub(super) given: Given,
    pub(super) direction: [f32; 3],
    pub(super) u: [f32; 2],
    pub(super) weight: &'a mut [f32],
}

impl Kernel for One<'_> {
    type Out = ([f32; 3], f32);

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> ([f32; 3], f32) {
        let One { sampler, given, direction, u, weight } = self;
        let [known, u] = [direction, [u[0], u[1], 0.0]].map(|x| x.map(|x| lanes.splat(x)));
        let (sampled, pdf) = draw(lanes, sampler, known, [u[0], u[1]], lanes.first_n(L::LANES));
        let factor = lanes.extract(factor(lanes, sampled[2], pdf), 0);
        let sampled = sampled.map(|x| lanes.extract(x, 0));
        let (wi, wo) = pair(given, direction, sampled);
        sampler.table.single(wi, wo, weight).run(lanes);
        let mut channel = 0;
        while channel < weight.len() {
            weight[channel] *= factor;
            channel += 1;
        }
        (sampled, lanes.extract(pdf, 0))
    }
}

/// One density.
pub(super) struct OneDensity<'a> {
    pub(super) sampler: &'a Sampler,
    pub(super) given: Given,
    pub(super) wi: [f32; 3],
    pub(super) wo: [f32; 3],
}

impl Kernel for OneDensity<'_> {
    type Out = f32;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> f32 {
        let [wi, wo] = [self.wi, self.wo].map(|w| w.map(|x| lanes.splat(x)));
        let (known, other) = pair(self.given, wi, wo);
        lanes.extract(density(lanes, self.sampler, known, other), 0)
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
            let mut from = 0;
            while from < n {
                let end = n.min(from + BLOCK);
                let (known, u) = (&known[from..end], &u[at + from..at + end]);
                let out = block::Out {
                    directions: &mut sampled[from..end],
                    pdfs: &mut pdfs[from..end],
                    factors: &mut factors[from..end],
                };
                match sampler.slices.width {
                    2 => block::draw(lanes, &sampler.table, &sampler.slices.pairs(), (known, u), out),
                    _ => block::draw(lanes, &sampler.table, &sampler.slices.quads(), (known, u), out),
                }
                from = end;
            }
            let weights = &mut out.weights[at * channels..][..n * channels];
            let (wi, wo) = pair(given, known, &*sampled);
            sampler.table.batch(wi, wo, weights).run(lanes);
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

/// All densities of a batch.
pub(super) struct Densities<'a> {
    pub(super) sampler: &'a Sampler,
    pub(super) given: Given,
    pub(super) wi: &'a [[f32; 3]],
    pub(super) wo: &'a [[f32; 3]],
    pub(super) pdfs: &'a mut [f32],
}

impl Kernel for Densities<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Densities { sampler, given, wi, wo, pdfs } = self;
        let mut at = 0;
        while at < pdfs.len() {
            let end = pdfs.len().min(at + L::LANES);
            let [wi, wo] = [wi, wo].map(|w| load(lanes, &w[at..end]));
            let (known, other) = pair(given, wi, wo);
            lanes.store_partial(&mut pdfs[at..end], density(lanes, sampler, known, other));
            at = end;
        }
    }
}

/// Up to a register of vectors, zeros behind them.
#[inline(always)]
fn load<L: Lanes>(lanes: L, vectors: &[[f32; 3]]) -> [L::F; 3] {
    if vectors.len() >= L::LANES {
        return lanes.load_xyz(vectors);
    }
    let mut padded = [[0.0; 3]; lobe_lane::MAX_LANES];
    padded[..vectors.len()].copy_from_slice(vectors);
    lanes.load_xyz(&padded)
}
