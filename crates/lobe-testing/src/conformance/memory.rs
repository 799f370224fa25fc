//! Loads and stores, whole and partial, at every alignment.

use lobe_lane::{Floats as _, Kernel, Lanes, MAX_LANES};

use super::{floats, ints};
use crate::patterns;

/// A float that no test writes, to detect the elements that a store leaves untouched.
const UNTOUCHED: f32 = -12345.5;
/// An integer that no test writes.
const UNTOUCHED_INT: i32 = 0x0bad_cafe;

/// Every load and store of `Lanes`.
#[derive(Clone, Copy)]
pub struct Memory;

impl Kernel for Memory {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        whole(lanes);
        partial(lanes);
        keeps_bits(lanes);
        vectors(lanes);
        // It has no visible effect, but it must leave its argument untouched.
        for at in [0, 1, 63, 1 << 20, usize::MAX] {
            lanes.prefetch::<4, f32>(&[1.0; 3], at);
            lanes.prefetch::<1, [u64; 9]>(&[], at);
        }
    }
}

#[inline(always)]
fn whole<L: Lanes>(lanes: L) {
    let source: Vec<f32> = (0..2 * MAX_LANES).map(|i| i as f32 + 0.25).collect();
    let numbers: Vec<i32> = (0..2 * MAX_LANES as i32).map(|i| 7 * i - 100).collect();
    for at in 0..MAX_LANES {
        let mut target = [UNTOUCHED; 2 * MAX_LANES];
        lanes.store(&mut target[at..], lanes.load(&source[at..]));
        let mut integers = [UNTOUCHED_INT; 2 * MAX_LANES];
        lanes.store_int(&mut integers[at..], lanes.load_int(&numbers[at..]));
        for i in 0..2 * MAX_LANES {
            let inside = (at..at + L::LANES).contains(&i);
            assert_eq!(target[i], if inside { source[i] } else { UNTOUCHED }, "{i} of a store at {at}");
            assert_eq!(integers[i], if inside { numbers[i] } else { UNTOUCHED_INT }, "{i} of a store_int at {at}");
        }
    }
}

/// Every length from zero to more than a register.
#[inline(always)]
fn partial<L: Lanes>(lanes: L) {
    let source: Vec<f32> = (1..=MAX_LANES + 3).map(|i| i as f32).collect();
    let numbers: Vec<i32> = (1..=MAX_LANES as i32 + 3).map(|i| -i).collect();
    for len in 0..=L::LANES + 3 {
        let loaded = floats(lanes, lanes.load_partial(&source[..len]));
        for i in 0..L::LANES {
            let expected = if i < len { source[i] } else { 0.0 };
            assert_eq!(loaded[i].to_bits(), expected.to_bits(), "lane {i} of a load of {len}");
        }
        let mut target = vec![UNTOUCHED; len + 2];
        lanes.store_partial(&mut target[1..=len], lanes.load(&source));
        let mut integers = vec![UNTOUCHED_INT; len + 2];
        lanes.store_int_partial(&mut integers[1..=len], lanes.load_int(&numbers));
        for i in 0..len + 2 {
            let inside = (1..=len.min(L::LANES)).contains(&i);
            assert_eq!(target[i], if inside { source[i - 1] } else { UNTOUCHED }, "{i} of a store of {len}");
            assert_eq!(integers[i], if inside { numbers[i - 1] } else { UNTOUCHED_INT }, "{i} of a store_int of {len}");
        }
    }
}

/// Loads and stores keep every bit, including those of NaN.
#[inline(always)]
fn keeps_bits<L: Lanes>(lanes: L) {
    let (xs, _) = patterns::pairs(&patterns::floats());
    let mut at = 0;
    while at < xs.len() {
        let x = lanes.load(&xs[at..]);
        let (stored, bits) = (floats(lanes, x), ints(lanes, x.bits()));
        for lane in 0..L::LANES {
            assert_eq!(stored[lane].to_bits(), xs[at + lane].to_bits());
            assert_eq!(bits[lane] as u32, xs[at + lane].to_bits());
        }
        at += L::LANES;
    }
}

#[inline(always)]
fn vectors<L: Lanes>(lanes: L) {
    let source: Vec<[f32; 3]> = (0..2 * MAX_LANES).map(|i| [0.0, 0.25, 0.5].map(|part| i as f32 + part)).collect();
    for at in 0..=MAX_LANES {
        let [x, y, z] = lanes.load_xyz(&source[at..]);
        let found = [floats(lanes, x), floats(lanes, y), floats(lanes, z)];
        for lane in 0..L::LANES {
            assert_eq!(found.map(|column| column[lane]), source[at + lane], "vector {lane} at {at}");
        }
    }
    // The last vectors of a slice, beyond which nothing may be read.
    let exact: Vec<[f32; 3]> = source[..L::LANES].to_vec();
    let [_, _, z] = lanes.load_xyz(&exact);
    assert_eq!(floats(lanes, z)[L::LANES - 1], exact[L::LANES - 1][2]);
}
