//! The bins as they were measured.

use crate::invalid::{Invalid, count, finite};
use std::f64::consts::{PI, TAU};

/// The lookup of values on a grid of half and difference angles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lookup {
    /// The value of the bin, as in the reader of the MERL database.
    #[default]
    Nearest,
    /// Linear between the middles of the bins.
    Linear,
}

/// A measured RGB material on bins of `theta_h`, `theta_d` and `phi_d`.
///
/// Bin `i` of `n` in `theta_h` covers `pi / 2 (i / n)^2` to `pi / 2 ((i + 1) / n)^2`, so that the bins are narrowest at
/// the peak; the other two axes are uniform. `theta_d` spans a quarter turn. `phi_d` spans half a turn, which repeats
/// by reciprocity; in tables of 360 bins, for materials that are not reciprocal, it spans a whole turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    pub(super) bins: [usize; 3],
    pub(super) values: Vec<f32>,
}

impl Data {
    /// Checks that there are `[channel][theta_h][theta_d][phi_d]` values, with three channels, and that they are
    /// finite. `bins` counts `theta_h`, `theta_d`, `phi_d`. Values are `f` in 1/sr, linear RGB; negative ones were not
    /// measured.
    ///
    /// # Errors
    /// [`Invalid`] names `dims` or `values`.
    pub fn new(bins: [usize; 3], values: Vec<f32>) -> Result<Self, Invalid> {
        if bins.contains(&0) {
            return Err(Invalid::new("dims", format!("{bins:?} bins"), "at least one bin in each"));
        }
        count("values", values.len(), &[3, bins[0], bins[1], bins[2]])?;
        finite("values", &values)?;
        Ok(Data { bins, values })
    }

    /// The numbers of bins of `theta_h`, `theta_d` and `phi_d`.
    pub fn bins(&self) -> [usize; 3] {
        self.bins
    }

    /// All values: `[channel][theta_h][theta_d][phi_d]`, `f` in 1/sr.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The period of `phi_d`: `pi`, or `2 pi` for a table with four times as many bins in `phi_d` as in `theta_d`,
    /// which then have the same width.
    pub fn period(&self) -> f64 {
        if self.bins[2] >= 4 * self.bins[1] { TAU } else { PI }
    }

    /// The values of a bin in the three channels, as stored.
    ///
    /// # Panics
    /// If there is no such bin.
    pub fn texel(&self, bin: [usize; 3]) -> [f32; 3] {
        let [h, d, p] = self.bins;
        assert!(bin[0] < h && bin[1] < d && bin[2] < p, "bin {bin:?} of {:?}", self.bins);
        let at = (bin[0] * d + bin[1]) * p + bin[2];
        [0, 1, 2].map(|channel| self.values[channel * h * d * p + at])
    }

    /// All bins, in the order of the values.
    pub(crate) fn each_bin(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [h, d, p] = self.bins;
        (0..h * d * p).map(move |index| [index / (d * p), index / p % d, index % p])
    }

    /// `true` if a bin was measured: the file has negative numbers below the horizon, and where a measurement failed.
    pub fn is_measured(&self, bin: [usize; 3]) -> bool {
        self.texel(bin).iter().all(|value| *value >= 0.0)
    }
}
