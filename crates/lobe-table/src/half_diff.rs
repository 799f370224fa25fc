//! Isotropic materials on a grid of half and difference angles.
//!
//! Matusik et al., "A Data-Driven Reflectance Model", ACM TOG 22(3), 2003, in the coordinates of Rusinkiewicz, "A New
//! Change of Variables for Efficient BRDF Representation", 1998.

use crate::direction::half_difference;
use crate::invalid::{Invalid, count, finite};
use std::f64::consts::{PI, TAU};

/// A measured RGB material on bins of `theta_h`, `theta_d` and `phi_d`.
///
/// Bin `i` of `n` in `theta_h` covers `pi / 2 (i / n)^2` to `pi / 2 ((i + 1) / n)^2`, so that the bins are narrowest at
/// the peak; the other two axes are uniform. `theta_d` spans a quarter turn. `phi_d` spans half a turn, which
/// reciprocity repeats; or a whole one in the tables of 360 bins of materials that are not reciprocal.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfDiff {
    bins: [usize; 3],
    values: Vec<f32>,
}

impl HalfDiff {
    /// Checks that there are `[channel][theta_h][theta_d][phi_d]` values, with three channels, and that they are finite.
    /// `bins` counts `theta_h`, `theta_d`, `phi_d`. Values are `f` in 1/sr, linear RGB; negative ones were not measured.
    ///
    /// # Errors
    /// [`Invalid`] names `dims` or `values`.
    pub fn new(bins: [usize; 3], values: Vec<f32>) -> Result<Self, Invalid> {
        if bins.contains(&0) {
            return Err(Invalid::new("dims", format!("{bins:?} bins"), "at least one bin in each"));
        }
        count("values", values.len(), &[3, bins[0], bins[1], bins[2]])?;
        finite("values", &values)?;
        Ok(HalfDiff { bins, values })
    }

    /// How many bins `theta_h`, `theta_d` and `phi_d` have.
    pub fn bins(&self) -> [usize; 3] {
        self.bins
    }

    /// All values: `[channel][theta_h][theta_d][phi_d]`, `f` in 1/sr.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The angle that `phi_d` repeats after: `pi`, or `2 pi` for a table with four times as many bins in `phi_d` as in
    /// `theta_d`, which are then of the same width.
    pub fn period(&self) -> f64 {
        if self.bins[2] >= 4 * self.bins[1] { TAU } else { PI }
    }

    /// The values of a bin in the three channels, as they are stored.
    ///
    /// # Panics
    /// Where there is no such bin.
    pub fn texel(&self, bin: [usize; 3]) -> [f32; 3] {
        let [h, d, p] = self.bins;
        assert!(bin[0] < h && bin[1] < d && bin[2] < p, "bin {bin:?} of {:?}", self.bins);
        let at = (bin[0] * d + bin[1]) * p + bin[2];
        [0, 1, 2].map(|channel| self.values[channel * h * d * p + at])
    }

    /// Whether a bin was measured: below the horizon, and where a measurement failed, the file has negative numbers.
    pub fn is_measured(&self, bin: [usize; 3]) -> bool {
        self.texel(bin).iter().all(|value| *value >= 0.0)
    }

    /// The bin that a pair of directions falls into.
    pub fn bin(&self, wi: [f64; 3], wo: [f64; 3]) -> [usize; 3] {
        self.coordinates(wi, wo).map(|(x, n)| (x as usize).min(n - 1))
    }

    /// The value of the bin that the directions fall into, without interpolation, as the reader of the database does
    /// it. 0 where nothing was measured or a direction is not above the surface.
    pub fn eval_nearest(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        let bin = self.bin(wi, wo);
        if wi[2] <= 0.0 || wo[2] <= 0.0 || !self.is_measured(bin) {
            return [0.0; 3];
        }
        self.texel(bin).map(f64::from)
    }

    /// The value interpolated linearly in the coordinates of the bins. The value of a bin is taken to lie at its middle,
    /// as the measurement averaged over it: for `theta_h` that is `pi / 2 ((i + 1/2) / n)^2`. Beyond the first and last
    /// middle the value is constant; `phi_d` repeats. Bins that were not measured are left out of the average.
    pub fn eval_linear(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return [0.0; 3];
        }
        let [h, d, (p, n)] = self.coordinates(wi, wo);
        let clamped = |(x, n): (f64, usize)| {
            let x = (x - 0.5).clamp(0.0, (n - 1) as f64);
            let low = (x as usize).min(n - 1);
            ([low, (low + 1).min(n - 1)], x - low as f64)
        };
        let (h, fh) = clamped(h);
        let (d, fd) = clamped(d);
        let turned = (p - 0.5).rem_euclid(n as f64);
        let low = (turned as usize).min(n - 1);
        let (p, fp) = ([low, (low + 1) % n], turned - low as f64);
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for corner in 0..8 {
            let pick = |axis: usize| corner >> axis & 1;
            let part = |axis: usize, t: f64| if pick(axis) == 1 { t } else { 1.0 - t };
            let (bin, weight) = ([h[pick(0)], d[pick(1)], p[pick(2)]], part(0, fh) * part(1, fd) * part(2, fp));
            if weight > 0.0 && self.is_measured(bin) {
                total += weight;
                let texel = self.texel(bin);
                (0..3).for_each(|channel| sum[channel] += weight * f64::from(texel[channel]));
            }
        }
        if total > 0.0 { sum.map(|value| value / total) } else { sum }
    }

    /// The place in bins along each axis, with the number of bins.
    fn coordinates(&self, wi: [f64; 3], wo: [f64; 3]) -> [(f64, usize); 3] {
        let [h, d, p] = self.bins;
        let (theta_h, theta_d, phi_d) = half_difference(wi, wo);
        let quarter = PI / 2.0;
        let period = self.period();
        // `phi_d` of exactly zero from below rounds up to the period, which the last bin takes.
        let turns = if phi_d < 0.0 { phi_d + period } else { phi_d };
        [
            ((theta_h / quarter * (h * h) as f64).sqrt(), h),
            (theta_d / quarter * d as f64, d),
            (turns / period * p as f64, p),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::spherical;

    /// Directions with these coordinates: the half vector at azimuth 0, `wi` turned away from it.
    fn pair(theta_h: f64, theta_d: f64, phi_d: f64) -> ([f64; 3], [f64; 3]) {
        let tilt = |[x, y, z]: [f64; 3]| {
            let (sin, cos) = theta_h.sin_cos();
            [cos * x + sin * z, y, cos * z - sin * x]
        };
        (tilt(spherical(theta_d, phi_d)), tilt(spherical(theta_d, phi_d + PI)))
    }

    fn table(bins: [usize; 3], value: impl Fn(usize) -> f32) -> HalfDiff {
        HalfDiff::new(bins, (0..3 * bins.iter().product::<usize>()).map(value).collect()).expect("a valid table")
    }

    #[test]
    fn the_middle_of_a_bin_has_its_value_in_both_modes() {
        for bins in [[4, 5, 6], [4, 5, 20]] {
            let table = table(bins, |i| i as f32);
            for (h, d, p) in [(0, 0, 0), (1, 2, 3), (2, 1, 5), (1, 0, bins[2] - 1)] {
                let middle = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
                let (wi, wo) = pair(
                    middle(h, bins[0]).powi(2) * PI / 2.0,
                    middle(d, bins[1]) * PI / 2.0,
                    middle(p, bins[2]) * table.period(),
                );
                if wi[2] <= 0.0 || wo[2] <= 0.0 {
                    continue;
                }
                assert_eq!(table.bin(wi, wo), [h, d, p]);
                let stored = table.texel([h, d, p]).map(f64::from);
                assert_eq!(table.eval_nearest(wi, wo), stored);
                let linear = table.eval_linear(wi, wo);
                assert!((0..3).all(|c| (linear[c] - stored[c]).abs() < 1e-9), "{linear:?} {stored:?}");
            }
        }
    }

    #[test]
    fn half_a_turn_of_phi_d_swaps_the_directions_and_nothing_else() {
        let reciprocal = table([4, 5, 6], |i| i as f32);
        let (wi, wo) = pair(0.3, 0.5, 1.2);
        assert_eq!(reciprocal.bin(wi, wo), reciprocal.bin(wo, wi));
        let (a, b) = (reciprocal.eval_linear(wi, wo), reciprocal.eval_linear(wo, wi));
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-9));
        let directed = table([4, 5, 20], |i| i as f32);
        assert_ne!(directed.bin(wi, wo), directed.bin(wo, wi));
    }

    #[test]
    fn bins_that_were_not_measured_take_no_part() {
        let gaps = table([4, 5, 6], |i| if i % 2 == 0 { -1.0 } else { 3.0 });
        let (wi, wo) = pair(0.3, 0.5, 1.2);
        assert!(gaps.eval_linear(wi, wo).iter().all(|value| (value - 3.0).abs() < 1e-12));
        let dark = table([4, 5, 6], |_| -1.0);
        assert_eq!((dark.eval_linear(wi, wo), dark.eval_nearest(wi, wo)), ([0.0; 3], [0.0; 3]));
        assert_eq!(gaps.eval_nearest(wi, [0.0, 0.6, -0.8]), [0.0; 3]);
    }

    #[test]
    fn the_last_bins_take_their_upper_ends() {
        let table = table([4, 5, 6], |i| i as f32);
        assert_eq!(table.bin([1.0, 0.0, 1e-17], [-1.0, 0.0, 1e-17])[1], 4);
        assert_eq!(table.bin([1.0, 0.0, 0.0], [1.0, 0.0, 0.0])[0], 3);
        // A `phi_d` just below zero is just below the period.
        let (wi, wo) = pair(0.3, 0.5, -1e-17);
        assert!(table.bin(wi, wo)[2] < 6);
    }

    #[test]
    fn tables_that_do_not_fit_are_named() {
        assert_eq!(HalfDiff::new([0, 5, 6], vec![]).expect_err("no bins").part, "dims");
        assert_eq!(HalfDiff::new([1, 1, 1], vec![0.0; 2]).expect_err("two values").part, "values");
        assert_eq!(HalfDiff::new([1, 1, 1], vec![f32::NAN; 3]).expect_err("NaN").part, "values");
    }
}
