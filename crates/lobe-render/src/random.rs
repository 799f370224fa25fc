//! The random numbers of a path.
//!
//! They depend only on the pixel, the index of the sample and the dimension, not on threads, tiles or machines. Within
//! a pixel they are an Owen-scrambled Sobol sequence (Burley 2020, "Practical Hash-based Owen Scrambling"), four
//! dimensions at a time; each pixel is scrambled differently. The bits are the same as those of the crate
//! `sobol_burley`, which computes the four dimensions of one sample at once; here, lanes compute many samples at once.

use lobe::{Backend, Floats, Ints, Kernel, Lanes};
use lobe_lane::MAX_LANES;
use sobol_burley::parts;

/// Sets of four dimensions, by their use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dimensions {
    /// Position in the pixel (2) and on the lens (2).
    Camera,
    /// The choice of a light and the point on it (2), at the vertex of this depth.
    Light(u32),
    /// The direction (2), the choice among several lobes, and whether the path continues, at the vertex of this depth.
    Scatter(u32),
}

/// The sequence of one sample of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sequence {
    index: u32,
    seed: u32,
}

/// Sobol points are numbered with 16 bits; further samples begin another scrambled sequence.
const POINTS: u32 = 1 << 16;
/// Number of sets of four dimensions of the sequence.
const SETS: u32 = sobol_burley::NUM_DIMENSION_SETS_4D;

impl Sequence {
    /// The sequence of a sample of a pixel.
    pub fn new([x, y]: [u32; 2], sample: u32) -> Self {
        let seed = hash(x ^ hash(y ^ hash(sample / POINTS)));
        Sequence { index: sample % POINTS, seed }
    }
}

impl Sequence {
    /// The sequence of a light path. The paths of one pass take the points of a sequence in order, so that they cover
    /// the emitted light evenly.
    pub fn of_light(path: u32, pass: u32) -> Self {
        const LIGHT: u32 = 0x4c69_6768;
        let seed = hash(LIGHT ^ hash(pass ^ hash(path / POINTS)));
        Sequence { index: path % POINTS, seed }
    }
}

/// Numbers in `[0, 1)` of many sequences, four for each.
#[derive(Debug, Default)]
pub(crate) struct Numbers {
    /// Longer than the number of sequences, so that all lanes are inside the columns.
    index: Vec<i32>,
    seed: Vec<i32>,
    numbers: [Vec<f32>; 4],
}

impl Numbers {
    /// Samples the dimensions of each of the sequences.
    pub fn sample(
        &mut self,
        backend: Backend,
        sequences: impl ExactSizeIterator<Item = Sequence>,
        dimensions: Dimensions,
    ) {
        let Numbers { index, seed, numbers } = self;
        let n = sequences.len().next_multiple_of(MAX_LANES);
        index.resize(n, 0);
        seed.resize(n, 0);
        for ((sequence, index), seed) in sequences.zip(&mut *index).zip(&mut *seed) {
            (*index, *seed) = (sequence.index as i32, sequence.seed as i32);
        }
        numbers.iter_mut().for_each(|column| column.resize(n, 0.0));
        let set = match dimensions {
            Dimensions::Camera => 0,
            Dimensions::Light(depth) => 1 + 2 * depth,
            Dimensions::Scatter(depth) => 2 + 2 * depth,
        };
        // Beyond the last dimension the sequence begins again, scrambled differently.
        if set >= SETS {
            seed.iter_mut().for_each(|seed| *seed = hash(*seed as u32 ^ (set / SETS)) as i32);
        }
        let set = set % SETS;
        let vector = |bit: usize, dimension| parts::sobol_rev(0x8000_0000 >> bit, 4 * set + dimension) as i32;
        let vectors = std::array::from_fn(|bit| [0, 1, 2, 3].map(|dimension| vector(bit, dimension)));
        backend.run(SampleSobol { index, seed, set: set as i32, vectors, numbers });
    }

    /// The numbers of a sequence.
    #[inline]
    pub fn of(&self, sequence: usize) -> [f32; 4] {
        self.numbers.each_ref().map(|column| column[sequence])
    }

    /// The numbers of the sequences from `at` on, which is a multiple of the number of lanes. Lanes beyond the last
    /// sequence have unspecified numbers in `[0, 1)`.
    #[inline(always)]
    pub fn lanes<L: Lanes>(&self, lanes: L, at: usize) -> [L::F; 4] {
        let [a, b, c, d] = &self.numbers;
        [lanes.load(&a[at..]), lanes.load(&b[at..]), lanes.load(&c[at..]), lanes.load(&d[at..])]
    }
}

/// The contribution of each bit of the index, lowest bit first, to each dimension, with the order of bits reversed.
type Vectors = [[i32; 4]; 16];

/// The contribution of three bits of the index to each dimension, as the bits of floats.
type Threes = [[[f32; 8]; 4]; 6];

struct SampleSobol<'a> {
    index: &'a [i32],
    seed: &'a [i32],
    set: i32,
    vectors: Vectors,
    numbers: &'a mut [Vec<f32>; 4],
}

impl Kernel for SampleSobol<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let SampleSobol { index, seed, set, vectors, numbers } = self;
        let threes = threes(&vectors);
        let mut at = 0;
        while at < index.len() {
            let seed = lanes.load_int(&seed[at..]);
            let index = reversed(lanes, lanes.load_int(&index[at..]));
            let index = scrambled(lanes, index, mixed(lanes, seed ^ lanes.splat_int(0x79c6_8e4a)));
            let sobol = if L::PERMUTES { by_threes(lanes, &threes, index) } else { by_bits(lanes, &vectors, index) };
            let seed = (seed * lanes.splat_int(0x9c8f_2d3b_u32 as i32)) ^ lanes.splat_int(set);
            for k in 0..4 {
                let scramble = mixed(lanes, seed ^ lanes.splat_int(SCRAMBLES[k] as i32));
                let bits = reversed(lanes, scrambled(lanes, sobol[k], scramble));
                let above = (bits.shr::<9>() | lanes.splat_int(0x3f80_0000)).as_float();
                lanes.store(&mut numbers[k][at..], above - lanes.splat(1.0));
            }
            at += L::LANES;
        }
    }
}

/// The contribution of the index, its lowest bit on top, to each dimension.
#[inline(always)]
fn by_bits<L: Lanes>(lanes: L, vectors: &Vectors, mut index: L::I) -> [L::I; 4] {
    let mut sobol = [lanes.splat_int(0); 4];
    for vector in vectors {
        let bit = lanes.splat_int(0) - index.shr::<31>();
        for k in 0..4 {
            sobol[k] = sobol[k] ^ (lanes.splat_int(vector[k]) & bit);
        }
        index = index.shl::<1>();
    }
    sobol
}

/// The same, three bits at once.
#[inline(always)]
fn by_threes<L: Lanes>(lanes: L, threes: &Threes, mut index: L::I) -> [L::I; 4] {
    let mut sobol = [lanes.splat_int(0); 4];
    for three in threes {
        let bits = index.shr::<29>();
        for k in 0..4 {
            sobol[k] = sobol[k] ^ lanes.oct_lookup(lanes.oct_load(&three[k]), bits).bits();
        }
        index = index.shl::<3>();
    }
    sobol
}

/// The contributions of three bits each, the first of them on top; bits that the index does not have contribute
/// nothing.
fn threes(vectors: &Vectors) -> Threes {
    let of = |place: usize, k: usize| vectors.get(place).map_or(0, |vector| vector[k]);
    std::array::from_fn(|three| {
        std::array::from_fn(|k| {
            std::array::from_fn(|bits| {
                let one = |bit: usize| if bits >> (2 - bit) & 1 == 0 { 0 } else { of(3 * three + bit, k) };
                f32::from_bits((one(0) ^ one(1) ^ one(2)) as u32)
            })
        })
    })
}

/// Seeds that distinguish the four dimensions of a set.
const SCRAMBLES: [u32; 4] = [0x912f_69ba, 0x174f_18ab, 0x691e_72ca, 0xb40c_c1b8];

/// Owen scrambling of numbers whose bits are in reverse order: the hash of Vegdahl 2021 ("Building a Better LK Hash"),
/// in which each bit depends on the bits below it.
#[inline(always)]
fn scrambled<L: Lanes>(lanes: L, x: L::I, seed: L::I) -> L::I {
    let x = x ^ (x * lanes.splat_int(0x3d20_adea));
    let x = (x + seed) * (seed.shr::<16>() | lanes.splat_int(1));
    let x = x ^ (x * lanes.splat_int(0x0552_6c56));
    x ^ (x * lanes.splat_int(0x53a2_2864))
}

/// The order of the bits, reversed.
#[inline(always)]
fn reversed<L: Lanes>(lanes: L, x: L::I) -> L::I {
    let x = (x.shr::<1>() & lanes.splat_int(0x5555_5555)) | (x & lanes.splat_int(0x5555_5555)).shl::<1>();
    let x = (x.shr::<2>() & lanes.splat_int(0x3333_3333)) | (x & lanes.splat_int(0x3333_3333)).shl::<2>();
    let x = (x.shr::<4>() & lanes.splat_int(0x0f0f_0f0f)) | (x & lanes.splat_int(0x0f0f_0f0f)).shl::<4>();
    let x = (x.shr::<8>() & lanes.splat_int(0x00ff_00ff)) | (x & lanes.splat_int(0x00ff_00ff)).shl::<8>();
    x.shr::<16>() | x.shl::<16>()
}

/// [`parts::hash`] in lanes: the `lowbias32` mix of C. Wellons ("Prospecting for Hash Functions", 2018).
#[inline(always)]
fn mixed<L: Lanes>(lanes: L, x: L::I) -> L::I {
    let x = x ^ lanes.splat_int(0xe6fe_3beb_u32 as i32);
    let x = (x ^ x.shr::<16>()) * lanes.splat_int(0x7feb_352d);
    let x = (x ^ x.shr::<15>()) * lanes.splat_int(0x846c_a68b_u32 as i32);
    x ^ x.shr::<16>()
}

/// The same mix of a number with an offset, so that seeds of pixels differ from later uses of the hash.
fn hash(mut x: u32) -> u32 {
    x = x.wrapping_add(0x9e37_79b9);
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(backend: &str, sequences: &[Sequence], dimensions: Dimensions) -> Vec<[f32; 4]> {
        let mut numbers = Numbers::default();
        numbers.sample(Backend::named(backend).unwrap(), sequences.iter().copied(), dimensions);
        (0..sequences.len()).map(|at| numbers.of(at)).collect()
    }

    #[test]
    fn numbers_are_stratified_and_differ_by_pixel_sample_and_dimension() {
        let of = |pixel, sample, set| sampled("scalar", &[Sequence::new(pixel, sample)], set)[0];
        let mut strata = [0; 16];
        for sample in 0..16 {
            strata[(of([3, 5], sample, Dimensions::Scatter(2))[0] * 16.0) as usize] += 1;
        }
        assert_eq!(strata, [1; 16]);
        let one = of([3, 5], 7, Dimensions::Light(1));
        for other in [
            of([5, 3], 7, Dimensions::Light(1)),
            of([3, 5], 8, Dimensions::Light(1)),
            of([3, 5], 7 + POINTS, Dimensions::Light(1)),
            of([3, 5], 7, Dimensions::Light(2)),
            of([3, 5], 7, Dimensions::Light(1 + SETS / 2)),
        ] {
            assert_ne!(one, other);
        }
    }

    #[test]
    fn lanes_sample_the_same_numbers_as_the_crate() {
        let sequences: Vec<_> = (0..19).map(|i| Sequence::new([i, 3 * i], 3456 * i)).collect();
        for (of, set) in [(Dimensions::Camera, 0), (Dimensions::Scatter(1), 4), (Dimensions::Light(30), 61)] {
            let expected = |s: &Sequence| sobol_burley::sample_4d(s.index, set, s.seed);
            let expected: Vec<_> = sequences.iter().map(expected).collect();
            for backend in Backend::available() {
                assert_eq!(sampled(backend.name(), &sequences, of), expected, "{}, {of:?}", backend.name());
            }
        }
    }
}
