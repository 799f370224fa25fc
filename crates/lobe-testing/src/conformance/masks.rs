//! Masks, and operations that create values or extract single lanes.

use lobe_lane::{Floats as _, Ints as _, Kernel, Lanes, MAX_LANES, Mask as _};

use super::{assert_same, floats, ints};
use crate::patterns;

/// Every method of `Mask`, and those of `Lanes` that splat, count or extract.
#[derive(Clone, Copy)]
pub struct Masks;

impl Kernel for Masks {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        assert!(L::LANES.is_power_of_two() && L::LANES <= MAX_LANES, "{} lanes", L::LANES);
        assert!(L::Narrow::LANES <= L::LANES, "{} of {} lanes", L::Narrow::LANES, L::LANES);
        assert_eq!(L::Narrow::FUSED, L::FUSED, "one query rounds like many");
        logic(lanes);
        first_lanes(lanes);
        splats(lanes);
        extractions(lanes);
        uniform(lanes);
    }
}

/// A mask whose lane `i` is set if bit `i` of `bits` is set.
#[inline(always)]
fn mask<L: Lanes>(lanes: L, bits: u32) -> L::M {
    let mut flags = [0; MAX_LANES];
    let mut lane = 0;
    while lane < MAX_LANES {
        flags[lane] = (bits >> lane & 1) as i32;
        lane += 1;
    }
    lanes.load_int(&flags).eq(lanes.splat_int(1))
}

/// Every bit pattern of up to eight lanes, and many of those of sixteen.
fn all_bits(lanes: usize) -> impl Iterator<Item = u32> + Clone {
    (0..1u32 << lanes).step_by(if lanes > 8 { 37 } else { 1 }).chain([(1u32 << lanes) - 1])
}

#[inline(always)]
fn logic<L: Lanes>(lanes: L) {
    let whole = ((1u64 << L::LANES) - 1) as u32;
    for x in all_bits(L::LANES) {
        let a = mask(lanes, x);
        assert_eq!(a.bits(), x);
        assert_eq!((!a).bits(), x ^ whole, "!{x:b}");
        assert_eq!(a.any(), x != 0, "any of {x:b}");
        assert_eq!(a.all(), x == whole, "all of {x:b}");
        for y in all_bits(L::LANES).step_by(if L::LANES > 4 { 11 } else { 1 }) {
            let b = mask(lanes, y);
            assert_eq!((a & b).bits(), x & y, "{x:b} & {y:b}");
            assert_eq!((a | b).bits(), x | y, "{x:b} | {y:b}");
            assert_eq!((a ^ b).bits(), x ^ y, "{x:b} ^ {y:b}");
        }
    }
}

#[inline(always)]
fn first_lanes<L: Lanes>(lanes: L) {
    for n in (0..=MAX_LANES + 1).chain([i32::MAX as usize, i32::MAX as usize + 1, (1u64 << 32) as usize, usize::MAX]) {
        assert_eq!(lanes.first_n(n).bits(), ((1u64 << n.min(L::LANES)) - 1) as u32, "first {n}");
    }
    let four = [3.0, -0.0, f32::INFINITY, 0.5];
    let found = floats(lanes, lanes.first_four(four));
    for lane in 0..L::LANES {
        assert_same("first_four", &[&lane], found[lane], if lane < 4 { four[lane] } else { 0.0 });
    }
}

#[inline(always)]
fn splats<L: Lanes>(lanes: L) {
    for &bits in &patterns::FLOATS {
        let found = ints(lanes, lanes.splat(f32::from_bits(bits)).bits());
        assert!(found[..L::LANES].iter().all(|&x| x as u32 == bits), "splat of {bits:#x}: {found:x?}");
    }
    for &x in &patterns::INTS {
        let found = ints(lanes, lanes.splat_int(x));
        assert!(found[..L::LANES].iter().all(|&found| found == x), "splat_int of {x}: {found:?}");
    }
    let [x, y, z] = lanes.splat_xyz([1.0, -0.0, 3.0]);
    for lane in 0..L::LANES {
        let vector = lanes.extract_xyz([x, y, z], lane);
        assert_eq!(vector.map(f32::to_bits), [1.0f32, -0.0, 3.0].map(f32::to_bits));
    }
}

#[inline(always)]
fn extractions<L: Lanes>(lanes: L) {
    let iota = lanes.iota();
    let halves = iota.to_float() * lanes.splat(0.5);
    for lane in 0..2 * MAX_LANES {
        let expected = (lane % L::LANES) as i32;
        assert_eq!(lanes.extract_int(iota, lane), expected, "lane {lane}");
        assert_eq!(lanes.extract(halves, lane), 0.5 * expected as f32, "lane {lane}");
        assert_eq!(lanes.extract_xyz([halves, -halves, halves + halves], lane), {
            let half = 0.5 * expected as f32;
            [half, -half, half + half]
        });
    }
}

/// Checks `uniform` for every mask, with lanes that all agree and with one lane that differs.
#[inline(always)]
fn uniform<L: Lanes>(lanes: L) {
    for odd in 0..=L::LANES {
        let mut index = [5; MAX_LANES];
        if odd < L::LANES {
            index[odd] = -7;
        }
        for set in all_bits(L::LANES) {
            let values: Vec<i32> = (0..L::LANES).filter(|lane| set >> lane & 1 == 1).map(|lane| index[lane]).collect();
            let expected = !values.is_empty() && values.iter().all(|value| *value == values[0]);
            let (found, value) = lanes.uniform(lanes.load_int(&index), mask(lanes, set));
            assert_eq!(found, expected, "uniform of {values:?}");
            assert!(!expected || value == values[0], "uniform of {values:?}: {value}");
        }
    }
}
