//! Values on which implementations differ.

/// Number of patterns of each type; all pairs fill whole vectors of 16 lanes.
const COUNT: usize = 60;

/// Bits of floats: zeros, denormals, infinities, NaNs of all kinds, the ends of the ranges of `i32` and of whole
/// numbers.
pub const FLOATS: [u32; COUNT] = [
    0x0000_0000,
    0x8000_0000,
    0x0000_0001,
    0x8000_0001,
    0x007f_ffff,
    0x807f_ffff,
    0x0080_0000,
    0x8080_0000,
    0x3f80_0000,
    0xbf80_0000,
    0x3f7f_ffff,
    0xbf7f_ffff,
    0x3f80_0001,
    0xbf80_0001,
    0x3f00_0000,
    0xbf00_0000,
    0x7f80_0000,
    0xff80_0000,
    0x7fc0_0000,
    0xffc0_0000,
    0x7f80_0001,
    0xff80_0001,
    0x7fff_ffff,
    0xffff_ffff,
    0x7f7f_ffff,
    0xff7f_ffff,
    0x7f00_0000,
    0xff00_0000,
    0x4f00_0000,
    0xcf00_0000,
    0x4eff_ffff,
    0xcf00_0001,
    0x4f80_0000,
    0xcf80_0000,
    0x4b80_0000,
    0xcb80_0000,
    0x4b80_0001,
    0x4b00_0000,
    0x4aff_ffff,
    0xcb00_0001,
    0x3fc0_0000,
    0x4020_0000,
    0xbfc0_0000,
    0xc020_0000,
    0x4000_0000,
    0x4040_0000,
    0x3dcc_cccd,
    0xbdcc_cccd,
    0x4049_0fdb,
    0xc049_0fdb,
    0x3fc9_0fdb,
    0x40c9_0fdb,
    0x3eaa_aaab,
    0x3f35_04f3,
    0x0da2_4260,
    0x8da2_4260,
    0x7149_f2ca,
    0xf149_f2ca,
    0x1e3c_e508,
    0x47f1_2066,
];

/// Integers: the ends of the range, rounding ties of the conversion to `f32`, indices just inside and outside short
/// tables, factors whose products overflow.
pub const INTS: [i32; COUNT] = [
    0,
    1,
    -1,
    2,
    -2,
    3,
    4,
    5,
    6,
    7,
    8,
    9,
    10,
    15,
    16,
    17,
    31,
    32,
    33,
    63,
    64,
    65,
    127,
    -8,
    -9,
    -64,
    i32::MIN,
    i32::MIN + 1,
    i32::MIN + 2,
    i32::MAX,
    i32::MAX - 1,
    i32::MAX - 2,
    1 << 24,
    (1 << 24) - 1,
    (1 << 24) + 1,
    (1 << 24) + 2,
    (1 << 24) + 3,
    -(1 << 24),
    -(1 << 24) - 1,
    -(1 << 24) - 3,
    0x7fff_ff80,
    0x7fff_ffbf,
    0x7fff_ffc0,
    0x7fff_ffc1,
    -0x7fff_ffc0,
    -0x7fff_ffc1,
    0x4000_0000,
    -0x4000_0000,
    0x5555_5555,
    -0x5555_5556,
    0x0000_ffff,
    -0x0001_0000,
    0x0001_0001,
    0x00ff_00ff,
    46_340,
    46_341,
    -46_341,
    65_539,
    1_000_003,
    -123_456_789,
];

/// The floats of [`FLOATS`].
pub fn floats() -> Vec<f32> {
    FLOATS.map(f32::from_bits).to_vec()
}

/// Every pair of two items: all firsts and all seconds.
pub fn pairs<T: Copy>(items: &[T]) -> (Vec<T>, Vec<T>) {
    items.iter().flat_map(|&a| items.iter().map(move |&b| (a, b))).unzip()
}

/// Items repeated up to a length that is a multiple of every number of lanes.
pub fn padded<T: Copy>(mut items: Vec<T>) -> Vec<T> {
    let whole = items.len().next_multiple_of(lobe_lane::MAX_LANES);
    let last = *items.last().expect("at least one item");
    items.resize(whole, last);
    items
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_all_different_and_pairs_fill_vectors() {
        let floats: std::collections::HashSet<_> = FLOATS.into_iter().collect();
        let ints: std::collections::HashSet<_> = INTS.into_iter().collect();
        assert_eq!((floats.len(), ints.len()), (COUNT, COUNT));
        assert_eq!(pairs(&INTS).0.len() % lobe_lane::MAX_LANES, 0);
    }
}
