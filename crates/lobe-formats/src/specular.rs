//! The reflectance of a smooth surface, a delta function in direction, by angle of incidence.

use lobe_table::{Channels, Scatter};

/// Mirror reflectance (or transmittance straight through) at each sigma knot: a ratio of fluxes, 0 to 1, no pi in it.
///
/// It stands beside a BRDF or BTDF as its delta part.
#[derive(Clone, Debug, PartialEq)]
pub struct Specular {
    scatter: Scatter,
    sigma: Vec<f64>,
    channels: Channels,
    values: Vec<f32>,
}

impl Specular {
    /// `sigma` ascends strictly, in radians; `values` is `[sigma][channel]`. `None` unless the values are as many as
    /// that, and all are finite.
    pub fn new(scatter: Scatter, sigma: Vec<f64>, channels: Channels, values: Vec<f32>) -> Option<Self> {
        let ascending = sigma.windows(2).all(|pair| pair[0] < pair[1]) && sigma.iter().all(|angle| angle.is_finite());
        let sound = ascending && !values.is_empty() && values.iter().all(|value| value.is_finite());
        let fits = sigma.len().checked_mul(channels.count()) == Some(values.len());
        (sound && fits).then_some(Specular { scatter, sigma, channels, values })
    }

    /// Reflection or transmission.
    pub fn scatter(&self) -> Scatter {
        self.scatter
    }

    /// The angles of incidence, in radians.
    pub fn sigma(&self) -> &[f64] {
        &self.sigma
    }

    /// What the channels stand for.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// All values, `[sigma][channel]`.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The reflectance of each channel at `sigma` radians: linear between the knots, constant beyond them.
    pub fn at(&self, sigma: f64) -> Vec<f64> {
        let last = self.sigma.len() - 1;
        let upper = self.sigma.partition_point(|&knot| knot < sigma).min(last);
        let lower = upper.saturating_sub(1);
        let width = self.sigma[upper] - self.sigma[lower];
        let fraction = if width > 0.0 { ((sigma - self.sigma[lower]) / width).clamp(0.0, 1.0) } else { 0.0 };
        let count = self.channels.count();
        let row = |index: usize| self.values[index * count..][..count].iter().map(|&value| f64::from(value));
        row(lower).zip(row(upper)).map(|(a, b)| (1.0 - fraction) * a + fraction * b).collect()
    }
}
