//! One query at a time, with SIMD within the query.
//!
//! The arithmetic is that of the passes, operation by operation, so the results have the same bits; only its
//! arrangement differs. No other query hides the latency, so a cell is found by comparing with eight knots at once, and
//! texels are loaded whole.

use std::f32::consts::TAU;

use lobe_lane::{Block, Lanes};

use super::axis::{Axis, Bounds, Search};
use super::interpolation::Interpolator;
use super::layout::{Corners, LAST, TURN, Texels};
use super::texel::Stored;

/// The place of a query in a grid.
struct Located {
    at: usize,
    fractions: [f32; 4],
    valid: bool,
}

impl Interpolator {
    /// The channels at four angles in radians, into `out`; 0 if not `valid`.
    #[inline(always)]
    pub(crate) fn single<L: Lanes>(&self, lanes: L, angles: [f32; 4], valid: bool, out: &mut [f32]) {
        let first = self.find_along(lanes, angles, 0);
        let third = self.find_along(lanes, angles, 2);
        let last = self.find_along(lanes, angles, LAST);
        let turn = match self.is_anisotropic() {
            true => self.find_along(lanes, angles, TURN),
            false => OneCell { index: 0, fraction: 0.0, contained: true },
        };
        let base = first.index.wrapping_add(turn.index).wrapping_add(third.index).wrapping_add(last.index);
        let valid = valid & first.contained & turn.contained & third.contained & last.contained;
        let fractions = [first.fraction, turn.fraction, third.fraction, last.fraction];
        let located = Located { at: base as usize, fractions, valid };
        match self.layout().texels() {
            Texels::Single(corners) => located.read(lanes, self, corners, out),
            Texels::Half(corners) => located.read(lanes, self, corners, out),
        }
    }

    /// The cell along an axis, with its offset in the table instead of its index.
    #[inline(always)]
    fn find_along<L: Lanes>(&self, lanes: L, angles: [f32; 4], axis: usize) -> OneCell {
        let cell = self.axes()[axis].cell_one(lanes, angles[axis]);
        OneCell { index: cell.index.wrapping_mul(self.layout().strides()[axis] as u32), ..cell }
    }
}

impl Located {
    #[inline(always)]
    fn read<L: Lanes, T: Stored>(self, lanes: L, grid: &Interpolator, corners: Corners<'_, T>, out: &mut [f32]) {
        let Located { at, fractions: [a, turn, b, last], valid } = self;
        let (floor, scale) = (grid.floor(), grid.layout().scale());
        match corners {
            Corners::RgbIso(block) => rgb(lanes, &block, at, weights([a, b], valid, scale), last, floor, out),
            Corners::RgbAniso(block) => rgb(lanes, &block, at, weights([a, turn, b], valid, scale), last, floor, out),
            Corners::MonoIso(block) => {
                mono(lanes, &block, at, weights::<3, 8>([a, b, last], valid, scale), floor, out);
            }
            Corners::MonoAniso(block) => {
                mono(lanes, &block, at, weights::<4, 16>([a, turn, b, last], valid, scale), floor, out);
            }
            Corners::WideIso(block) => wide(lanes, &block, at, weights([a, b, last], valid, scale), floor, out),
            Corners::WideAniso(block) => {
                wide(lanes, &block, at, weights([a, turn, b, last], valid, scale), floor, out);
            }
        }
    }
}

/// The cell of one angle.
struct OneCell {
    index: u32,
    /// The fraction into the cell.
    fraction: f32,
    /// `true` if the table has a value there.
    contained: bool,
}

impl Axis {
    /// The cell of one angle.
    #[inline(always)]
    fn cell_one<L: Lanes>(&self, lanes: L, x: f32) -> OneCell {
        let Bounds { turn_below, clamp: [low, high], inside } = self.bounds;
        let contained = inside[0] <= x && x <= inside[1];
        let x = x + if x < turn_below { TAU } else { 0.0 };
        // Written with the comparisons of the lanes, so that NaN is treated in the same way.
        let x = if x > low { x } else { low };
        let x = if x < high { x } else { high };
        let (index, fraction) = self.find_one(lanes, x);
        OneCell { index, fraction, contained }
    }

    /// Like [`Find::find`](super::search::Find), for one angle.
    #[inline(always)]
    fn find_one<L: Lanes>(&self, lanes: L, x: f32) -> (u32, f32) {
        let cell = match self.search() {
            Search::Registers(registers) => {
                let sorted = &registers.sorted;
                let mut count = lanes.oct_count_le(lanes.oct_load(&sorted[..8]), x);
                if registers.levels > 3 {
                    count += lanes.oct_count_le(lanes.oct_load(&sorted[8..16]), x);
                    if registers.levels > 4 {
                        count += lanes.oct_count_le(lanes.oct_load(&sorted[16..24]), x);
                        count += lanes.oct_count_le(lanes.oct_load(&sorted[24..32]), x);
                    }
                }
                count
            }
            Search::Constant => return (0, 0.0),
            Search::Uniform { cells_per_radian } => {
                let position = (x - self.first()) * cells_per_radian;
                let cell = (position as i32).min(self.cells().len() as i32 - 1).max(0);
                return (cell as u32, position - cell as f32);
            }
            Search::Guide { buckets_per_radian, buckets, steps, .. } => {
                let bucket = ((x - self.first()) * buckets_per_radian) as i32;
                let [start, knot] = buckets[bucket.min(buckets.len() as i32 - 1).max(0) as usize];
                let inner = &self.knots()[1..self.knots().len() - 1];
                let mut cell = start as usize + (knot <= x) as usize;
                for _ in 1..*steps {
                    cell += (cell < inner.len() && inner[cell] <= x) as usize;
                }
                cell as u32
            }
        };
        let [first, inverse] = self.cells()[cell as usize];
        (cell, (x - first) * inverse)
    }
}

/// The weight of each corner over the axes with the given fractions, the last axis fastest. They add up to `scale`, or
/// to 0 if not `valid`.
#[inline(always)]
fn weights<const AXES: usize, const CORNERS: usize>(fractions: [f32; AXES], valid: bool, scale: f32) -> [f32; CORNERS] {
    let mut products = [scale; CORNERS];
    let mut axis = 0;
    while axis < AXES {
        let (upper, mut corner) = (fractions[axis], 1 << axis);
        while corner > 0 {
            corner -= 1;
            let product = products[corner];
            products[2 * corner] = product * (1.0 - upper);
            products[2 * corner + 1] = product * upper;
        }
        axis += 1;
    }
    if valid { products } else { [0.0; CORNERS] }
}

#[inline(always)]
fn rgb<L: Lanes, T: Stored, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CORNERS, 8, T>,
    base: usize,
    weights: [f32; CORNERS],
    last: f32,
    floor: f32,
    out: &mut [f32],
) {
    let [low, high] = lanes.oct_halves(blend(lanes, block, base, weights));
    let texel = lanes.quad_mul_add(lanes.quad_splat(last), high - low, low);
    let mut four = [0.0; 4];
    lanes.quad_store(&mut four, lanes.quad_max(texel, lanes.quad_splat(floor)));
    let [r, g, b, _] = four;
    match out {
        [red, green, blue] => (*red, *green, *blue) = (r, g, b),
        _ => out.copy_from_slice(&[r, g]),
    }
}

#[inline(always)]
fn wide<L: Lanes, T: Stored, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CORNERS, 8, T>,
    base: usize,
    weights: [f32; CORNERS],
    floor: f32,
    out: &mut [f32],
) {
    let mut from = 0;
    while from < out.len() {
        let sum = lanes.oct_max(blend(lanes, block, base + from, weights), lanes.oct_splat(floor));
        let mut whole = [0.0; 8];
        lanes.oct_store(&mut whole, sum);
        let width = (out.len() - from).min(8);
        out[from..][..width].copy_from_slice(&whole[..width]);
        from += 8;
    }
}

/// The weighted sum of the corners.
#[inline(always)]
fn blend<L: Lanes, T: Stored, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CORNERS, 8, T>,
    base: usize,
    weights: [f32; CORNERS],
) -> L::Oct {
    let corners = T::octs(lanes, block, base);
    let mut sum = corners[0] * lanes.oct_splat(weights[0]);
    let mut corner = 1;
    while corner < CORNERS {
        sum = lanes.oct_mul_add(corners[corner], lanes.oct_splat(weights[corner]), sum);
        corner += 1;
    }
    sum
}

#[inline(always)]
fn mono<L: Lanes, T: Stored, const CELLS: usize, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CELLS, 4, T>,
    base: usize,
    weights: [f32; CORNERS],
    floor: f32,
    out: &mut [f32],
) {
    let cells = T::quads(lanes, block, base);
    let mut sum = 0.0;
    let mut corner = 0;
    while corner < CORNERS {
        let mut four = [0.0; 4];
        lanes.quad_store(&mut four, cells[corner / 4]);
        sum = lanes.scalar_mul_add(four[corner % 4], weights[corner], sum);
        corner += 1;
    }
    out[0] = if sum > floor { sum } else { floor };
}
