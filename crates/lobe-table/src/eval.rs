//! The ways to evaluate a [`Table`], all through the same passes.

use lobe_lane::{Block, Floats, Kernel, Lanes, MAX_LANES};

use crate::directions::{Directions, Soa};
use crate::layout::Kind;
use crate::passes::block::{BLOCK, Column};
use crate::passes::frame::{self, Frame};
use crate::passes::texels::{self, RgbTile};
use crate::passes::weights::{self, MAX_CORNERS};
use crate::passes::{angles, cells};
use crate::table::Table;

/// What the passes of a block hand on.
struct Scratch {
    frame: Frame,
    /// Angles, and then the fractions into their cells.
    axes: [Column; 4],
    base: Column<i32>,
    weights: [Column; MAX_CORNERS],
}

impl Scratch {
    const ZERO: Self = Scratch {
        frame: Frame::ZERO,
        axes: [Column::<f32>::ZERO; 4],
        base: Column::<i32>::ZERO,
        weights: [Column::<f32>::ZERO; MAX_CORNERS],
    };
}

impl Table {
    /// Evaluates one pair into `out`, one value a channel, on the backend given.
    ///
    /// # Panics
    /// Where `out` is not as long as there are channels.
    pub fn eval<L: Lanes>(&self, lanes: L, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        lanes.vectorize(self.single(wi, wo, out));
    }

    /// Evaluates many pairs on the backend given: `out[query * channels + channel]`.
    ///
    /// `wi` and `wo` are slices of vectors, or [`Soa`] of components.
    ///
    /// # Panics
    /// Where there are not as many `wi` as `wo`, or `out` is not that many times the channels long.
    pub fn eval_batch<L: Lanes, D: Directions>(&self, lanes: L, wi: D, wo: D, out: &mut [f32]) {
        lanes.vectorize(self.batch(wi, wo, out));
    }

    /// The work of [`eval`](Table::eval) as a kernel.
    ///
    /// # Panics
    /// Where `out` is not as long as there are channels.
    pub fn single<'a>(&'a self, wi: [f32; 3], wo: [f32; 3], out: &'a mut [f32]) -> impl Kernel<Out = ()> + 'a {
        assert_eq!(out.len(), self.channel_count(), "one output a channel");
        Single { table: self, wi, wo, out }
    }

    /// The work of [`eval_batch`](Table::eval_batch) as a kernel.
    ///
    /// # Panics
    /// As [`eval_batch`](Table::eval_batch).
    pub fn batch<'a, D: Directions + 'a>(&'a self, wi: D, wo: D, out: &'a mut [f32]) -> impl Kernel<Out = ()> + 'a {
        assert_eq!(wi.count(), wo.count(), "as many wi as wo");
        assert_eq!(out.len(), wi.count() * self.channel_count(), "one output a query and channel");
        Batch { table: self, wi, wo, out }
    }

    /// Evaluates one pair a lane inside a caller's own kernel: `out[channel]` holds that channel in all lanes, 0 in the
    /// lanes that `mask` leaves out.
    ///
    /// # Panics
    /// Where `out` is not as long as there are channels.
    #[inline(always)]
    pub fn eval_lanes<L: Lanes>(&self, lanes: L, wi: [L::F; 3], wo: [L::F; 3], mask: L::M, out: &mut [L::F]) {
        assert_eq!(out.len(), self.channel_count(), "one output a channel");
        let mut directions = [[[0.0f32; MAX_LANES]; 3]; 2];
        for (side, w) in [wi, wo].into_iter().enumerate() {
            for (k, component) in w.into_iter().enumerate() {
                // A lane left out gets directions of no length, which are not above the horizon.
                lanes.store(&mut directions[side][k], component.masked(mask));
            }
        }
        let [wi, wo] = directions.each_ref().map(|[x, y, z]| Soa::new(x, y, z));
        let mut scratch = Scratch::ZERO;
        self.locate(lanes, (wi, wo), (0, L::LANES), &mut scratch);
        // Texels come query by query; the lanes want them channel by channel.
        let mut tile = [0.0f32; MAX_LANES * CHUNK];
        for (chunk, channels) in out.chunks_mut(CHUNK).enumerate() {
            let width = channels.len();
            self.texels(lanes, L::LANES, &scratch, chunk * CHUNK, width, &mut tile[..L::LANES * width]);
            for (k, channel) in channels.iter_mut().enumerate() {
                let mut column = [0.0f32; MAX_LANES];
                let mut lane = 0;
                while lane < L::LANES {
                    column[lane] = tile[lane * width + k];
                    lane += 1;
                }
                *channel = lanes.load(&column);
            }
        }
    }

    /// The first passes: from the directions of queries `at .. at + n` to base indices and corner weights. `n` is a
    /// multiple of the lanes and at most a block.
    #[inline(always)]
    fn locate<L: Lanes, D: Directions>(
        &self,
        lanes: L,
        directions: (D, D),
        (at, n): (usize, usize),
        scratch: &mut Scratch,
    ) {
        let Scratch { frame, axes, base, weights } = scratch;
        frame::run(lanes, self.scatter(), self.refraction.as_ref(), directions, (at, n), frame);
        angles::run(lanes, n, self.is_anisotropic(), frame, axes);
        *base = Column::<i32>::ZERO;
        for ((axis, stride), angle) in self.axes.iter().zip(self.layout.strides()).zip(axes.iter_mut()) {
            cells::run(lanes, n, axis, *stride, angle, base, &mut frame.valid);
        }
        let [sigma, psi, theta, phi] = &*axes;
        let valid = &frame.valid;
        match (self.layout.kind, self.is_anisotropic()) {
            (Kind::Rgb, false) => weights::run(lanes, n, [sigma, theta], valid, weights),
            (Kind::Rgb, true) => weights::run(lanes, n, [sigma, psi, theta], valid, weights),
            (_, false) => weights::run(lanes, n, [sigma, theta, phi], valid, weights),
            (_, true) => weights::run(lanes, n, [sigma, psi, theta, phi], valid, weights),
        }
    }

    /// The last pass: channels `from .. from + width` of queries `0..n`, `out[query * width + channel - from]`. All
    /// channels at once, or from a multiple of eight on.
    #[inline(always)]
    fn texels<L: Lanes>(&self, lanes: L, n: usize, scratch: &Scratch, from: usize, width: usize, out: &mut [f32]) {
        let Scratch { axes, base, weights, .. } = scratch;
        let located = (base, weights);
        let non_negative = self.edges().non_negative;
        let data = self.layout.data();
        match (self.layout.kind, self.is_anisotropic()) {
            (Kind::Mono, anisotropic) => {
                let mut values = Column::<f32>::ZERO;
                if anisotropic {
                    let block = Block::<4, 4>::new(data, self.layout.corners(&self.axes, [SIGMA, PSI]));
                    texels::mono(lanes, n, &block, located, non_negative, &mut values);
                } else {
                    let block = Block::<2, 4>::new(data, self.layout.corners(&self.axes, [SIGMA]));
                    texels::mono(lanes, n, &block, located, non_negative, &mut values);
                }
                out.copy_from_slice(&values.0[..out.len()]);
            }
            (Kind::Rgb, anisotropic) => {
                let mut tile: RgbTile = [0.0; 3 * BLOCK + 1];
                if anisotropic {
                    let block = Block::<8, 8>::new(data, self.layout.corners(&self.axes, [SIGMA, PSI, THETA]));
                    texels::rgb(lanes, n, &block, (base, weights, &axes[PHI]), non_negative, &mut tile);
                } else {
                    let block = Block::<4, 8>::new(data, self.layout.corners(&self.axes, [SIGMA, THETA]));
                    texels::rgb(lanes, n, &block, (base, weights, &axes[PHI]), non_negative, &mut tile);
                }
                if width == 3 {
                    out.copy_from_slice(&tile[..out.len()]);
                } else {
                    for (texel, whole) in out.chunks_exact_mut(width).zip(tile.chunks_exact(3)) {
                        texel.copy_from_slice(&whole[..width]);
                    }
                }
            }
            (Kind::Wide, anisotropic) => {
                if anisotropic {
                    let block = Block::<16, 8>::new(data, self.layout.corners(&self.axes, [SIGMA, PSI, THETA, PHI]));
                    texels::wide(lanes, &block, (from, width), located, non_negative, out);
                } else {
                    let block = Block::<8, 8>::new(data, self.layout.corners(&self.axes, [SIGMA, THETA, PHI]));
                    texels::wide(lanes, &block, (from, width), located, non_negative, out);
                }
            }
        }
    }
}

/// Channels that [`Table::eval_lanes`] turns into lanes at once.
const CHUNK: usize = 8;

const SIGMA: usize = 0;
const PSI: usize = 1;
const THETA: usize = 2;
const PHI: usize = 3;

/// All queries of a batch, block by block.
struct Batch<'a, D> {
    table: &'a Table,
    wi: D,
    wo: D,
    out: &'a mut [f32],
}

impl<D: Directions> Kernel for Batch<'_, D> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Batch { table, wi, wo, out } = self;
        let channels = table.channel_count();
        let count = wi.count();
        let mut scratch = Scratch::ZERO;
        let mut at = 0;
        while at < count {
            let n = (count - at).min(BLOCK);
            table.locate(lanes, (wi, wo), (at, n.next_multiple_of(L::LANES)), &mut scratch);
            table.texels(lanes, n, &scratch, 0, channels, &mut out[at * channels..][..n * channels]);
            at += n;
        }
    }
}

/// One query.
struct Single<'a> {
    table: &'a Table,
    wi: [f32; 3],
    wo: [f32; 3],
    out: &'a mut [f32],
}

impl Kernel for Single<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Single { table, wi, wo, out } = self;
        Batch { table, wi: [wi].as_slice(), wo: [wo].as_slice(), out }.run(lanes);
    }
}
