//! The number formats of stored texels.

use lobe_lane::{Block, Lanes};

/// The storage format of the values of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 32-bit floats: the values of the file.
    #[default]
    Single,
    /// 16-bit floats, half the memory, scaled by a power of two so that the largest value fits. Each value is rounded
    /// to 11 significant bits, an error of at most 2^-11 of the value, or of 2^-39 of the largest value of the table if
    /// that is more. This is faster for tables that do not fit into the caches.
    Half,
}

/// A number as stored in memory, which loads convert to a float.
pub(crate) trait Stored: Copy + Default + bytemuck::Pod + Send + Sync {
    /// The number nearest to `x`.
    fn from_f32(x: f32) -> Self;

    fn octs<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 8, Self>, base: usize) -> [L::Oct; N];
    fn quads<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4, Self>, base: usize) -> [L::Quad; N];
    fn gather<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4, Self>, bases: &[i32]) -> [[L::F; 4]; N];
}

impl Stored for f32 {
    fn from_f32(x: f32) -> Self {
        x
    }
    #[inline(always)]
    fn octs<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 8>, base: usize) -> [L::Oct; N] {
        lanes.oct_corners(block, base)
    }
    #[inline(always)]
    fn quads<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4>, base: usize) -> [L::Quad; N] {
        lanes.quad_corners(block, base)
    }
    #[inline(always)]
    fn gather<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4>, bases: &[i32]) -> [[L::F; 4]; N] {
        lanes.gather_quads_at(block, bases)
    }
}

/// The bits of a half-precision float.
impl Stored for u16 {
    fn from_f32(x: f32) -> Self {
        to_half(x)
    }
    #[inline(always)]
    fn octs<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 8, u16>, base: usize) -> [L::Oct; N] {
        lanes.oct_corners_half(block, base)
    }
    #[inline(always)]
    fn quads<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4, u16>, base: usize) -> [L::Quad; N] {
        lanes.quad_corners_half(block, base)
    }
    #[inline(always)]
    fn gather<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4, u16>, bases: &[i32]) -> [[L::F; 4]; N] {
        lanes.gather_quads_half(block, lanes.load_int(bases))
    }
}

/// The bits of the half-precision float nearest to `x`; of two equally near ones, the one whose last bit is 0.
fn to_half(x: f32) -> u16 {
    /// The least normal half, the first power of two beyond halves, and infinity, as bits of floats.
    const NORMAL: u32 = (127 - 14) << 23;
    const BEYOND: u32 = (127 + 16) << 23;
    const INFINITE: u32 = 255 << 23;
    /// A float whose last bit has the same value as that of a subnormal half, so that a sum with it is rounded there.
    const SUBNORMAL: u32 = (127 - 24 + 23) << 23;

    let sign = x.to_bits() >> 16 & 0x8000;
    let bits = x.to_bits() & 0x7fff_ffff;
    let half = if bits > INFINITE {
        0x7e00
    } else if bits >= BEYOND {
        0x7c00
    } else if bits < NORMAL {
        (f32::from_bits(bits) + f32::from_bits(SUBNORMAL)).to_bits() - SUBNORMAL
    } else {
        // Half a unit of the last kept bit, minus one if that bit is 0; and the difference of the exponent biases.
        let odd = bits >> 13 & 1;
        (bits + 0xfff + odd - ((127 - 15) << 23)) >> 13
    };
    (sign | half) as u16
}

/// The power of two by which values of at most `largest` are multiplied so that they fit a half-precision float.
pub(crate) fn half_scale(largest: f32) -> f32 {
    // 2^15 leaves room for rounding up the largest value. Powers beyond 2^100 would overflow when they are undone.
    let exponent = if largest > 0.0 { 15 - largest.log2().ceil() as i32 } else { 0 };
    2f32.powi(exponent.clamp(-100, 100))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A finite half-precision float.
    fn from_half(half: u16) -> f64 {
        let (exponent, fraction) = (i32::from(half >> 10 & 0x1f), f64::from(half & 0x3ff));
        let magnitude = match exponent {
            0 => fraction * 2f64.powi(-24),
            _ => (1024.0 + fraction) * 2f64.powi(exponent - 25),
        };
        if half & 0x8000 == 0 { magnitude } else { -magnitude }
    }

    #[test]
    fn halves_keep_their_bits() {
        for half in (0..0x7c00).chain(0x8000..0xfc00) {
            assert_eq!(to_half(from_half(half) as f32), half);
        }
        assert_eq!([f32::INFINITY, f32::NEG_INFINITY, f32::MAX].map(to_half), [0x7c00, 0xfc00, 0x7c00]);
        assert!(to_half(f32::NAN) & 0x7fff > 0x7c00);
    }

    #[test]
    fn floats_round_to_the_nearer_half() {
        for half in 0..0x7bff_u16 {
            let [low, high] = [half, half + 1].map(from_half);
            let middle = ((low + high) / 2.0) as f32;
            assert_eq!(to_half(middle), half + (half & 1), "{middle:e}");
            assert_eq!([middle.next_down(), middle.next_up()].map(to_half), [half, half + 1], "{middle:e}");
        }
        // Half a unit beyond the largest half rounds to infinity.
        assert_eq!([65519.996, 65520.0].map(to_half), [0x7bff, 0x7c00]);
    }
}
