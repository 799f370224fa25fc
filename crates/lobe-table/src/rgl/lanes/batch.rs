//! Evaluation of many pairs of directions, block by block.

use lobe_backend::Backend;
use lobe_lane::{Floats, Kernel, Lanes, call};

use super::Table;
use super::angles;
use super::frame::{self, Frame};
use super::grid::Places;
use super::invert::{self, Blend};
use crate::directions::{DirectionBlock, Directions, PADDING};
use crate::grid::cells;
use crate::grid::texels::Tile;
use crate::grid::weights::{self, MAX_CORNERS};
use crate::passes::block::{BLOCK, Column};

/// What to compute for each pair of directions, and where to put it.
#[derive(Debug)]
pub enum Wanted<'a> {
    /// `f` in 1/sr, without the cosine: `[query][channel]`.
    Values(&'a mut [f32]),
    /// `f cos(theta_o)` in 1/sr: `[query][channel]`.
    ValuesCos(&'a mut [f32]),
    /// The density of sampling `wo` for a `wi`, 1/sr, one per query.
    Pdf(&'a mut [f32]),
    /// `f`, and the density.
    ValuesAndPdf(&'a mut [f32], &'a mut [f32]),
    /// `f cos(theta_o)`, and the density.
    ValuesCosAndPdf(&'a mut [f32], &'a mut [f32]),
}

impl<'a> Wanted<'a> {
    /// Values, whether they keep the cosine, and densities.
    fn split(self) -> (Option<&'a mut [f32]>, bool, Option<&'a mut [f32]>) {
        match self {
            Wanted::Values(values) => (Some(values), false, None),
            Wanted::ValuesCos(values) => (Some(values), true, None),
            Wanted::Pdf(pdf) => (None, true, Some(pdf)),
            Wanted::ValuesAndPdf(values, pdf) => (Some(values), false, Some(pdf)),
            Wanted::ValuesCosAndPdf(values, pdf) => (Some(values), true, Some(pdf)),
        }
    }
}

impl Table {
    /// Evaluates `f` in 1/sr of many pairs on a backend: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// If there are not as many `wi` as `wo`, or `out` is not that many times the channels long.
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.evaluate(backend, wi, wo, Wanted::Values(out));
    }

    /// The density over solid angle, 1/sr, with which `wo` is sampled for `wi`, for many pairs on a backend.
    ///
    /// # Panics
    /// If there are not as many `wi` as `wo` and elements in `out`.
    pub fn pdf_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.evaluate(backend, wi, wo, Wanted::Pdf(out));
    }

    /// Evaluates `f` in 1/sr of one pair into `out`, one value per channel, on a backend.
    ///
    /// # Panics
    /// If `out` is not as long as there are channels.
    pub fn eval(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.eval_batch(backend, (&[wi]).into(), (&[wo]).into(), out);
    }

    /// Evaluates whatever is wanted of many pairs on a backend. Values and densities together take less time than one after
    /// the other.
    ///
    /// # Panics
    /// As [`batch`](Self::batch).
    pub fn evaluate(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, wanted: Wanted<'_>) {
        backend.run(self.batch(wi, wo, wanted));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// If there are not as many `wi` as `wo`, or a slice in `wanted` is not as long as that requires.
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        wanted: Wanted<'a>,
    ) -> impl Kernel<Out = ()> + 'a {
        let (values, cosine, pdf) = wanted.split();
        let count = wi.count();
        assert_eq!(count, wo.count(), "as many wi as wo");
        if let Some(values) = &values {
            assert_eq!(values.len(), count * self.channel_count(), "one value per query and channel");
        }
        if let Some(pdf) = &pdf {
            assert_eq!(pdf.len(), count, "one density per query");
        }
        Batch { table: self, wi, wo, values, cosine, pdf }
    }

    /// The passes that values and densities share: where the queries `0..n` are in the tables.
    #[inline(always)]
    fn locate<L: Lanes, const SLICES: usize>(
        &self,
        lanes: L,
        n: usize,
        (directions, cosine): ((DirectionBlock<'_>, DirectionBlock<'_>), bool),
        scratch: &mut Scratch,
    ) {
        let Scratch { frame, incident, blend, u_m, places, s, density, .. } = scratch;
        frame::run(lanes, n, directions, self.symmetry, cosine, frame);
        angles::incident(lanes, n, self.azimuthal, frame, incident);
        angles::half(lanes, n, frame, u_m);
        call(lanes, Slices::<SLICES> { table: self, n, valid: &mut frame.valid, incident, blend: &mut *blend });
        places.find(lanes, n, &self.vndf.grid, &blend.slice, u_m);
        invert::run::<L, SLICES>(lanes, n, &self.vndf, (u_m, blend), places, s, density);
    }
}

/// The slices that queries `0..n` blend; none if they are not `valid`. The angles turn into fractions. Evaluation and
/// drawing call it, so that it is compiled once.
pub(super) struct Slices<'a, const SLICES: usize> {
    pub(super) table: &'a Table,
    pub(super) n: usize,
    pub(super) valid: &'a mut Column<i32>,
    pub(super) incident: &'a mut Incident,
    pub(super) blend: &'a mut Blend,
}

impl<const SLICES: usize> Kernel for Slices<'_, SLICES> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Slices { table, n, valid, incident: Incident { theta, phi, .. }, blend } = self;
        blend.slice = Column::<i32>::ZERO;
        let axes = [(&table.theta_i, 1), (&table.phi_i, table.theta_i.knots().len())];
        let mut axis = 0;
        while axis < SLICES / 2 {
            let (knots, stride) = axes[axis];
            let angle = if axis == 0 { &mut *theta } else { &mut *phi };
            cells::run(lanes, n, knots, stride, angle, &mut blend.slice, valid);
            axis += 1;
        }
        if SLICES == 4 {
            weights::run(lanes, n, [phi, theta], valid, 1.0, &mut blend.weights);
        } else {
            weights::run(lanes, n, [theta], valid, 1.0, &mut blend.weights);
        }
    }
}

/// What is known of `wi`.
pub(super) struct Incident {
    /// Zenith angle and azimuth in radians.
    pub(super) theta: Column,
    pub(super) phi: Column,
    /// The position on the unit square.
    pub(super) u: [Column; 2],
}

/// What the passes of a block hand on.
pub(super) struct Scratch {
    pub(super) frame: Frame,
    pub(super) incident: Incident,
    pub(super) blend: Blend,
    /// The position of the half vector, and the uniform position that the visible normals warp to it.
    pub(super) u_m: [Column; 2],
    pub(super) s: [Column; 2],
    places: Places,
    pub(super) density: Column,
    pub(super) weights: [Column; MAX_CORNERS],
    tile: Tile,
}

impl Scratch {
    pub(super) const ZERO: Self = Scratch {
        frame: Frame::ZERO,
        incident: Incident { theta: Column::<f32>::ZERO, phi: Column::<f32>::ZERO, u: [Column::<f32>::ZERO; 2] },
        blend: Blend::ZERO,
        u_m: [Column::<f32>::ZERO; 2],
        s: [Column::<f32>::ZERO; 2],
        places: Places::ZERO,
        density: Column::<f32>::ZERO,
        weights: [Column::<f32>::ZERO; MAX_CORNERS],
        tile: [0.0; 3 * BLOCK + 1],
    };
}

/// All queries of a batch.
struct Batch<'a> {
    table: &'a Table,
    wi: Directions<'a>,
    wo: Directions<'a>,
    values: Option<&'a mut [f32]>,
    cosine: bool,
    pdf: Option<&'a mut [f32]>,
}

impl Kernel for Batch<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        if self.table.blends_azimuths() { self.blocks::<L, 4, 8, 16>(lanes) } else { self.blocks::<L, 2, 4, 8>(lanes) }
    }
}

impl Batch<'_> {
    /// With blends of `SLICES`: `PAIRS` corners of a cell in one dimension, and `FOURS` in two.
    #[inline(always)]
    fn blocks<L: Lanes, const SLICES: usize, const PAIRS: usize, const FOURS: usize>(self, lanes: L) {
        let Batch { table, wi, wo, mut values, cosine, mut pdf } = self;
        let channels = table.channel_count();
        let count = wi.count();
        let mut scratch = Scratch::ZERO;
        let mut padding = (PADDING, PADDING);
        let mut at = 0;
        while at < count {
            let left = (count - at).min(BLOCK);
            let n = left.next_multiple_of(L::LANES);
            let block = (wi.block(at, &mut padding.0), wo.block(at, &mut padding.1));
            table.locate::<L, SLICES>(lanes, n, (block, cosine), &mut scratch);
            if let Some(values) = &mut values {
                let out = &mut values[at * channels..][..left * channels];
                call(lanes, Values::<SLICES, PAIRS, FOURS> { table, n, scratch: &mut scratch, out });
            }
            if let Some(pdf) = &mut pdf {
                table.density::<L, SLICES>(lanes, n, &mut scratch);
                pdf[at..][..left].copy_from_slice(&scratch.density.0[..left]);
            }
            at += left;
        }
    }
}

/// The values of the located queries `0..n`. Evaluation and drawing call it, so that it is compiled once.
pub(super) struct Values<'a, const SLICES: usize, const PAIRS: usize, const FOURS: usize> {
    pub(super) table: &'a Table,
    pub(super) n: usize,
    pub(super) scratch: &'a mut Scratch,
    pub(super) out: &'a mut [f32],
}

impl<const SLICES: usize, const PAIRS: usize, const FOURS: usize> Kernel for Values<'_, SLICES, PAIRS, FOURS> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Values { table, n, scratch, out } = self;
        let Scratch { frame, incident, blend, u_m, places, s, weights, tile, .. } = scratch;
        if let Some(factor) = &table.factor {
            factor.run(lanes, n, &incident.u, u_m, &mut frame.factor);
        }
        places.find(lanes, n, &table.spectra.grid, &blend.slice, s);
        table.spectra.run::<L, SLICES, PAIRS, FOURS>(lanes, n, places, (blend, &frame.factor), (weights, tile), out);
    }
}

impl Table {
    /// The density over solid angle of the located queries `0..n`, in place of that of the visible normals.
    #[inline(always)]
    fn density<L: Lanes, const SLICES: usize>(&self, lanes: L, n: usize, scratch: &mut Scratch) {
        let Scratch { frame, blend, u_m, places, s, density, .. } = scratch;
        places.find(lanes, n, &self.luminance.grid, &blend.slice, s);
        invert::multiply_density::<L, SLICES>(lanes, n, &self.luminance, blend, places, density);
        let mut query = 0;
        while query < n {
            let sin_m = frame.sin2_m.load(lanes, query).sqrt();
            let jacobian = angles::jacobian(lanes, frame.cos_d.load(lanes, query), u_m[0].load(lanes, query), sin_m);
            density.store(lanes, query, density.load(lanes, query) / jacobian);
            query += L::LANES;
        }
    }
}
