//! A block of samples in short passes.
//!
//! A search is a chain of loads, each of which waits for the one before. Taking each step for all queries of a block
//! before the next step keeps many loads in flight. The arithmetic is that of [`Distribution::draw_lanes`].

use lobe_lane::{Lanes, MAX_LANES};

use super::distribution::{Distribution, leave};
use super::incident::Incident;
use super::places::Places;
use super::slices::{Row, Search, Sums, View};
use crate::directions::DirectionBlock;
use crate::passes::block::Column;

/// The columns passed from one pass to the next.
pub(super) struct Scratch {
    first: Column<i32>,
    cell: Column<i32>,
    target: Column,
    low: Column,
    high: Column,
    /// The sum of all rows, and later the factor from a mass to a density.
    scale: Column,
    /// The second number, and later phi.
    phi: Column,
}

impl Scratch {
    pub(super) const ZERO: Self = Scratch {
        first: Column::<i32>::ZERO,
        cell: Column::<i32>::ZERO,
        target: Column::<f32>::ZERO,
        low: Column::<f32>::ZERO,
        high: Column::<f32>::ZERO,
        scale: Column::<f32>::ZERO,
        phi: Column::<f32>::ZERO,
    };

    #[inline(always)]
    fn search<L: Lanes>(&self, lanes: L, at: usize) -> Search<L> {
        Search {
            first: self.first.load(lanes, at),
            cell: self.cell.load(lanes, at),
            target: self.target.load(lanes, at),
            low: self.low.load(lanes, at),
            high: self.high.load(lanes, at),
        }
    }

    #[inline(always)]
    fn begin<L: Lanes>(&mut self, lanes: L, at: usize, search: Search<L>) {
        self.first.store(lanes, at, search.first);
        self.target.store(lanes, at, search.target);
        self.step(lanes, at, search);
    }

    #[inline(always)]
    fn step<L: Lanes>(&mut self, lanes: L, at: usize, search: Search<L>) {
        self.cell.store(lanes, at, search.cell);
        self.low.store(lanes, at, search.low);
        self.high.store(lanes, at, search.high);
    }
}

/// The inputs of a block of samples.
pub(super) struct Input<'a> {
    pub(super) known: DirectionBlock<'a>,
    /// Two numbers in `[0, 1)` for each direction.
    pub(super) u: &'a [[f32; 2]],
    /// The slices around each direction.
    pub(super) places: &'a Places,
}

/// The outputs of a block of samples.
pub(super) struct Out<'a> {
    pub(super) directions: &'a mut [[f32; 3]],
    pub(super) pdfs: &'a mut [f32],
}

/// Samples up to [`BLOCK`](crate::passes::block::BLOCK) directions.
#[inline(always)]
pub(super) fn draw<L: Lanes, S: Sums>(
    lanes: L,
    distribution: &Distribution,
    view: &View<'_, S>,
    Input { known, u, places }: Input<'_>,
    scratch: &mut Scratch,
    out: Out<'_>,
) {
    let n = u.len();
    let mut at = 0;
    while at < n {
        // Beyond the last pair of numbers, that pair is read again.
        let [first, second] = lanes.gather_pair(u, lanes.iota() + lanes.splat_int(at as i32));
        let (search, total) = view.begin(lanes, &places.load(lanes, at), first);
        scratch.begin(lanes, at, search);
        scratch.scale.store(lanes, at, total);
        scratch.phi.store(lanes, at, second);
        at += L::LANES;
    }

    let mut half = view.row_half();
    while half > 0 {
        let mut at = 0;
        while at < n {
            let search = view.row_step(lanes, scratch.search(lanes, at), half, &places.load(lanes, at).weights);
            scratch.step(lanes, at, search);
            at += L::LANES;
        }
        half >>= 1;
    }

    let mut at = 0;
    while at < n {
        let (total, w) = (scratch.scale.load(lanes, at), scratch.phi.load(lanes, at));
        let (search, Row { phi, scale }) = view.turn(lanes, scratch.search(lanes, at), total, w);
        scratch.begin(lanes, at, search);
        scratch.phi.store(lanes, at, phi);
        scratch.scale.store(lanes, at, scale);
        at += L::LANES;
    }

    let mut half = view.column_half();
    while half > 0 {
        let mut at = 0;
        while at < n {
            let search = view.column_step(lanes, scratch.search(lanes, at), half, &places.load(lanes, at).weights);
            scratch.step(lanes, at, search);
            at += L::LANES;
        }
        half >>= 1;
    }

    let all = lanes.first_n(L::LANES);
    let mut at = 0;
    while at < n {
        let row = Row { phi: scratch.phi.load(lanes, at), scale: scratch.scale.load(lanes, at) };
        let draw = view.end(lanes, scratch.search(lanes, at), row);
        let incident = Incident::new(lanes, &distribution.surface, known.load(lanes, at));
        let (direction, pdf) = leave(lanes, &incident, draw, all);
        lanes.store_partial(&mut out.pdfs[at..], pdf);
        store(lanes, &mut out.directions[at..], direction);
        at += L::LANES;
    }
}

/// Writes as many vectors as fit.
#[inline(always)]
pub(super) fn store<L: Lanes>(lanes: L, target: &mut [[f32; 3]], [x, y, z]: [L::F; 3]) {
    let mut columns = [[0.0f32; MAX_LANES]; 3];
    lanes.store(&mut columns[0], x);
    lanes.store(&mut columns[1], y);
    lanes.store(&mut columns[2], z);
    let mut lane = 0;
    while lane < L::LANES && lane < target.len() {
        target[lane] = [columns[0][lane], columns[1][lane], columns[2][lane]];
        lane += 1;
    }
}
