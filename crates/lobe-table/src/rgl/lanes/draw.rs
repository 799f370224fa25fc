//! Uniform positions to positions that have the density of a [`Warp`].
//!
//! A search is a chain of loads, each waiting for the one before: one step of it is taken in all queries of a block before
//! the next.

use lobe_lane::{Floats, Ints, Lanes};

use super::invert::{self, Blend};
use super::warp::Warp;
use crate::passes::block::Column;

/// The open interval: at 0 and 1 rows without density would be chosen.
const EDGE: f32 = 1.0 / (1 << 24) as f32;

/// Replaces the uniform positions `u` of queries `0..n` by positions with the density of the blended slices, and
/// multiplies `density` by the density there.
#[inline(always)]
pub(super) fn run<L: Lanes, const SLICES: usize, const CORNERS: usize>(
    lanes: L,
    n: usize,
    warp: &Warp,
    blend: &Blend,
    u: &mut [Column; 2],
    density: &mut Column,
) {
    rows::<L, SLICES>(lanes, n, warp, blend, u);
    columns::<L, SLICES, CORNERS>(lanes, n, warp, blend, u, density);
}

/// Draws the rows by their marginal distribution: `u.y` becomes row and fraction in one number, and `u.x` the integral to be
/// reached in that row.
#[inline(always)]
fn rows<L: Lanes, const SLICES: usize>(lanes: L, n: usize, warp: &Warp, blend: &Blend, u: &mut [Column; 2]) {
    let block = warp.rows::<SLICES>();
    let [row_stride, slice_stride] = warp.row_strides().map(|stride| lanes.splat_int(stride));
    let cells = warp.grid.cells[1];
    let count = lanes.splat_int(cells as i32);
    let (low, high) = (lanes.splat(EDGE), lanes.splat(1.0 - EDGE));
    // The last row below which there is less than `y`.
    let mut found = Column::<i32>::ZERO;
    let mut step = cells.next_power_of_two() / 2;
    while step > 0 {
        let mut query = 0;
        while query < n {
            let weights = invert::slices::<L, SLICES>(lanes, query, blend);
            let first = blend.slice.load(lanes, query) * slice_stride;
            let y = u[1].load(lanes, query).max(low).min(high);
            let row = found.load(lanes, query);
            let next = row + lanes.splat_int(step as i32);
            let [_, _, below] = invert::rows(lanes, &block, first + next * row_stride, weights);
            found.store(lanes, query, lanes.select_int(next.lt(count) & below.lt(y), next, row));
            query += L::LANES;
        }
        step /= 2;
    }
    let mut query = 0;
    while query < n {
        let weights = invert::slices::<L, SLICES>(lanes, query, blend);
        let first = blend.slice.load(lanes, query) * slice_stride;
        let y = u[1].load(lanes, query).max(low).min(high);
        let row = found.load(lanes, query);
        let [here, next, below] = invert::rows(lanes, &block, first + row * row_stride, weights);
        let fraction = solve(lanes, here, next, y - below);
        let x = u[0].load(lanes, query).max(low).min(high);
        u[0].store(lanes, query, x * lanes.mul_add(fraction, next - here, here));
        u[1].store(lanes, query, row.to_float() + fraction);
        query += L::LANES;
    }
}

/// Draws the columns by the conditional distribution of the rows drawn.
#[inline(always)]
fn columns<L: Lanes, const SLICES: usize, const CORNERS: usize>(
    lanes: L,
    n: usize,
    warp: &Warp,
    blend: &Blend,
    u: &mut [Column; 2],
    density: &mut Column,
) {
    let block = warp.texels::<CORNERS>();
    let placer = warp.grid.placer(lanes);
    let [columns, rows] = warp.grid.cells;
    let [count, last_row] = [columns, rows - 1].map(|cells| lanes.splat_int(cells as i32));
    let scale = lanes.splat(warp.scale);
    let mut found = Column::<i32>::ZERO;
    let mut step = columns.next_power_of_two() / 2;
    while step > 0 {
        let mut query = 0;
        while query < n {
            let weights = invert::slices::<L, SLICES>(lanes, query, blend);
            let (x, place) = (u[0].load(lanes, query), u[1].load(lanes, query));
            let row = place.to_int().min(last_row);
            let y = place - row.to_float();
            let first = placer.slice(blend.slice.load(lanes, query));
            let column = found.load(lanes, query);
            let next = column + lanes.splat_int(step as i32);
            let base = first + placer.texel([next, row]);
            let [_, _, before] = invert::columns::<L, SLICES, CORNERS>(lanes, &block, base, weights, y);
            found.store(lanes, query, lanes.select_int(next.lt(count) & before.lt(x), next, column));
            query += L::LANES;
        }
        step /= 2;
    }
    let mut query = 0;
    while query < n {
        let weights = invert::slices::<L, SLICES>(lanes, query, blend);
        let (x, place) = (u[0].load(lanes, query), u[1].load(lanes, query));
        let row = place.to_int().min(last_row);
        let y = place - row.to_float();
        let first = placer.slice(blend.slice.load(lanes, query));
        let column = found.load(lanes, query);
        let base = first + placer.texel([column, row]);
        let [left, right, before] = invert::columns::<L, SLICES, CORNERS>(lanes, &block, base, weights, y);
        let fraction = solve(lanes, left, right, x - before);
        let here = lanes.mul_add(fraction, right - left, left) * scale;
        density.store(lanes, query, density.load(lanes, query) * here);
        u[0].store(lanes, query, placer.position(0, column.to_float() + fraction));
        u[1].store(lanes, query, placer.position(1, place));
        query += L::LANES;
    }
}

/// The `t` in `[0, 1]` at which the integral from 0 to `t` of a function that goes linearly from `a` at 0 to `b` at 1 is `q`;
/// 0 where there is nothing to integrate. The root is guarded: rounding may make its argument negative.
#[inline(always)]
fn solve<L: Lanes>(lanes: L, a: L::F, b: L::F, q: L::F) -> L::F {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let twice = q + q;
    let root = lanes.mul_add(a, a, -(twice * (a - b))).max(zero).sqrt();
    let divisor = a + root;
    (twice / divisor).masked(zero.lt(divisor)).max(zero).min(one)
}
