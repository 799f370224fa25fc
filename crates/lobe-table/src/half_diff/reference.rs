//! The evaluation of [`Data`] one query at a time in `f64`: the reference for the lanes.

use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

use super::data::Data;
use crate::direction::half_difference;
use crate::grid::weights::SUM;
use crate::passes::half_vector;

impl Data {
    /// The bin that a pair of directions falls into.
    pub fn bin(&self, wi: [f64; 3], wo: [f64; 3]) -> [usize; 3] {
        self.coordinates(wi, wo).map(|(x, n)| (x as usize).min(n - 1))
    }

    /// The value of the bin that the directions fall into, without interpolation, as in the reader of the database. 0
    /// if the bin was not measured or a direction is not above the surface.
    pub fn eval_nearest(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        let bin = self.bin(wi, wo);
        if wi[2] <= 0.0 || wo[2] <= 0.0 || !self.is_measured(bin) {
            return [0.0; 3];
        }
        self.texel(bin).map(f64::from)
    }

    /// The value interpolated linearly in the coordinates of the bins. The value of a bin is placed at its middle,
    /// because the measurement averaged over the bin: for `theta_h` that is `pi / 2 ((i + 1/2) / n)^2`. Beyond the
    /// first and last middle the value is constant; `phi_d` repeats. Bins that were not measured are left out of the
    /// average.
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

    /// All values that [`eval_nearest`](Self::eval_nearest) may have in the lanes of a [`Table`](super::Table): that of
    /// the bin and, if the directions are within rounding of other bins, those too.
    pub fn candidates(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<[f64; 3]> {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return vec![[0.0; 3]];
        }
        let [h, d, p] = self.reach(wi, wo);
        let n = self.bins;
        let bin = |x: isize, axis: usize| x.clamp(0, n[axis] as isize - 1) as usize;
        let mut values = Vec::new();
        for h in h.clone() {
            for d in d.clone() {
                for p in p.clone() {
                    let bin = [bin(h, 0), bin(d, 1), p.rem_euclid(n[2] as isize) as usize];
                    values.push(if self.is_measured(bin) { self.texel(bin).map(f64::from) } else { [0.0; 3] });
                }
            }
        }
        values
    }

    /// The bins within rounding along each axis. If an azimuth is undefined, these are all bins.
    fn reach(&self, wi: [f64; 3], wo: [f64; 3]) -> [RangeInclusive<isize>; 3] {
        let (places, errors) = (self.coordinates(wi, wo), self.rounding(wi, wo));
        std::array::from_fn(|axis| {
            let ((x, n), error) = (places[axis], errors[axis]);
            if 2.0 * error >= n as f64 {
                return 0..=n as isize - 1;
            }
            (x - error).floor() as isize..=(x + error).floor() as isize
        })
    }

    /// The largest error, in bins along each axis, of the place of a pair in the lanes of a [`Table`](super::Table).
    ///
    /// The bins of `theta_h` are narrowest at the peak, and near it and near `theta_d = 0` an azimuth is poorly
    /// determined.
    pub fn rounding(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        let (theta_h, theta_d, _) = half_difference(wi, wo);
        let [half, difference, azimuth] = half_vector::rounding(theta_h, theta_d);
        let [h, d, p] = self.bins.map(|n| n as f64);
        let place = |theta: f64| (theta.max(0.0) / FRAC_PI_2).sqrt() * h;
        // The rounding of the places themselves.
        let last = |n: f64| n * f64::from(f32::EPSILON);
        [
            (place(theta_h + half) - place(theta_h)).max(place(theta_h) - place(theta_h - half)) + last(h),
            difference / FRAC_PI_2 * d + last(d),
            azimuth / self.period() * p + last(p),
        ]
    }

    /// The largest error of [`eval_linear`](Self::eval_linear) in the lanes of a [`Table`](crate::half_diff::Table),
    /// relative to the largest difference of two values, if all bins were measured.
    pub fn bound(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        // Between the middles of two bins, a bin apart, the value changes by their difference.
        self.rounding(wi, wo).iter().sum::<f64>() + SUM
    }

    /// The place along each axis, in bins, and the number of bins.
    fn coordinates(&self, wi: [f64; 3], wo: [f64; 3]) -> [(f64, usize); 3] {
        let [h, d, p] = self.bins;
        let (theta_h, theta_d, phi_d) = half_difference(wi, wo);
        let period = self.period();
        // A tiny negative `phi_d` rounds up to the period, which belongs to the last bin.
        let turns = if phi_d < 0.0 { phi_d + period } else { phi_d };
        [
            ((theta_h / FRAC_PI_2 * (h * h) as f64).sqrt(), h),
            (theta_d / FRAC_PI_2 * d as f64, d),
            (turns / period * p as f64, p),
        ]
    }
}
