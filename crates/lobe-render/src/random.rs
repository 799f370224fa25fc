//! The numbers that a path is made of.
//!
//! They depend on the pixel, the number of the sample and the dimension, and on nothing else: not on threads, tiles or
//! machines. Within a pixel they are pairs of Owen-scrambled Sobol sequences, shuffled apart (Burley 2020, "Practical
//! Hash-based Owen Scrambling"), two pairs at a time; pixels are scrambled apart. All of it is arithmetic on integers,
//! which compilers bring into lanes.

use lobe::{Backend, Ints, Kernel, Lanes};
use lobe_lane::MAX_LANES;

/// What a set of four dimensions is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// Place in the pixel (2), place on the lens (2).
    Camera,
    /// Where on a light (2), which light; at the vertex of that depth.
    Light(u32),
    /// The direction (2), which of several ways, whether the path goes on; at the vertex of that depth.
    Scatter(u32),
}

/// The sequence of one sample of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sequence {
    index: u32,
    seed: u32,
}

/// Points of a pixel have numbers of 16 bits; further samples begin another scrambling.
const POINTS: u32 = 1 << 16;

impl Sequence {
    /// The sequence of a pixel's sample.
    pub fn new([x, y]: [u32; 2], sample: u32) -> Self {
        let seed = hash(x ^ hash(y ^ hash(sample / POINTS)));
        Sequence { index: sample % POINTS, seed }
    }
}

/// Numbers in `[0, 1)` of many sequences, four for each.
#[derive(Debug, Default)]
pub(crate) struct Numbers {
    /// Longer than there are sequences, so that all lanes are in the columns.
    index: Vec<i32>,
    seed: Vec<i32>,
    numbers: [Vec<f32>; 4],
}

impl Numbers {
    /// Draws for each of the sequences.
    pub fn draw(&mut self, backend: Backend, sequences: impl Iterator<Item = Sequence>, of: Use) {
        let Numbers { index, seed, numbers } = self;
        index.clear();
        seed.clear();
        for sequence in sequences {
            index.push(sequence.index as i32);
            seed.push(sequence.seed as i32);
        }
        let n = index.len().next_multiple_of(MAX_LANES);
        index.resize(n, 0);
        seed.resize(n, 0);
        numbers.iter_mut().for_each(|column| column.resize(n, 0.0));
        let set = match of {
            Use::Camera => 0,
            Use::Light(depth) => 1 + 2 * depth,
            Use::Scatter(depth) => 2 + 2 * depth,
        };
        backend.run(Drawing { index, seed, set: set.wrapping_mul(STEP) as i32, numbers });
    }

    /// What was drawn for a sequence.
    pub fn of(&self, sequence: usize) -> [f32; 4] {
        self.numbers.each_ref().map(|column| column[sequence])
    }
}

struct Drawing<'a> {
    index: &'a [i32],
    seed: &'a [i32],
    set: i32,
    numbers: &'a mut [Vec<f32>; 4],
}

impl Kernel for Drawing<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Drawing { index, seed, set, numbers } = self;
        let mut at = 0;
        while at < index.len() {
            let reversed = reverse(lanes, lanes.load_int(&index[at..]));
            let seed = mixed(lanes, lanes.load_int(&seed[at..]) ^ lanes.splat_int(set));
            let [a, b] = pair(lanes, reversed, seed);
            let [c, d] = pair(lanes, reversed, mixed(lanes, seed));
            let [first, second, third, fourth] = &mut *numbers;
            lanes.store(&mut first[at..], a);
            lanes.store(&mut second[at..], b);
            lanes.store(&mut third[at..], c);
            lanes.store(&mut fourth[at..], d);
            at += L::LANES;
        }
    }
}

/// A point of the first two dimensions of Sobol's sequence, shuffled and scrambled; the bits of its number come reversed.
#[inline(always)]
fn pair<L: Lanes>(lanes: L, reversed: L::I, seed: L::I) -> [L::F; 2] {
    let index = reverse(lanes, scrambled(lanes, reversed, seed));
    // The bits of the second dimension from the lowest place up: the polynomial of the index at x + 1, modulo 2.
    let mut second = index;
    second = second ^ (second.shr::<16>() & lanes.splat_int(0x0000_ffff));
    second = second ^ (second.shr::<8>() & lanes.splat_int(0x00ff_00ff));
    second = second ^ (second.shr::<4>() & lanes.splat_int(0x0f0f_0f0f));
    second = second ^ (second.shr::<2>() & lanes.splat_int(0x3333_3333));
    second = second ^ (second.shr::<1>() & lanes.splat_int(0x5555_5555));
    let [a, b] = [index, second];
    let seed = mixed(lanes, seed ^ lanes.splat_int(STEP as i32));
    let a = scrambled(lanes, a, seed);
    let b = scrambled(lanes, b, mixed(lanes, seed));
    // 24 bits are what a float holds.
    let unit = lanes.splat(1.0 / 16_777_216.0);
    [reverse(lanes, a).shr::<8>().to_float() * unit, reverse(lanes, b).shr::<8>().to_float() * unit]
}

/// Owen's scrambling of numbers whose bits are in reverse order: the hash of Vegdahl 2021 ("Building a Better LK Hash"),
/// in which each bit depends on those below it.
#[inline(always)]
fn scrambled<L: Lanes>(lanes: L, x: L::I, seed: L::I) -> L::I {
    let x = x ^ (x * lanes.splat_int(0x3d20_adea));
    let x = (x + seed) * (seed.shr::<16>() | lanes.splat_int(1));
    let x = x ^ (x * lanes.splat_int(0x0552_6c56));
    x ^ (x * lanes.splat_int(0x53a2_2864))
}

/// The order of the bits, reversed.
#[inline(always)]
fn reverse<L: Lanes>(lanes: L, x: L::I) -> L::I {
    let x = (x.shr::<1>() & lanes.splat_int(0x5555_5555)) | (x & lanes.splat_int(0x5555_5555)).shl::<1>();
    let x = (x.shr::<2>() & lanes.splat_int(0x3333_3333)) | (x & lanes.splat_int(0x3333_3333)).shl::<2>();
    let x = (x.shr::<4>() & lanes.splat_int(0x0f0f_0f0f)) | (x & lanes.splat_int(0x0f0f_0f0f)).shl::<4>();
    let x = (x.shr::<8>() & lanes.splat_int(0x00ff_00ff)) | (x & lanes.splat_int(0x00ff_00ff)).shl::<8>();
    x.shr::<16>() | x.shl::<16>()
}

/// From one seed to the next: the fraction of the golden ratio.
const STEP: u32 = 0x9e37_79b9;
/// Factors of the `lowbias32` mix of C. Wellons ("Prospecting for Hash Functions", 2018).
const FACTORS: [u32; 2] = [0x7feb_352d, 0x846c_a68b];

/// [`hash`] in lanes.
#[inline(always)]
fn mixed<L: Lanes>(lanes: L, x: L::I) -> L::I {
    let [first, second] = FACTORS.map(|factor| lanes.splat_int(factor as i32));
    let x = x + lanes.splat_int(STEP as i32);
    let x = (x ^ x.shr::<16>()) * first;
    let x = (x ^ x.shr::<15>()) * second;
    x ^ x.shr::<16>()
}

fn hash(mut x: u32) -> u32 {
    x = x.wrapping_add(STEP);
    x = (x ^ (x >> 16)).wrapping_mul(FACTORS[0]);
    x = (x ^ (x >> 15)).wrapping_mul(FACTORS[1]);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(backend: &str, sequences: &[Sequence], of: Use) -> Vec<[f32; 4]> {
        let mut numbers = Numbers::default();
        numbers.draw(Backend::named(backend).unwrap(), sequences.iter().copied(), of);
        (0..sequences.len()).map(|at| numbers.of(at)).collect()
    }

    #[test]
    fn numbers_differ_by_pixel_sample_and_dimension() {
        let of = |pixel, sample, set| drawn("scalar", &[Sequence::new(pixel, sample)], set)[0];
        let one = of([3, 5], 7, Use::Light(1));
        for other in [
            of([5, 3], 7, Use::Light(1)),
            of([3, 5], 8, Use::Light(1)),
            of([3, 5], 7 + POINTS, Use::Light(1)),
            of([3, 5], 7, Use::Light(2)),
            of([3, 5], 7, Use::Scatter(1)),
        ] {
            assert!((0..4).all(|k| one[k] != other[k]));
        }
    }

    /// Each of the rectangles of area 1/64 with sides that are powers of 2 has one of 64 points.
    #[test]
    fn pairs_are_stratified_together() {
        for pixel in 0..20 {
            let sequences: Vec<_> = (0..64).map(|sample| Sequence::new([pixel, 9], sample)).collect();
            let points = drawn("scalar", &sequences, Use::Light(3));
            for (first, k) in [0, 2].into_iter().flat_map(|first| (0..=6).map(move |k| (first, k))) {
                let (columns, rows) = (1 << k, 64 >> k);
                let mut found = [0; 64];
                for point in &points {
                    let [x, y] = [point[first] * columns as f32, point[first + 1] * rows as f32];
                    found[y as usize * columns + x as usize] += 1;
                }
                assert_eq!(found, [1; 64], "pixel {pixel}, {columns} x {rows}");
            }
        }
    }

    #[test]
    fn numbers_are_those_of_every_backend() {
        let sequences: Vec<_> = (0..19).map(|i| Sequence::new([i, 3 * i], 100 * i)).collect();
        let expected = drawn("scalar", &sequences, Use::Scatter(1));
        for backend in Backend::available() {
            assert_eq!(drawn(backend.name(), &sequences, Use::Scatter(1)), expected, "{}", backend.name());
        }
    }
}
