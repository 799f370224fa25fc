//! Drawing from lists of weights.

/// Lists of `n` weights each, ready to be drawn from.
#[derive(Clone, Debug)]
pub(super) struct Sums {
    n: usize,
    /// The sums of the weights up to and with each, the last of a list being 1.
    sums: Vec<f32>,
    /// For each of `n` equal parts of the unit interval the first entry whose sum is above where the part begins.
    guide: Vec<u32>,
}

impl Sums {
    /// No lists.
    pub fn new(n: usize) -> Self {
        Sums { n, sums: Vec::new(), guide: Vec::new() }
    }

    /// Adds a list of `n` weights, not all 0.
    pub fn push(&mut self, weights: &[f64]) {
        let total: f64 = weights.iter().sum();
        let mut sum = 0.0;
        let from = self.sums.len();
        self.sums.extend(weights.iter().map(|weight| {
            sum += weight;
            (sum / total) as f32
        }));
        let sums = &self.sums[from..];
        let mut entry = 0;
        for part in 0..self.n {
            let begin = part as f32 / self.n as f32;
            while entry + 1 < sums.len() && sums[entry] <= begin {
                entry += 1;
            }
            self.guide.push(entry as u32);
        }
    }

    /// The entry of a list that `u` in `[0, 1)` falls on, and how far into it.
    pub fn search(&self, list: usize, u: f32) -> (usize, f32) {
        let sums = &self.sums[list * self.n..][..self.n];
        let part = ((u * self.n as f32) as usize).min(self.n - 1);
        let mut entry = self.guide[list * self.n + part] as usize;
        // Rounding may have put `u` into the part after its own.
        while entry > 0 && sums[entry - 1] > u {
            entry -= 1;
        }
        while entry + 1 < self.n && sums[entry] <= u {
            entry += 1;
        }
        let before = if entry == 0 { 0.0 } else { sums[entry - 1] };
        let share = (u - before) / (sums[entry] - before).max(f32::MIN_POSITIVE);
        (entry, share.clamp(0.0, 1.0 - f32::EPSILON))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_found_wherever_they_are() {
        let weights: Vec<f64> = (0..37).map(|i| if i % 5 == 0 { 0.0 } else { f64::from(1 << (i % 11)) }).collect();
        let mut sums = Sums::new(37);
        sums.push(&[1.0; 37]);
        sums.push(&weights);
        for i in 0..10_000 {
            let u = i as f32 / 10_000.0;
            let (entry, share) = sums.search(1, u);
            let list = &sums.sums[37..];
            assert_eq!(entry, list.partition_point(|&sum| sum <= u), "{u}");
            let before = if entry == 0 { 0.0 } else { list[entry - 1] };
            assert!((before + share * (list[entry] - before) - u).abs() < 1e-6);
        }
    }
}
