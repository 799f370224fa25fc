//! The corners of each query, weighted and summed.

use lobe_lane::{Block, Floats, Lanes};

use super::block::{BLOCK, Column};
use super::weights::MAX_CORNERS;

/// Room for up to three channels of each query of a block, and for the fourth float that the last store writes.
pub(crate) type Tile = [f32; 3 * BLOCK + 1];

/// Base indices and corner weights.
type Located<'a> = (&'a Column<i32>, &'a [Column; MAX_CORNERS]);

/// Two or three channels: `CORNERS` pairs of neighbours in phi. Writes three floats a query, from the first, none less
/// than `floor`. `n` is a multiple of the lanes.
#[inline(always)]
pub(crate) fn rgb<L: Lanes, const CORNERS: usize>(
    lanes: L,
    n: usize,
    corners: &Block<'_, CORNERS, 8>,
    ((base, weights), phi): (Located<'_>, &Column),
    floor: f32,
    tile: &mut Tile,
) {
    let floor = lanes.quad_splat(floor);
    let mut first = 0;
    while first < n {
        // A few queries a turn, which the compiler writes out: the loop itself would be a tenth of the work.
        let mut query = first;
        while query < first + L::LANES {
            let pairs = lanes.oct_corners(corners, base.one(query) as u32 as usize);
            let mut sum = pairs[0] * lanes.oct_splat(weights[0].one(query));
            let mut corner = 1;
            while corner < CORNERS {
                sum = lanes.oct_mul_add(pairs[corner], lanes.oct_splat(weights[corner].one(query)), sum);
                corner += 1;
            }
            let [low, high] = lanes.oct_halves(sum);
            let texel = lanes.quad_mul_add(lanes.quad_splat(phi.one(query)), high - low, low);
            // Each store writes a float too many, which the next one overwrites.
            lanes.quad_store(&mut tile[3 * (query & (BLOCK - 1))..][..4], lanes.quad_max(texel, floor));
            query += 1;
        }
        first += L::LANES;
    }
}

/// One channel: `CORNERS` cells of four corners in theta and phi. Writes one float a query, none less than `floor`. `n`
/// is a multiple of the lanes.
#[inline(always)]
pub(crate) fn mono<L: Lanes, const CORNERS: usize>(
    lanes: L,
    n: usize,
    corners: &Block<'_, CORNERS, 4>,
    (base, weights): Located<'_>,
    floor: f32,
    tile: &mut Tile,
) {
    let floor = lanes.splat(floor);
    let mut query = 0;
    while query < n {
        let cells = lanes.gather_quads(corners, base.load(lanes, query));
        let mut sum = lanes.splat(0.0);
        let mut corner = 0;
        while corner < 4 * CORNERS {
            sum = lanes.mul_add(cells[corner / 4][corner % 4], weights[corner].load(lanes, query), sum);
            corner += 1;
        }
        lanes.store(&mut tile[query & (BLOCK - L::LANES)..][..L::LANES], sum.max(floor));
        query += L::LANES;
    }
}

/// Many channels: `CORNERS` nodes of `channels` floats each, padded to eights; lanes run along the channels. Writes
/// `channels` floats a query, beginning with channel `from`, a multiple of
/// eight, none less than `floor`.
#[inline(always)]
pub(crate) fn wide<L: Lanes, const CORNERS: usize>(
    lanes: L,
    corners: &Block<'_, CORNERS, 8>,
    (from, channels): (usize, usize),
    (base, weights): Located<'_>,
    floor: f32,
    out: &mut [f32],
) {
    let floor = lanes.oct_splat(floor);
    for (query, texel) in out.chunks_exact_mut(channels).enumerate() {
        let base = base.one(query) as u32 as usize + from;
        for (chunk, target) in texel.chunks_mut(8).enumerate() {
            let nodes = lanes.oct_corners(corners, base + 8 * chunk);
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
