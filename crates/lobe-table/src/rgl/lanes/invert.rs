//! From positions on the unit square back to the uniform positions from which a [`Warp`] samples them, and densities.

use lobe_lane::{Block, Floats, Lanes};

use super::grid::Places;
use super::warp::Warp;
use crate::grid::weights::MAX_CORNERS;
use crate::passes::block::Column;

/// The slices that the queries of a block blend: the first of each, and the weights of all.
#[derive(Clone, Copy)]
pub(super) struct Blend {
    /// The slice, from 0.
    pub(super) slice: Column<i32>,
    /// The weights of two or four slices.
    pub(super) weights: [Column; MAX_CORNERS],
}

impl Blend {
    pub(super) const ZERO: Self = Blend { slice: Column::<i32>::ZERO, weights: [Column::<f32>::ZERO; MAX_CORNERS] };
}

/// The row of a cell and the next, blended: at a fraction between them, the density, in cells, at the left and the
/// right end, and the integral up to the left end.
#[inline(always)]
pub(super) fn columns<L: Lanes, const SLICES: usize>(
    lanes: L,
    cells: &[Block<'_, 3, 4>; 2],
    bases: &[i32],
    weights: [L::F; SLICES],
    y: L::F,
) -> [L::F; 3] {
    let ends = [lanes.splat(1.0) - y, y];
    let mut sums = [lanes.splat(0.0); 3];
    let mut slice = 0;
    while slice < SLICES {
        let [integral, left, right] = lanes.gather_quads_at(&cells[slice / 2], bases);
        let mut corner = 0;
        while corner < 4 {
            let weight = weights[slice + corner / 2] * ends[corner % 2];
            sums[0] = lanes.mul_add(left[corner], weight, sums[0]);
            sums[1] = lanes.mul_add(right[corner], weight, sums[1]);
            sums[2] = lanes.mul_add(integral[corner], weight, sums[2]);
            corner += 1;
        }
        slice += 2;
    }
    sums
}

/// The integrals of a row and the next, and the integral below the row, blended.
#[inline(always)]
pub(super) fn rows<L: Lanes, const SLICES: usize>(
    lanes: L,
    rows: &[Block<'_, 2, 4>; 2],
    bases: &[i32],
    weights: [L::F; SLICES],
) -> [L::F; 3] {
    let mut sums = [lanes.splat(0.0); 3];
    let mut slice = 0;
    while slice < SLICES {
        let [here, next] = lanes.gather_quads_at(&rows[slice / 2], bases);
        let mut k = 0;
        while k < 2 {
            let weight = weights[slice + k];
            sums[0] = lanes.mul_add(here[2 + k], weight, sums[0]);
            sums[1] = lanes.mul_add(next[2 + k], weight, sums[1]);
            sums[2] = lanes.mul_add(here[k], weight, sums[2]);
            k += 1;
        }
        slice += 2;
    }
    sums
}

/// The weights of the slices.
#[inline(always)]
pub(super) fn slices<L: Lanes, const SLICES: usize>(lanes: L, query: usize, blend: &Blend) -> [L::F; SLICES] {
    let mut weights = [lanes.splat(0.0); SLICES];
    let mut slice = 0;
    while slice < SLICES {
        weights[slice] = blend.weights[slice].load(lanes, query);
        slice += 1;
    }
    weights
}

/// The integral from 0 to `t` of a linear function with values `a` at 0 and `b` at 1.
#[inline(always)]
fn integral<L: Lanes>(lanes: L, a: L::F, b: L::F, t: L::F) -> L::F {
    t * lanes.mul_add(lanes.splat(0.5) * t, b - a, a)
}

/// The result of an inversion.
pub(super) struct Inverse<'a> {
    /// The uniform positions.
    pub(super) s: &'a mut [Column; 2],
    /// The density over the unit square.
    pub(super) density: &'a mut Column,
}

/// The uniform positions that map to `u`, at `places`, for queries `0..n`, and the density there.
#[inline(always)]
pub(super) fn run<L: Lanes, const SLICES: usize>(
    lanes: L,
    n: usize,
    warp: &Warp,
    u: &[Column; 2],
    blend: &Blend,
    places: &Places,
    Inverse { s, density }: Inverse<'_>,
) {
    let (cells, row_blocks) = (warp.cells(), warp.rows());
    let mut row_bases: Column<i32> = Column::<i32>::ZERO;
    let placer = warp.grid.placer(lanes);
    let ends = warp.ends();
    let scale = lanes.splat(warp.scale);

    // The integral of the row so far comes first, separately: the texels of the two loads are far apart.
    let mut query = 0;
    while query < n {
        let weights = slices::<L, SLICES>(lanes, query, blend);
        let [x, y] = [places.fractions[0].load(lanes, query), places.fractions[1].load(lanes, query)];
        let [left, right, before] = columns(lanes, &cells, places.base.slice(lanes, query), weights, y);
        s[0].store(lanes, query, before + integral(lanes, left, right, x));
        density.store(lanes, query, lanes.mul_add(x, right - left, left) * scale);
        let ([_, row], _) = placer.cells(lanes, [u[0].load(lanes, query), u[1].load(lanes, query)]);
        let row = row * lanes.splat_int(ends.stride) + ends.of_slice(lanes, blend.slice.load(lanes, query));
        row_bases.store(lanes, query, row);
        query += L::LANES;
    }

    let mut query = 0;
    while query < n {
        let weights = slices::<L, SLICES>(lanes, query, blend);
        let y = places.fractions[1].load(lanes, query);
        let [here, next, below] = rows(lanes, &row_blocks, row_bases.slice(lanes, query), weights);
        let total = lanes.mul_add(y, next - here, here);
        let x = (s[0].load(lanes, query) / total).masked(lanes.splat(0.0).lt(total));
        s[0].store(lanes, query, x);
        s[1].store(lanes, query, below + integral(lanes, here, next, y));
        query += L::LANES;
    }
}

/// The density over the unit square at `places` of queries `0..n`, multiplied into `density`.
#[inline(always)]
pub(super) fn multiply_density<L: Lanes, const SLICES: usize>(
    lanes: L,
    n: usize,
    warp: &Warp,
    blend: &Blend,
    places: &Places,
    density: &mut Column,
) {
    let cells = warp.cells();
    let scale = lanes.splat(warp.scale);
    let mut query = 0;
    while query < n {
        let weights = slices::<L, SLICES>(lanes, query, blend);
        let [x, y] = [places.fractions[0].load(lanes, query), places.fractions[1].load(lanes, query)];
        let [left, right, _] = columns(lanes, &cells, places.base.slice(lanes, query), weights, y);
        let here = lanes.mul_add(x, right - left, left) * scale;
        density.store(lanes, query, density.load(lanes, query) * here);
        query += L::LANES;
    }
}
