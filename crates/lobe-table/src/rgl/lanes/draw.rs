//! From uniform positions to positions with the density of a [`Warp`].
//!
//! A search is a chain of loads, each of which waits for the one before; so each step is taken for all queries of a
//! block before the next step.

use lobe_lane::{Floats, Ints, Lanes};

use super::invert::{self, Blend};
use super::warp::{Entries, STRIDE, Warp};
use crate::grid::weights::MAX_CORNERS;
use crate::passes::block::Column;

/// The open interval: at 0 and 1, rows without density would be chosen.
const EDGE: f32 = 1.0 / (1 << 24) as f32;

/// The state of the search of each query of a block: an entry of the table, and the first entry beyond the search
/// range.
struct Search {
    here: Column<i32>,
    end: Column<i32>,
}

/// Replaces the uniform positions `u` of queries `0..n` by positions with the density of the blended slices, and
/// multiplies `density` by the density there. `corners` is overwritten.
#[inline(always)]
pub(super) fn run<L: Lanes, const SLICES: usize>(
    lanes: L,
    n: usize,
    warp: &Warp,
    blend: &Blend,
    corners: &mut [Column; MAX_CORNERS],
    u: &mut [Column; 2],
    density: &mut Column,
) {
    let (ends, coarse, fine) = (warp.ends(), warp.coarse(), warp.fine());
    let mut search = Search { here: Column::<i32>::ZERO, end: Column::<i32>::ZERO };
    let (low, high) = (lanes.splat(EDGE), lanes.splat(1.0 - EDGE));
    let mut query = 0;
    while query < n {
        let first = ends.of_slice(lanes, blend.slice.load(lanes, query));
        search.begin(lanes, query, first, &ends);
        let mut axis = 0;
        while axis < 2 {
            let inside = u[axis].load(lanes, query).max(low).min(high);
            u[axis].store(lanes, query, inside);
            axis += 1;
        }
        query += L::LANES;
    }
    search.run::<L, SLICES, 2>(lanes, n, &ends, ends.count, &blend.weights, &u[1]);
    turn::<L, SLICES>(lanes, n, warp, blend, &mut search, corners, u);
    search.run::<L, SLICES, 4>(lanes, n, &coarse, coarse.count, corners, &u[0]);
    refine(lanes, n, warp, blend, &mut search, &u[1]);
    search.run::<L, SLICES, 4>(lanes, n, &fine, fine.count.min(STRIDE as i32), corners, &u[0]);
    end::<L, SLICES>(lanes, n, warp, blend, &search, u, density);
}

impl Search {
    #[inline(always)]
    fn begin<L: Lanes>(&mut self, lanes: L, query: usize, first: L::I, entries: &Entries<'_>) {
        self.here.store(lanes, query, first);
        self.end.store(lanes, query, first + lanes.splat_int(entries.count * entries.stride));
    }

    /// Moves queries `0..n` to the last of `count` entries whose first `TERMS` floats, weighted and summed over the
    /// slices, are less than `target`.
    #[inline(always)]
    fn run<L: Lanes, const SLICES: usize, const TERMS: usize>(
        &mut self,
        lanes: L,
        n: usize,
        entries: &Entries<'_>,
        count: i32,
        weights: &[Column; MAX_CORNERS],
        target: &Column,
    ) {
        let mut step = (count as u32).next_power_of_two() as i32 / 2;
        while step > 0 {
            let (stride, block) = (lanes.splat_int(step * entries.stride), entries.further(step));
            let mut query = 0;
            while query < n {
                let here = self.here.load(lanes, query);
                let next = here + stride;
                let found = lanes.gather_quads_at(&block, self.here.slice(lanes, query));
                let mut sum = lanes.splat(0.0);
                let mut slice = 0;
                while slice < SLICES {
                    let entry = found[slice / 2];
                    let mut term = 0;
                    while term < TERMS {
                        let weight = weights[slice / 2 * TERMS + term].load(lanes, query);
                        sum = lanes.mul_add(entry[term], weight, sum);
                        term += 1;
                    }
                    slice += 2;
                }
                let below = next.lt(self.end.load(lanes, query)) & sum.lt(target.load(lanes, query));
                self.here.store(lanes, query, lanes.select_int(below, next, here));
                query += L::LANES;
            }
            step /= 2;
        }
    }
}

/// Goes from the rows that were found to the search of columns: `u.y` becomes row plus fraction, and `u.x` the target
/// integral in that row.
#[inline(always)]
fn turn<L: Lanes, const SLICES: usize>(
    lanes: L,
    n: usize,
    warp: &Warp,
    blend: &Blend,
    search: &mut Search,
    corners: &mut [Column; MAX_CORNERS],
    u: &mut [Column; 2],
) {
    let blocks = warp.rows();
    let (ends, coarse) = (warp.ends(), warp.coarse());
    let rows_per_float = lanes.splat(1.0 / ends.stride as f32);
    let mut query = 0;
    while query < n {
        let weights = invert::slices::<L, SLICES>(lanes, query, blend);
        let slice = blend.slice.load(lanes, query);
        let here = search.here.load(lanes, query);
        let found = (here - ends.of_slice(lanes, slice)).to_float() * rows_per_float;
        let [this, next, below] = invert::rows(lanes, &blocks, search.here.slice(lanes, query), weights);
        let y = solve(lanes, this, next, u[1].load(lanes, query) - below);
        u[0].store(lanes, query, u[0].load(lanes, query) * lanes.mul_add(y, next - this, this));
        u[1].store(lanes, query, found + y);

        let (row, y) = split(lanes, warp, found + y);
        let ends = [lanes.splat(1.0) - y, y];
        let mut corner = 0;
        while corner < 2 * SLICES {
            corners[corner].store(lanes, query, weights[corner / 2] * ends[corner % 2]);
            corner += 1;
        }
        search.begin(lanes, query, coarse.of_row(lanes, slice, row), &coarse);
        query += L::LANES;
    }
}

/// Goes from the coarse texels that were found to the texels between them and the next.
#[inline(always)]
fn refine<L: Lanes>(lanes: L, n: usize, warp: &Warp, blend: &Blend, search: &mut Search, place: &Column) {
    let (coarse, fine) = (warp.coarse(), warp.fine());
    let scale = lanes.splat_int(STRIDE as i32 * fine.stride / coarse.stride);
    let length = lanes.splat_int(fine.count * fine.stride);
    let mut query = 0;
    while query < n {
        let (row, _) = split(lanes, warp, place.load(lanes, query));
        let slice = blend.slice.load(lanes, query);
        let found = search.here.load(lanes, query) - coarse.of_row(lanes, slice, row);
        let first = fine.of_row(lanes, slice, row);
        search.here.store(lanes, query, first + found * scale);
        search.end.store(lanes, query, first + length);
        query += L::LANES;
    }
}

/// Goes from the columns that were found to positions.
#[inline(always)]
fn end<L: Lanes, const SLICES: usize>(
    lanes: L,
    n: usize,
    warp: &Warp,
    blend: &Blend,
    search: &Search,
    u: &mut [Column; 2],
    density: &mut Column,
) {
    let (blocks, fine) = (warp.cells(), warp.fine());
    let placer = warp.grid.placer(lanes);
    let columns_per_float = lanes.splat(1.0 / fine.stride as f32);
    let scale = lanes.splat(warp.scale);
    let mut query = 0;
    while query < n {
        let weights = invert::slices::<L, SLICES>(lanes, query, blend);
        let place = u[1].load(lanes, query);
        let (row, y) = split(lanes, warp, place);
        let here = search.here.load(lanes, query);
        let first = fine.of_row(lanes, blend.slice.load(lanes, query), row);
        let found = (here - first).to_float() * columns_per_float;
        let [left, right, before] = invert::columns(lanes, &blocks, search.here.slice(lanes, query), weights, y);
        let x = solve(lanes, left, right, u[0].load(lanes, query) - before);
        let value = lanes.mul_add(x, right - left, left) * scale;
        density.store(lanes, query, density.load(lanes, query) * value);
        u[0].store(lanes, query, placer.position(0, found + x));
        u[1].store(lanes, query, placer.position(1, place));
        query += L::LANES;
    }
}

/// A row and a fraction into it, from their sum. Both are computed from it, so that a fraction that was rounded up to 1
/// is at the next row.
#[inline(always)]
fn split<L: Lanes>(lanes: L, warp: &Warp, place: L::F) -> (L::I, L::F) {
    let row = place.to_int().min(lanes.splat_int(warp.grid.cells[1] as i32 - 1));
    (row, place - row.to_float())
}

/// The `t` in `[0, 1]` at which the integral from 0 to `t` of a linear function with values `a` at 0 and `b` at 1
/// equals `q`; 0 if the function is 0. The argument of the root is clamped, because rounding may make it negative.
#[inline(always)]
fn solve<L: Lanes>(lanes: L, a: L::F, b: L::F, q: L::F) -> L::F {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let twice = q + q;
    let root = lanes.mul_add(a, a, -(twice * (a - b))).max(zero).sqrt();
    let divisor = a + root;
    (twice / divisor).masked(zero.lt(divisor)).max(zero).min(one)
}
