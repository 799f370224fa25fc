//! The ways to evaluate a [`Table`]: batches and lanes through the same passes, single queries separately.

use lobe_backend::Backend;
use lobe_lane::{Floats, Kernel, Lanes};

use super::frame::{self, Frame};
use super::single::Single;
use super::{Table, angles};
use crate::directions::{DirectionBlock, Directions, PADDING};
use crate::grid::interpolation as grid;
use crate::passes::block::BLOCK;

/// What the passes of a block hand on.
struct Scratch {
    frame: Frame,
    grid: grid::Scratch,
}

impl Scratch {
    const ZERO: Self = Scratch { frame: Frame::ZERO, grid: grid::Scratch::ZERO };
}

impl Table {
    /// Evaluates one pair into `out`, one value per channel, on a backend.
    ///
    /// # Panics
    /// If `out` is not as long as there are channels.
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

    /// The work of [`eval`](Table::eval) as a kernel, for lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// If `out` is not as long as there are channels.
    pub fn single<'a>(&'a self, wi: [f32; 3], wo: [f32; 3], out: &'a mut [f32]) -> impl Kernel<Out = ()> + 'a {
        assert_eq!(out.len(), self.channel_count(), "one output per channel");
        Single { table: self, wi, wo, out }
    }

    /// The work of [`eval_batch`](Table::eval_batch) as a kernel, for lanes that are not a [`Backend`].
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
        assert_eq!(out.len(), wi.count() * self.channel_count(), "one output per query and channel");
        Batch { table: self, wi, wo, out }
    }

    /// Evaluates one pair per lane inside a caller's own kernel: `out[channel]` holds that channel in all lanes, 0 in
    /// the lanes that `mask` leaves out.
    ///
    /// # Panics
    /// If `out` is not as long as there are channels.
    #[inline(always)]
    pub fn eval_lanes<L: Lanes>(&self, lanes: L, wi: [L::F; 3], wo: [L::F; 3], mask: L::M, out: &mut [L::F]) {
        assert_eq!(out.len(), self.channel_count(), "one output per channel");
        let mut directions = [[[0.0f32; BLOCK]; 3]; 2];
        for (side, w) in [wi, wo].into_iter().enumerate() {
            for (k, component) in w.into_iter().enumerate() {
                // A lane left out gets directions of no length, which are not above the horizon.
                lanes.store(&mut directions[side][k], component.masked(mask));
            }
        }
        let [wi, wo] = directions.each_ref().map(|[x, y, z]| DirectionBlock::Columns([x, y, z]));
        let mut scratch = Scratch::ZERO;
        self.angles(lanes, L::LANES, (wi, wo), &mut scratch);
        self.grid.find(lanes, L::LANES, &mut scratch.grid);
        self.grid.blend_lanes(lanes, &mut scratch.grid, out);
    }

    /// The first passes: from the directions of queries `0..n` to their angles. `n` is a multiple of the lanes.
    #[inline(always)]
    fn angles<L: Lanes>(
        &self,
        lanes: L,
        n: usize,
        directions: (DirectionBlock<'_>, DirectionBlock<'_>),
        scratch: &mut Scratch,
    ) {
        let Scratch { frame, grid } = scratch;
        frame::run(lanes, n, directions, self.scatter(), self.refraction.as_ref(), frame, &mut grid.valid);
        angles::run(lanes, n, self.is_anisotropic(), frame, &mut grid.angles);
    }
}

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
        let count = wi.count();
        let mut scratch = Scratch::ZERO;
        let mut padding = (PADDING, PADDING);
        let mut at = 0;
        while at < count {
            let n = (count - at).min(BLOCK);
            let block = (wi.block(at, &mut padding.0), wo.block(at, &mut padding.1));
            table.angles(lanes, n.next_multiple_of(L::LANES), block, &mut scratch);
            table.grid.values(lanes, &mut scratch.grid, &mut out[at * channels..][..n * channels]);
            at += n;
        }
    }
}
