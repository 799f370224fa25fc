//! The numbers that a path is made of.
//!
//! They depend on the pixel, the number of the sample and the dimension, and on nothing else: not on threads, tiles or
//! machines. Within a pixel they are an Owen-scrambled Sobol sequence (Burley 2020, "Practical Hash-based Owen
//! Scrambling"), four dimensions at a time; pixels are scrambled apart.

/// What a set of four dimensions is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// Place in the pixel (2), place on the lens (2).
    Camera,
    /// Which light, where on it (2), whether the path goes on; at the vertex of that depth.
    Light(u32),
    /// The direction (2), which of several ways; at the vertex of that depth.
    Scatter(u32),
}

/// The sequence of one sample of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sequence {
    index: u32,
    seed: u32,
}

/// Sobol points are numbered with 16 bits; further samples begin another scrambling.
const POINTS: u32 = 1 << 16;
/// How many sets of four dimensions the sequence has.
const SETS: u32 = sobol_burley::NUM_DIMENSION_SETS_4D;

impl Sequence {
    /// The sequence of a pixel's sample.
    pub fn new([x, y]: [u32; 2], sample: u32) -> Self {
        let seed = hash(x ^ hash(y ^ hash(sample / POINTS)));
        Sequence { index: sample % POINTS, seed }
    }

    /// Four numbers in `[0, 1)`.
    pub fn four(self, of: Use) -> [f32; 4] {
        let set = match of {
            Use::Camera => 0,
            Use::Light(depth) => 1 + 2 * depth,
            Use::Scatter(depth) => 2 + 2 * depth,
        };
        // Beyond the last dimension the sequence begins again, scrambled otherwise.
        let seed = if set < SETS { self.seed } else { hash(self.seed ^ (set / SETS)) };
        sobol_burley::sample_4d(self.index, set % SETS, seed)
    }
}

/// The `lowbias32` mix of C. Wellons ("Prospecting for Hash Functions", 2018).
fn hash(mut x: u32) -> u32 {
    x = x.wrapping_add(0x9e37_79b9);
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_stratified_and_differ_by_pixel_sample_and_dimension() {
        let of = |pixel, sample, set| Sequence::new(pixel, sample).four(set);
        let mut strata = [0; 16];
        for sample in 0..16 {
            strata[(of([3, 5], sample, Use::Scatter(2))[0] * 16.0) as usize] += 1;
        }
        assert_eq!(strata, [1; 16]);
        let one = of([3, 5], 7, Use::Light(1));
        for other in [
            of([5, 3], 7, Use::Light(1)),
            of([3, 5], 8, Use::Light(1)),
            of([3, 5], 7 + POINTS, Use::Light(1)),
            of([3, 5], 7, Use::Light(2)),
            of([3, 5], 7, Use::Light(1 + SETS / 2)),
        ] {
            assert_ne!(one, other);
        }
    }
}
