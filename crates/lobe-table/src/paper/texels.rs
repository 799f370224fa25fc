//! Indexing and interpolation (paper, section 2.3): a cell is loaded once for all the lanes that lie in it.

use lobe_lane::{Floats, Lanes, MAX_LANES, Mask};

/// RGB in each lane: the corners at `base + offsets[i]`, weighted and summed. Lanes outside the mask have weights of 0.
///
/// # Panics
/// Where a corner of a lane inside the mask lies outside `texels`.
#[inline(always)]
pub(super) fn interpolate<L: Lanes, const CORNERS: usize>(
    lanes: L,
    texels: &[[f32; 3]],
    offsets: &[usize; CORNERS],
    base: L::F,
    weights: &[L::F; CORNERS],
    mask: L::M,
) -> [L::F; 3] {
    let mut active = mask.bits();
    let zero = lanes.splat(0.0);
    let mut sum = [zero; 3];
    if active == 0 {
        return sum;
    }
    let mut indices = [0.0; MAX_LANES];
    lanes.store(&mut indices, base);

    // The coherent case: everything is loaded once and used at once.
    let first = indices[active.trailing_zeros() as usize];
    if shared(lanes, base, first) & active == active {
        let cell = &texels[first as usize..];
        let mut corner = 0;
        while corner < CORNERS {
            let texel = cell[offsets[corner]];
            let mut k = 0;
            while k < 3 {
                sum[k] = lanes.mul_add(lanes.splat(texel[k]), weights[corner], sum[k]);
                k += 1;
            }
            corner += 1;
        }
        return sum;
    }

    // Else cell by cell, the smallest index first, until every lane has its corners.
    let mut corners = [[zero; 3]; CORNERS];
    while active != 0 {
        let mut least = f32::INFINITY;
        let mut lane = 0;
        while lane < L::LANES {
            if active >> lane & 1 == 1 && indices[lane] < least {
                least = indices[lane];
            }
            lane += 1;
        }
        let here = base.eq(lanes.splat(least));
        let cell = &texels[least as usize..];
        let mut corner = 0;
        while corner < CORNERS {
            let texel = cell[offsets[corner]];
            let mut k = 0;
            while k < 3 {
                corners[corner][k] = lanes.select(here, lanes.splat(texel[k]), corners[corner][k]);
                k += 1;
            }
            corner += 1;
        }
        active &= !here.bits();
    }
    let mut corner = 0;
    while corner < CORNERS {
        let mut k = 0;
        while k < 3 {
            sum[k] = lanes.mul_add(corners[corner][k], weights[corner], sum[k]);
            k += 1;
        }
        corner += 1;
    }
    sum
}

/// The lanes whose index is `index`, one bit each: one comparison, as indices are floats.
#[inline(always)]
fn shared<L: Lanes>(lanes: L, base: L::F, index: f32) -> u32 {
    base.eq(lanes.splat(index)).bits()
}
