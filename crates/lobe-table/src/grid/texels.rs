//! The corners of each query, weighted and summed.

use std::ops::Range;

use lobe_lane::{Block, Floats, Lanes};

use super::texel::Stored;
use super::weights::MAX_CORNERS;
use crate::passes::block::{BLOCK, Column};

/// Space for up to three channels of each query of a block, one after the other, and for the fourth float that the last
/// store writes.
pub(crate) type Tile<const B: usize = BLOCK> = [[f32; B]; 4];

/// Queries per iteration of the loop over texels, if there are as many lanes.
const TURN: usize = 8;

/// The places of queries in a table.
#[derive(Clone, Copy)]
pub(crate) struct Located<'a, const B: usize = BLOCK> {
    /// The index of the first corner.
    pub(crate) base: &'a Column<i32, B>,
    pub(crate) weights: &'a [Column<f32, B>; MAX_CORNERS],
}

/// Two or three channels: `CORNERS` pairs of neighbours along the last axis. Writes three floats per query, starting
/// with the first, none less than `floor`. `n` is a multiple of the lanes.
#[inline(always)]
pub(crate) fn rgb<L: Lanes, T: Stored, const CORNERS: usize, const B: usize>(
    lanes: L,
    n: usize,
    corners: &Block<'_, CORNERS, 8, T>,
    located: Located<'_, B>,
    phi: &Column<f32, B>,
    floor: f32,
    tile: &mut Tile<B>,
) {
    let floor = lanes.quad_splat(floor);
    let turn = if L::LANES < TURN { L::LANES } else { TURN };
    let mut first = 0;
    while first < n {
        // A few queries per iteration, which the compiler unrolls: the loop overhead would otherwise be a tenth of the
        // work.
        let mut query = first;
        while query < first + turn {
            let [low, high] = pair(lanes, query, corners, located);
            let texel = lanes.quad_mul_add(lanes.quad_splat(phi.one(query)), high - low, low);
            // Each store writes one extra float, which the next store overwrites.
            lanes.quad_store(&mut tile.as_flattened_mut()[3 * (query & (B - 1))..][..4], lanes.quad_max(texel, floor));
            query += 1;
        }
        first += turn;
    }
}

/// Like [`rgb`], with texels whose fourth float says whether there is a value: texels without one are all 0 and are
/// left out of the average. 0 if no texel has a value.
#[inline(always)]
pub(crate) fn measured<L: Lanes, T: Stored, const CORNERS: usize, const B: usize>(
    lanes: L,
    n: usize,
    corners: &Block<'_, CORNERS, 8, T>,
    located: Located<'_, B>,
    phi: &Column<f32, B>,
    tile: &mut Tile<B>,
) {
    let mut query = 0;
    while query < n {
        let [low, high] = pair(lanes, query, corners, located);
        // Nothing is subtracted, so that a measured corner with a small weight keeps its digits if it is the only one.
        let upper = phi.one(query);
        let texel = lanes.quad_mul_add(lanes.quad_splat(upper), high, low * lanes.quad_splat(1.0 - upper));
        let mut four = [0.0; 4];
        lanes.quad_store(&mut four, texel);
        let scale = if four[3] > 0.0 { 1.0 / four[3] } else { 0.0 };
        // Each store writes one extra float, which the next store overwrites.
        lanes.quad_store(&mut tile.as_flattened_mut()[3 * (query & (B - 1))..][..4], texel * lanes.quad_splat(scale));
        query += 1;
    }
}

/// The weighted sum of the texel pairs of one query: the lower and the upper neighbour in phi.
#[inline(always)]
fn pair<L: Lanes, T: Stored, const CORNERS: usize, const B: usize>(
    lanes: L,
    query: usize,
    corners: &Block<'_, CORNERS, 8, T>,
    Located { base, weights }: Located<'_, B>,
) -> [L::Quad; 2] {
    let pairs = T::octs(lanes, corners, base.one(query) as u32 as usize);
    let mut sum = pairs[0] * lanes.oct_splat(weights[0].one(query));
    let mut corner = 1;
    while corner < CORNERS {
        sum = lanes.oct_mul_add(pairs[corner], lanes.oct_splat(weights[corner].one(query)), sum);
        corner += 1;
    }
    lanes.oct_halves(sum)
}

/// One texel of up to three channels per query, as stored.
#[inline(always)]
pub(crate) fn nearest<L: Lanes, T: Stored, const B: usize>(
    lanes: L,
    n: usize,
    texels: &Block<'_, 1, 4, T>,
    base: &Column<i32, B>,
    tile: &mut Tile<B>,
) {
    let mut query = 0;
    while query < n {
        let [texel] = T::quads(lanes, texels, base.one(query) as u32 as usize);
        // Each store writes one extra float, which the next store overwrites.
        lanes.quad_store(&mut tile.as_flattened_mut()[3 * (query & (B - 1))..][..4], texel);
        query += 1;
    }
}

/// One channel: `CORNERS` cells of four corners along the last two axes. Writes one float per query, none less than
/// `floor`. `n` is a multiple of the lanes.
#[inline(always)]
pub(crate) fn mono<L: Lanes, T: Stored, const CORNERS: usize, const B: usize>(
    lanes: L,
    n: usize,
    corners: &Block<'_, CORNERS, 4, T>,
    Located { base, weights }: Located<'_, B>,
    floor: f32,
    tile: &mut Tile<B>,
) {
    let floor = lanes.splat(floor);
    let mut query = 0;
    while query < n {
        let cells = T::gather(lanes, corners, base.slice(lanes, query));
        let mut sum = lanes.splat(0.0);
        let mut corner = 0;
        while corner < 4 * CORNERS {
            sum = lanes.mul_add(cells[corner / 4][corner % 4], weights[corner].load(lanes, query), sum);
            corner += 1;
        }
        lanes.store(&mut tile.as_flattened_mut()[query & (B - L::LANES)..][..L::LANES], sum.max(floor));
        query += L::LANES;
    }
}

/// Many channels: `CORNERS` nodes of all channels, padded to eights; lanes run along the channels. Writes the channels
/// `channels`, which start at a multiple of eight, one query after the other, none less than `floor`.
#[inline(always)]
pub(crate) fn wide<L: Lanes, T: Stored, const CORNERS: usize, const B: usize>(
    lanes: L,
    corners: &Block<'_, CORNERS, 8, T>,
    channels: Range<usize>,
    Located { base, weights }: Located<'_, B>,
    floor: f32,
    out: &mut [f32],
) {
    let floor = lanes.oct_splat(floor);
    for (query, texel) in out.chunks_exact_mut(channels.len()).enumerate() {
        let base = base.one(query) as u32 as usize + channels.start;
        for (chunk, target) in texel.chunks_mut(8).enumerate() {
            let nodes = T::octs(lanes, corners, base + 8 * chunk);
            let mut sum = nodes[0] * lanes.oct_splat(weights[0].one(query));
            let mut corner = 1;
            while corner < CORNERS {
                sum = lanes.oct_mul_add(nodes[corner], lanes.oct_splat(weights[corner].one(query)), sum);
                corner += 1;
            }
            sum = lanes.oct_max(sum, floor);
            if target.len() == 8 {
                lanes.oct_store(target, sum);
            } else {
                let mut whole = [0.0; 8];
                lanes.oct_store(&mut whole, sum);
                target.copy_from_slice(&whole[..target.len()]);
            }
        }
    }
}
