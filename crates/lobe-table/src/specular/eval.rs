//! The ways to evaluate a [`Table`]: batches and lanes through the same passes, single queries beside them.

use lobe_backend::Backend;
use lobe_lane::{Floats, Kernel, Lanes, MAX_LANES};

use crate::directions::{DirectionBlock, Directions, PADDING};
use crate::grid::layout::{Corners, Kind, PHI, PSI, Texels};
use crate::grid::texel::Stored;
use crate::passes::block::{BLOCK, Column};
use crate::passes::frame::{self, Frame};
use crate::passes::texels::{self, Tile};
use crate::passes::weights::{self, MAX_CORNERS};
use crate::passes::{angles, cells};
use crate::specular::Table;
use crate::specular::single::Single;

/// What the passes of a block hand on.
pub(crate) struct Scratch {
    pub(crate) frame: Frame,
    /// Angles, and then the fractions into their cells.
    pub(crate) axes: [Column; 4],
    base: Column<i32>,
    weights: [Column; MAX_CORNERS],
    tile: Tile,
}

impl Scratch {
    pub(crate) const ZERO: Self = Scratch {
        frame: Frame::ZERO,
        axes: [Column::<f32>::ZERO; 4],
        base: Column::<i32>::ZERO,
        weights: [Column::<f32>::ZERO; MAX_CORNERS],
        tile: [0.0; 3 * BLOCK + 1],
    };
}

impl Table {
    /// Evaluates one pair into `out`, one value a channel, on a backend.
    ///
    /// # Panics
    /// Where `out` is not as long as there are channels.
    pub fn eval(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        backend.run(self.single(wi, wo, out));
    }

    /// Evaluates many pairs on a backend: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// If there are not as many `wi` as `wo`, or `out` is not that many times the channels long.
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The work of [`eval`](Table::eval) as a kernel, for lanes that are no [`Backend`].
    ///
    /// # Panics
    /// Where `out` is not as long as there are channels.
    pub fn single<'a>(&'a self, wi: [f32; 3], wo: [f32; 3], out: &'a mut [f32]) -> impl Kernel<Out = ()> + 'a {
        assert_eq!(out.len(), self.channel_count(), "one output a channel");
        Single { table: self, wi, wo, out }
    }

    /// The work of [`eval_batch`](Table::eval_batch) as a kernel, for lanes that are no [`Backend`].
    ///
    /// # Panics
    /// As [`eval_batch`](Table::eval_batch).
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        out: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
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
        let mut directions = [[[0.0f32; BLOCK]; 3]; 2];
        for (side, w) in [wi, wo].into_iter().enumerate() {
            for (k, component) in w.into_iter().enumerate() {
                // A lane left out gets directions of no length, which are not above the horizon.
                lanes.store(&mut directions[side][k], component.masked(mask));
            }
        }
        let [wi, wo] = directions.each_ref().map(|[x, y, z]| DirectionBlock::Columns([x, y, z]));
        let mut scratch = Scratch::ZERO;
        self.locate(lanes, L::LANES, (wi, wo), &mut scratch);
        // Texels come query by query; the lanes want them channel by channel.
        let texels = self.layout.texels();
        let mut tile = [0.0f32; MAX_LANES * CHUNK];
        for (chunk, channels) in out.chunks_mut(CHUNK).enumerate() {
            let width = channels.len();
            let tile = &mut tile[..L::LANES * width];
            self.texels(lanes, L::LANES, &texels, &mut scratch, (chunk * CHUNK, width), tile);
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

    /// The first passes: from the directions of queries `0..n` to base indices and corner weights. `n` is a multiple of
    /// the lanes.
    #[inline(always)]
    fn locate<L: Lanes>(
        &self,
        lanes: L,
        n: usize,
        directions: (DirectionBlock<'_>, DirectionBlock<'_>),
        scratch: &mut Scratch,
    ) {
        let Scratch { frame, axes, .. } = scratch;
        frame::run(lanes, n, directions, self.scatter(), self.refraction.as_ref(), frame);
        angles::run(lanes, n, self.is_anisotropic(), frame, axes);
        self.find(lanes, n, scratch);
    }

    /// From the angles of queries `0..n` to base indices and corner weights.
    #[inline(always)]
    pub(crate) fn find<L: Lanes>(&self, lanes: L, n: usize, scratch: &mut Scratch) {
        let Scratch { frame, axes, base, weights, .. } = scratch;
        *base = Column::<i32>::ZERO;
        for (index, (axis, angle)) in self.axes.iter().zip(axes.iter_mut()).enumerate() {
            if index != PSI || self.is_anisotropic() {
                cells::run(lanes, n, axis, self.layout.strides()[index], angle, base, &mut frame.valid);
            }
        }
        let [sigma, psi, theta, phi] = &*axes;
        let valid = (&frame.valid, self.layout.scale());
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
    pub(crate) fn texels<L: Lanes>(
        &self,
        lanes: L,
        n: usize,
        texels: &Texels<'_>,
        scratch: &mut Scratch,
        channels: (usize, usize),
        out: &mut [f32],
    ) {
        match texels {
            Texels::Single(corners) => self.blend(lanes, n, corners, scratch, channels, out),
            Texels::Half(corners) => self.blend(lanes, n, corners, scratch, channels, out),
        }
    }

    #[inline(always)]
    fn blend<L: Lanes, T: Stored>(
        &self,
        lanes: L,
        n: usize,
        corners: &Corners<'_, T>,
        scratch: &mut Scratch,
        (from, width): (usize, usize),
        out: &mut [f32],
    ) {
        let Scratch { axes, base, weights, tile, .. } = scratch;
        let located = (&*base, &*weights);
        let (floor, whole) = (self.floor(), n.next_multiple_of(L::LANES));
        match corners {
            Corners::MonoIso(block) => texels::mono(lanes, whole, block, located, floor, tile),
            Corners::MonoAniso(block) => texels::mono(lanes, whole, block, located, floor, tile),
            Corners::RgbIso(block) => texels::rgb(lanes, whole, block, (located, &axes[PHI]), floor, tile),
            Corners::RgbAniso(block) => texels::rgb(lanes, whole, block, (located, &axes[PHI]), floor, tile),
            // Many channels need no tile.
            Corners::WideIso(block) => return texels::wide(lanes, block, (from, width), located, floor, out),
            Corners::WideAniso(block) => return texels::wide(lanes, block, (from, width), located, floor, out),
        }
        match width {
            2 => {
                for (texel, three) in out.chunks_exact_mut(2).zip(tile.chunks_exact(3)) {
                    texel.copy_from_slice(&three[..2]);
                }
            }
            _ => out.copy_from_slice(&tile[..out.len()]),
        }
    }

    /// What no result is less than. Texels are finite, so the least float leaves every sum as it is.
    #[inline(always)]
    pub(crate) fn floor(&self) -> f32 {
        if self.edges().non_negative { 0.0 } else { f32::MIN }
    }
}

/// Channels that [`Table::eval_lanes`] turns into lanes at once.
const CHUNK: usize = 8;

/// All queries of a batch, block by block.
struct Batch<'a> {
    table: &'a Table,
    wi: Directions<'a>,
    wo: Directions<'a>,
    out: &'a mut [f32],
}

impl Kernel for Batch<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Batch { table, wi, wo, out } = self;
        let channels = table.channel_count();
        let texels = table.layout.texels();
        let count = wi.count();
        let mut scratch = Scratch::ZERO;
        let mut padding = (PADDING, PADDING);
        let mut at = 0;
        while at < count {
            let n = (count - at).min(BLOCK);
            let block = (wi.block(at, &mut padding.0), wo.block(at, &mut padding.1));
            table.locate(lanes, n.next_multiple_of(L::LANES), block, &mut scratch);
            let target = &mut out[at * channels..][..n * channels];
            table.texels(lanes, n, &texels, &mut scratch, (0, channels), target);
            at += n;
        }
    }
}
