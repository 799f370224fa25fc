//! A table and the distributions to sample it.

use std::sync::Arc;

use lobe_backend::Backend;
use lobe_colour::luminance;
use lobe_lane::{Floats, Lanes};
use thiserror::Error;

use super::budget::Budget;
use super::distribution::Distribution;
use super::given::{Given, pair};
use super::histogram::{Bin, Histogram, weigh};
use super::incident::Surface;
use super::kernels::{Sampled, Values, factor, sample};
use super::options::{DistributionError, Plan};
use crate::specular::{self, PHI, PSI, SIGMA, THETA};

/// The options for building a sampler.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplerOptions {
    /// The share of a cosine distribution in every slice, in `(0, 1]`. With a share `d`, a weight is at most about `pi
    /// f / d`, and noise, if the histogram fits well, grows by `1 / (1 - d)`.
    pub defensive: f32,
    /// The weight of each channel in luminance; if `None`, as given by the function [`luminance`]. If a path is traced
    /// at a few wavelengths, those have weight.
    pub luminance: Option<Vec<f32>>,
    /// The most memory for histograms, except for the coarsest grid, if it is less than one and a half times that of
    /// the material. Building them takes up to two evaluations per byte.
    pub bytes: Option<usize>,
    /// The most values of the material to compute while building histograms, except for the coarsest grid. Few values
    /// give coarse histograms, and these give more noise.
    pub evaluations: Option<usize>,
}

impl Default for SamplerOptions {
    /// A twentieth of a cosine distribution; luminance by the kind of the channels.
    fn default() -> Self {
        SamplerOptions { defensive: 0.05, luminance: None, bytes: None, evaluations: None }
    }
}

/// A sampler that cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SamplerError {
    /// The distribution cannot be built.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// Luminance weights that do not match the channels, or are negative, not finite, or all 0.
    #[error("luminance weights {found:?}; expected {channels}, not negative, finite and not all 0")]
    Luminance {
        /// What was found.
        found: Vec<f32>,
        /// The number of channels of the table.
        channels: usize,
    },
}

/// A table and the distributions to sample directions in proportion to luminance times f times cosine.
///
/// As in a [`specular::Table`], `wi` points to the light and `wo` to the viewer, unit vectors, normal on +z. Sampled
/// directions of a reflection table have `z > 0`; those of a transmission table are on the other side of the surface.
/// Densities are per steradian. In strict form, samples have the same bits on every backend.
#[derive(Clone, Debug)]
pub struct Sampler {
    table: Arc<specular::Table>,
    distribution: Distribution,
}

impl Sampler {
    /// Builds the distributions of a table on a backend.
    ///
    /// They have the same bits whichever backend builds them.
    ///
    /// # Errors
    /// If the options do not apply to this table.
    pub fn new(backend: Backend, table: Arc<specular::Table>, options: &SamplerOptions) -> Result<Self, SamplerError> {
        Sampler::with_progress(backend, table, options, &mut |_, _| {})
    }

    /// Like [`new`](Sampler::new), calling `progress(done, all)` after each slice.
    ///
    /// # Errors
    /// The same as for [`new`](Sampler::new).
    pub fn with_progress(
        backend: Backend,
        table: Arc<specular::Table>,
        options: &SamplerOptions,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, SamplerError> {
        let backend = backend.strict();
        let values = |wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]| {
            table.eval_batch(backend, wi.into(), wo.into(), out);
        };
        let run = |histogram: Histogram<'_>| backend.run(histogram);
        let distribution = distribution(&table, options, &run, &values, progress)?;
        Ok(Sampler { table, distribution })
    }

    /// Like [`new`](Sampler::new), on lanes that are not a [`Backend`].
    ///
    /// # Errors
    /// The same as for [`new`](Sampler::new).
    pub fn on_lanes<L: Lanes>(
        lanes: L,
        table: Arc<specular::Table>,
        options: &SamplerOptions,
    ) -> Result<Self, SamplerError> {
        let lanes = lanes.strict();
        let values = |wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]| {
            lanes.vectorize(table.batch(wi.into(), wo.into(), out));
        };
        let run = |histogram: Histogram<'_>| lanes.vectorize(histogram);
        let distribution = distribution(&table, options, &run, &values, &mut |_, _| {})?;
        Ok(Sampler { table, distribution })
    }

    /// The table that is sampled.
    pub fn table(&self) -> &Arc<specular::Table> {
        &self.table
    }

    /// The distribution of its samples.
    pub fn distribution(&self) -> &Distribution {
        &self.distribution
    }

    /// Bytes of memory that the distributions take in addition to the table: at most one and a half times what the
    /// table takes, except for the tiniest tables.
    pub fn bytes(&self) -> usize {
        self.distribution.bytes()
    }

    /// Samples one direction from two numbers in `[0, 1)`. Returns it with its density, and sets `weight` to `f` times
    /// cosine over the density, one value per channel. If `given` is not above the surface, everything is 0.
    ///
    /// # Panics
    /// If the length of `weight` is not the number of channels.
    pub fn sample(
        &self,
        backend: Backend,
        given: Given,
        direction: [f32; 3],
        u: [f32; 2],
        weight: &mut [f32],
    ) -> ([f32; 3], f32) {
        let (mut sampled, mut pdf) = ([[0.0; 3]], [0.0]);
        let out = Sampled { directions: &mut sampled, weights: weight, pdfs: &mut pdf };
        self.sample_batch(backend, given, &[direction], &[u], out);
        (sampled[0], pdf[0])
    }

    /// The density with which [`sample`](Sampler::sample) draws the other direction of the pair. It is 0 unless the
    /// table can scatter from one to the other.
    ///
    /// Rounding can move a direction on the very edge of a cell of the histogram into the neighbouring cell, whose
    /// density may differ.
    pub fn pdf(&self, backend: Backend, given: Given, wi: [f32; 3], wo: [f32; 3]) -> f32 {
        let mut pdf = [0.0];
        self.pdf_batch(backend, given, &[wi], &[wo], &mut pdf);
        pdf[0]
    }

    /// Samples one direction for each given direction, as [`sample`](Sampler::sample).
    ///
    /// # Panics
    /// If `u` or a field of `out` does not have one entry per direction, or the weights do not have one per direction
    /// and channel.
    pub fn sample_batch(
        &self,
        backend: Backend,
        given: Given,
        directions: &[[f32; 3]],
        u: &[[f32; 2]],
        out: Sampled<'_>,
    ) {
        self.check(directions, u, &out);
        let draw = |known: &[[f32; 3]], u: &[[f32; 2]], directions: &mut [[f32; 3]], pdfs: &mut [f32]| {
            self.distribution.draw_batch(backend, known, u, directions, pdfs);
        };
        let values = |wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]| {
            self.table.eval_batch(backend, wi.into(), wo.into(), out);
        };
        sample(&draw, &values, given, directions, u, out);
    }

    /// Like [`sample_batch`](Self::sample_batch), on lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// The same as for [`sample_batch`](Self::sample_batch).
    pub fn sample_on_lanes<L: Lanes>(
        &self,
        lanes: L,
        given: Given,
        directions: &[[f32; 3]],
        u: &[[f32; 2]],
        out: Sampled<'_>,
    ) {
        self.check(directions, u, &out);
        let draw = |known: &[[f32; 3]], u: &[[f32; 2]], directions: &mut [[f32; 3]], pdfs: &mut [f32]| {
            lanes.vectorize(self.distribution.drawing(known, u, directions, pdfs));
        };
        let values = |wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]| {
            lanes.vectorize(self.table.batch(wi.into(), wo.into(), out));
        };
        sample(&draw, &values, given, directions, u, out);
    }

    /// # Panics
    /// If there is not one of each per direction, or one weight per direction and channel.
    fn check(&self, directions: &[[f32; 3]], u: &[[f32; 2]], out: &Sampled<'_>) {
        let count = directions.len();
        assert_eq!(u.len(), count, "a pair of numbers per direction");
        assert_eq!((out.directions.len(), out.pdfs.len()), (count, count), "an output per direction");
        assert_eq!(out.weights.len(), count * self.table.channel_count(), "a weight per direction and channel");
    }

    /// The densities of many pairs, as [`pdf`](Sampler::pdf).
    ///
    /// # Panics
    /// If the numbers of `wi`, `wo` and `pdfs` differ.
    pub fn pdf_batch(&self, backend: Backend, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        let (known, other) = pair(given, wi, wo);
        self.distribution.pdf_batch(backend, known, other, pdfs);
    }

    /// Samples a direction in each lane inside a caller's own kernel, as [`sample`](Sampler::sample); 0 in the lanes
    /// that `mask` leaves out.
    ///
    /// # Panics
    /// If the length of `weight` is not the number of channels.
    #[inline(always)]
    pub fn sample_lanes<L: Lanes>(
        &self,
        lanes: L,
        given: Given,
        direction: [L::F; 3],
        u: [L::F; 2],
        mask: L::M,
        weight: &mut [L::F],
    ) -> ([L::F; 3], L::F) {
        let (sampled, pdf) = self.distribution.draw_lanes(lanes, direction, u, mask);
        let (wi, wo) = pair(given, direction, sampled);
        self.table.eval_lanes(lanes, wi, wo, mask, weight);
        let factor = factor(lanes, sampled[2], pdf);
        let mut channel = 0;
        while channel < weight.len() {
            weight[channel] = weight[channel] * factor;
            channel += 1;
        }
        (sampled, pdf)
    }

    /// The density of a pair per lane inside a caller's own kernel, as [`pdf`](Sampler::pdf); 0 in the lanes that
    /// `mask` leaves out.
    #[inline(always)]
    pub fn pdf_lanes<L: Lanes>(&self, lanes: L, given: Given, wi: [L::F; 3], wo: [L::F; 3], mask: L::M) -> L::F {
        let (known, other) = pair(given, wi, wo);
        self.distribution.pdf_lanes(lanes, known, other).masked(mask)
    }
}

/// The distribution of a table, with values from `values`, and histograms computed by `run` in strict form.
fn distribution(
    table: &specular::Table,
    options: &SamplerOptions,
    run: &dyn Fn(Histogram<'_>) -> Vec<Bin>,
    values: &Values<'_>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Distribution, SamplerError> {
    let channels = table.channel_count();
    let luminance = options.luminance.clone().unwrap_or_else(|| luminance(table.channels()));
    let fits = luminance.len() == channels && luminance.iter().all(|&y| y.is_finite() && y >= 0.0);
    if !fits || luminance.iter().all(|&y| y == 0.0) {
        return Err(SamplerError::Luminance { found: luminance, channels });
    }
    let surface = Surface { scatter: table.scatter(), refraction: table.refraction().cloned() };
    let plan = Plan {
        sigma: table.axes()[SIGMA].clone(),
        psi: table.is_anisotropic().then(|| table.axes()[PSI].clone()),
        theta: table.axes()[THETA].knots(),
        phis: table.axes()[PHI].knots().len(),
        bytes: (table.bytes() + table.bytes() / 2).min(options.bytes.unwrap_or(usize::MAX)),
        budget: Budget::of(options.evaluations),
        defensive: options.defensive,
    };
    let mut room = Vec::new();
    let mut light = |wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]| {
        room.resize(wi.len() * channels, 0.0);
        values(wi, wo, &mut room);
        weigh(&room, &luminance, out);
    };
    Ok(Distribution::build(run, &mut light, surface, plan, progress)?)
}
