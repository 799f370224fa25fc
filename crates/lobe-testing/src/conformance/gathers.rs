//! Gathers, with indices inside, outside and far outside tables of every small length.

use half::f16;
use lobe_lane::{Block, Kernel, Lanes, MAX_LANES};

use super::{floats, ints};
use crate::patterns;

/// Every gather and look-up of `Lanes`.
#[derive(Clone, Copy)]
pub struct Gathers;

impl Kernel for Gathers {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let indices = patterns::padded(patterns::INTS.to_vec());
        for len in (1..=9).chain([31, 64, 65, 1000]) {
            singles(lanes, &indices, len);
        }
        for len in [30, 31, 64, 200] {
            let table: Vec<f32> = (0..len).map(|i| i as f32 + 0.5).collect();
            quads(lanes, &indices, Block::new(&table, [0]));
            quads(lanes, &indices, Block::new(&table, [4, 0]));
            quads(lanes, &indices, Block::new(&table, [0, 5, 13, 26]));
            let halves: Vec<u16> = (0..len).map(|i| f16::from_f32(i as f32 + 0.5).to_bits()).collect();
            half_quads(lanes, &indices, Block::new(&halves, [0]));
            half_quads(lanes, &indices, Block::new(&halves, [0, 5, 13, 26]));
        }
        let eight: [f32; 8] = std::array::from_fn(|i| i as f32 + 0.5);
        let mut at = 0;
        while at < indices.len() {
            let found = floats(lanes, lanes.oct_lookup(lanes.oct_load(&eight), lanes.load_int(&indices[at..])));
            for lane in 0..L::LANES {
                let index = indices[at + lane];
                assert_eq!(found[lane], eight[(index & 7) as usize], "oct_lookup at {index}");
            }
            at += L::LANES;
        }
        look_ups::<L, 1>(lanes, &indices);
        look_ups::<L, 2>(lanes, &indices);
        look_ups::<L, 4>(lanes, &indices);
        descents(lanes, &indices);
    }
}

/// Tables in registers: only the low bits of an index matter, as many as the table needs.
#[inline(always)]
fn look_ups<L: Lanes, const N: usize>(lanes: L, indices: &[i32]) {
    let entries: [f32; 4 * MAX_LANES] = std::array::from_fn(|i| i as f32 + 0.5);
    let mut table = [lanes.splat(0.0); N];
    for (register, of) in table.iter_mut().enumerate() {
        *of = lanes.load(&entries[register * L::LANES..]);
    }
    let last = (N * L::LANES - 1) as i32;
    let all = (0..=last).chain(indices.iter().copied());
    let all = patterns::padded(all.collect::<Vec<_>>());
    let mut at = 0;
    while at < all.len() {
        let found = floats(lanes, lanes.look_up(table, lanes.load_int(&all[at..])));
        for lane in 0..L::LANES {
            let index = all[at + lane];
            assert_eq!(found[lane], entries[(index & last) as usize], "look_up at {index} of {N} registers");
        }
        at += L::LANES;
    }
}

/// Steps down a tree: only the sign bit decides, even for zeros and NaN.
#[inline(always)]
fn descents<L: Lanes>(lanes: L, indices: &[i32]) {
    for &bits in &patterns::FLOATS {
        let difference = lanes.splat(f32::from_bits(bits));
        let mut at = 0;
        while at < indices.len() {
            let found = ints(lanes, lanes.descend(lanes.load_int(&indices[at..]), difference));
            for lane in 0..L::LANES {
                let node = indices[at + lane];
                assert_eq!(found[lane], node << 1 | (bits >> 31) as i32, "a step from {node} by {bits:#x}");
            }
            at += L::LANES;
        }
    }
}

/// An index out of range, even a negative one, reads the last entry.
fn clamped(index: i32, last: usize) -> usize {
    usize::try_from(index).map_or(last, |index| index.min(last))
}

#[inline(always)]
fn singles<L: Lanes>(lanes: L, indices: &[i32], len: usize) {
    let table: Vec<f32> = (0..len).map(|i| i as f32 + 0.5).collect();
    let mut at = 0;
    while at < indices.len() {
        let found = floats(lanes, lanes.gather(&table, lanes.load_int(&indices[at..])));
        for lane in 0..L::LANES {
            let entry = clamped(indices[at + lane], len - 1);
            assert_eq!(found[lane], table[entry], "gather at {} of {len}", indices[at + lane]);
        }
        at += L::LANES;
    }
    // Behind no float and behind one: in one of these tables pairs are not aligned to their size, and need not be.
    let mut pairs = vec![0.5_f32; 2 * len + 1];
    for start in [0, 1] {
        for entry in 0..len {
            pairs[start + 2 * entry] = entry as f32;
            pairs[start + 2 * entry + 1] = -(entry as f32) - 0.5;
        }
        let (pairs, _) = pairs[start..].as_chunks::<2>();
        pairs_of(lanes, indices, &pairs[..len]);
    }
}

#[inline(always)]
fn pairs_of<L: Lanes>(lanes: L, indices: &[i32], pairs: &[[f32; 2]]) {
    let len = pairs.len();
    let mut at = 0;
    while at < indices.len() {
        let [first, second] = lanes.gather_pair(pairs, lanes.load_int(&indices[at..]));
        let (first, second) = (floats(lanes, first), floats(lanes, second));
        for lane in 0..L::LANES {
            let entry = clamped(indices[at + lane], len - 1);
            assert_eq!([first[lane], second[lane]], pairs[entry], "gather_pair at {} of {len}", indices[at + lane]);
        }
        at += L::LANES;
    }
}

#[inline(always)]
fn quads<L: Lanes, const N: usize>(lanes: L, indices: &[i32], block: Block<'_, N, 4>) {
    let mut at = 0;
    while at < indices.len() {
        let found = lanes.gather_quads(&block, lanes.load_int(&indices[at..]));
        let other = lanes.gather_quads_at(&block, &indices[at..]);
        for (corner, found) in found.into_iter().enumerate() {
            for (k, found) in found.into_iter().enumerate() {
                let column = floats(lanes, found);
                assert_eq!(column, floats(lanes, other[corner][k]), "bases in registers and in memory");
                for lane in 0..L::LANES {
                    let base = clamped(indices[at + lane], block.last_base());
                    let expected = block.data()[base + block.offsets()[corner] + k];
                    assert_eq!(column[lane], expected, "corner {corner}, float {k}, base {}", indices[at + lane]);
                }
            }
        }
        at += L::LANES;
    }
}

#[inline(always)]
fn half_quads<L: Lanes, const N: usize>(lanes: L, indices: &[i32], block: Block<'_, N, 4, u16>) {
    let mut at = 0;
    while at < indices.len() {
        let found = lanes.gather_quads_half(&block, lanes.load_int(&indices[at..]));
        for (corner, found) in found.into_iter().enumerate() {
            for (k, found) in found.into_iter().enumerate() {
                let column = floats(lanes, found);
                for lane in 0..L::LANES {
                    let base = clamped(indices[at + lane], block.last_base());
                    let expected = f16::from_bits(block.data()[base + block.offsets()[corner] + k]).to_f32();
                    assert_eq!(column[lane], expected, "corner {corner}, half {k}, base {}", indices[at + lane]);
                }
            }
        }
        at += L::LANES;
    }
}
