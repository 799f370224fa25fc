//! Samples from lists of weights.

use lobe_lane::{Floats, Ints, Lanes, Mask};
use lobe_memory::Storage;

/// Lists of `n` weights each, ready to be sampled.
#[derive(Clone, Debug)]
pub(super) struct Cdf {
    n: usize,
    /// The running sums of the weights before and after each entry, from 0 to 1 in a list.
    sums: Storage<[f32; 2]>,
    /// For each of `n` equal parts of the unit interval, the first entry whose sum is above the beginning of the part.
    /// They are whole numbers kept as floats, because lanes gather floats.
    guide: Storage<f32>,
}

impl Cdf {
    /// Prepares lists of `n` weights, one after the other; the weights of a list must not all be 0.
    pub fn new(n: usize, weights: &[f64]) -> Self {
        let mut sums = Storage::<[f32; 2]>::zeros(weights.len());
        let mut guide = Storage::<f32>::zeros(weights.len());
        // There may be no list.
        let len = n.max(1);
        let lists = sums.as_mut_slice().chunks_exact_mut(len).zip(guide.as_mut_slice().chunks_exact_mut(len));
        for (weights, (sums, guide)) in weights.chunks_exact(len).zip(lists) {
            let total: f64 = weights.iter().sum();
            let mut sum = 0.0;
            for (weight, sums) in weights.iter().zip(&mut *sums) {
                let before = (sum / total) as f32;
                sum += weight;
                *sums = [before, (sum / total) as f32];
            }
            let mut entry = 0;
            for (part, guide) in guide.iter_mut().enumerate() {
                // A little early, because rounding may put a number into the next part.
                let begin = part as f32 / n as f32 * (1.0 - 4.0 * f32::EPSILON);
                while entry + 1 < n && sums[entry][1] <= begin {
                    entry += 1;
                }
                *guide = entry as f32;
            }
        }
        Cdf { n, sums, guide }
    }

    /// The entries of lists that `u` in `[0, 1)` falls on, and how far into them.
    #[inline(always)]
    pub fn sample<L: Lanes>(&self, lanes: L, list: L::I, u: L::F) -> (L::I, L::F) {
        let (lists, guide) = (self.sums.as_slice(), self.guide.as_slice());
        let n = lanes.splat_int(self.n as i32);
        let (one, last) = (lanes.splat_int(1), n - lanes.splat_int(1));
        let first = list * n;
        let part = (u * lanes.splat(self.n as f32)).to_int().min(last);
        let mut entry = lanes.gather(guide, first + part).to_int();
        let mut sums = lanes.gather_pair(lists, first + entry);
        loop {
            let further = sums[1].le(u) & entry.lt(last);
            if !further.any() {
                break;
            }
            entry = lanes.select_int(further, entry + one, entry);
            sums = lanes.gather_pair(lists, first + entry);
        }
        let share = (u - sums[0]) / (sums[1] - sums[0]).max(lanes.splat(f32::MIN_POSITIVE));
        (entry, share.max(lanes.splat(0.0)).min(lanes.splat(1.0 - f32::EPSILON)))
    }
}

#[cfg(test)]
mod tests {
    use lobe_scalar::Scalar;

    use super::*;

    #[test]
    fn entries_are_found_wherever_they_are() {
        let weights: Vec<f64> = (0..37).map(|i| if i % 5 == 0 { 0.0 } else { f64::from(1 << (i % 11)) }).collect();
        let sums = Cdf::new(37, &[vec![1.0; 37], weights].concat());
        let lanes = Scalar::<4>;
        let list = &sums.sums.as_slice()[37..];
        for i in 0..10_000 {
            let u: [f32; 4] = std::array::from_fn(|lane| ((i + 2311 * lane) % 10_000) as f32 / 10_000.0);
            let (entry, share) = sums.sample(lanes, lanes.splat_int(1), lanes.load(&u));
            for (lane, &u) in u.iter().enumerate() {
                let entry = lanes.extract_int(entry, lane) as usize;
                assert_eq!(entry, list.partition_point(|&[_, sum]| sum <= u), "{u}");
                let [before, sum] = list[entry];
                let share = lanes.extract(share, lane);
                assert!((before + share * (sum - before) - u).abs() < 1e-6);
            }
        }
    }
}
