//! The ways to evaluate a [`Table`]: batches and lanes through the same passes, single queries separately.

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes, MAX_LANES};

use super::frame::{self, Frame};
use super::single::Single;
use super::{Table, angles};
use crate::directions::Directions;
use crate::grid::interpolation as grid;
use crate::passes::block::BLOCK;
use crate::passes::pairs::{Evaluate, LanePairs, Pairs, evaluation};

/// The intermediate values of a block.
pub(crate) struct Scratch<const B: usize = BLOCK> {
    frame: Frame<B>,
    grid: grid::Scratch<B>,
}

impl<const B: usize> Scratch<B> {
    const ZERO: Self = Scratch { frame: Frame::ZERO, grid: grid::Scratch::ZERO };
}

impl Table {
    /// Evaluates one pair into `out`, one value per channel, on a backend.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    pub fn eval(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        backend.run_narrow(self.single(wi, wo, out));
    }

    /// Evaluates many pairs on a backend: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of channels.
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The work of [`eval`](Table::eval) as a kernel, for lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    // A kernel that is created elsewhere is copied before it runs, which costs as much as the evaluation.
    #[inline(always)]
    pub fn single<'a>(&'a self, wi: [f32; 3], wo: [f32; 3], out: &'a mut [f32]) -> impl Kernel<Out = ()> + 'a {
        assert_eq!(out.len(), self.channel_count(), "one output per channel");
        Single { table: self, wi, wo, out }
    }

    /// The work of [`eval_batch`](Table::eval_batch) as a kernel, for lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// The same as for [`eval_batch`](Table::eval_batch).
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        out: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        evaluation(self, wi, wo, out)
    }

    /// Evaluates one pair per lane inside a caller's own kernel: `out[channel]` holds that channel in all lanes, 0 in
    /// the lanes that `mask` leaves out.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    #[inline(always)]
    pub fn eval_lanes<L: Lanes>(&self, lanes: L, wi: [L::F; 3], wo: [L::F; 3], mask: L::M, out: &mut [L::F]) {
        assert_eq!(out.len(), self.channel_count(), "one output per channel");
        let pairs = LanePairs::new(lanes, wi, wo, mask);
        let mut scratch = Scratch::<MAX_LANES>::ZERO;
        self.angles(lanes, L::LANES, pairs.block(), &mut scratch);
        self.grid.find(lanes, L::LANES, &mut scratch.grid);
        self.grid.blend_lanes(lanes, &mut scratch.grid, out);
    }

    /// The first passes: from the directions of queries `0..n` to their angles. `n` is a multiple of the lanes.
    #[inline(always)]
    fn angles<L: Lanes, const B: usize>(&self, lanes: L, n: usize, pairs: Pairs<'_, B>, scratch: &mut Scratch<B>) {
        let Scratch { frame, grid } = scratch;
        frame::run(lanes, n, pairs, self.scatter(), self.refraction.as_ref(), frame, &mut grid.valid);
        angles::run(lanes, n, self.is_anisotropic(), frame, &mut grid.angles);
    }
}

impl Evaluate for &Table {
    type Scratch = Scratch;
    const SCRATCH: Scratch = Scratch::ZERO;

    fn channel_count(self) -> usize {
        Table::channel_count(self)
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch, out: &mut [f32]) {
        self.angles(lanes, n, pairs, scratch);
        self.grid.values(lanes, &mut scratch.grid, out);
    }
}
