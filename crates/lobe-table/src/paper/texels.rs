//! Indexing and interpolation (paper, section 2.3): a cell is loaded once for all lanes in it.

use lobe_lane::{Floats, Lanes, MAX_LANES, Mask};

/// RGB in each lane: the corners at `base + offsets[i]`, weighted and summed. Lanes outside the mask have weights of 0.
///
/// # Panics
/// If a corner of a lane inside the mask is outside `texels`.
#[inline(always)]
pub(super) fn interpolate<L: Lanes, const CORNERS: usize>(
    lanes: L,
    texels: &[[f32; 3]],
    offsets: &[usize; CORNERS],
    base: L::F,
    weights: &[L::F; CORNERS],
    mask: L::M,
) -> [L::F; 3] {
    let zero = lanes.splat(0.0);
    let mut sum = [zero; 3];
    let active = mask.bits();
    if active == 0 {
        return sum;
    }

    // The coherent case: everything is loaded once and used at once.
    let first = lanes.extract(base, active.trailing_zeros() as usize);
    if base.eq(lanes.splat(first)).bits() & active == active {
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

    // Otherwise cell by cell, the smallest index first, until every lane has its corners. Finished lanes wait at
    // infinity.
    let done = lanes.splat(f32::INFINITY);
    let mut waiting = lanes.select(mask, base, done);
    let mut corners = [[zero; 3]; CORNERS];
    loop {
        let least = minimum(lanes, waiting);
        if least == f32::INFINITY {
            break;
        }
        let here = waiting.eq(lanes.splat(least));
        let cell = &texels[least as usize..];
        let mut corner = 0;
        while corner < CORNERS {
            let texel = cell[offsets[corner]];
            let mut k = 0;
            while k < 3 {
                // Each lane is loaded once, and added to zero. A select here would become a masked store, which takes
                // dozens of steps on some CPUs.
                corners[corner][k] = corners[corner][k] + lanes.splat(texel[k]).masked(here);
                k += 1;
            }
            corner += 1;
        }
        waiting = lanes.select(here, done, waiting);
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

/// The smallest of all lanes.
#[inline(always)]
fn minimum<L: Lanes>(lanes: L, x: L::F) -> f32 {
    let mut buffer = [0.0; MAX_LANES];
    lanes.store(&mut buffer, x);
    let mut least = buffer[0];
    let mut lane = 1;
    while lane < L::LANES {
        least = if buffer[lane] < least { buffer[lane] } else { least };
        lane += 1;
    }
    least
}
