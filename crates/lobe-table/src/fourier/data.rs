//! The coefficients as they were computed.

use crate::invalid::{Invalid, count, finite};
use crate::{Aspect, Channels, Scatter, Side};

/// A series: the start of its coefficients, and their number per channel. Channels follow each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Series {
    /// Index of the first coefficient.
    pub start: u32,
    /// The number of coefficients of each channel; 0 if there is no light.
    pub count: u32,
}

/// The parts of a material, which [`Data::new`] checks.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// Knots of the cosines, in `[-1, 1]`, ascending; 0 may occur twice. They are the cosines of the direction in which
    /// light *travels* toward the surface, and of the direction to the viewer.
    pub mu: Vec<f32>,
    /// `[viewer][light]`, a series for each pair of knots.
    pub series: Vec<Series>,
    /// The coefficients of `f` times the cosine of the light, in 1/sr. With three channels: luminance, red, blue.
    pub coefficients: Vec<f32>,
    /// [`Channels::Mono`] or [`Channels::Rgb`].
    pub channels: Channels,
    /// The refractive index behind the surface, relative to that in front of it.
    pub eta: f32,
}

/// A material described by cosine series.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    parts: Parts,
}

/// The largest distance of a rounded knot outside `[-1, 1]`.
const ROUNDING: f32 = 1e-6;

impl Data {
    /// Checks the parts and stores them.
    ///
    /// # Errors
    /// [`Invalid`] names `mu`, `series`, `coefficients`, `channels` or `eta`.
    pub fn new(parts: Parts) -> Result<Self, Invalid> {
        let Parts { mu, series, coefficients, channels, eta } = &parts;
        finite("mu", mu)?;
        finite("coefficients", coefficients)?;
        if mu.len() < 2 {
            return Err(Invalid::new("mu", format!("{} knots", mu.len()), "2 or more"));
        }
        if let Some(bad) = mu.iter().find(|knot| knot.abs() > 1.0 + ROUNDING) {
            return Err(Invalid::new("mu", format!("knot {bad}"), "-1 to 1"));
        }
        let is_double_zero = |at: usize| mu[at] == 0.0 && mu[at + 1] == 0.0 && (at == 0 || mu[at - 1] < 0.0);
        if let Some(at) = (0..mu.len() - 1).find(|&at| mu[at + 1] <= mu[at] && !is_double_zero(at)) {
            let found = format!("{} after {} at index {}", mu[at + 1], mu[at], at + 1);
            return Err(Invalid::new("mu", found, "ascending knots, of which 0 may occur twice"));
        }
        if mu[mu.len() - 1] <= mu[0] {
            return Err(Invalid::new("mu", "knots of one value", "an interval"));
        }
        count("series", series.len(), &[mu.len(), mu.len()])?;
        if !matches!(channels, Channels::Mono | Channels::Rgb) {
            return Err(Invalid::new("channels", channels.names().join(" "), "one channel or R G B"));
        }
        if !(eta.is_finite() && *eta > 0.0) {
            return Err(Invalid::new("eta", eta.to_string(), "a positive number"));
        }
        let end = |series: &Series| u64::from(series.start) + u64::from(series.count) * channels.count() as u64;
        match series.iter().position(|series| series.count > 0 && end(series) > coefficients.len() as u64) {
            Some(at) => {
                let Series { start, count } = series[at];
                let found = format!("{count} coefficients from {start} on, of {}", coefficients.len());
                Err(Invalid::new("series", found, "series within the coefficients"))
            }
            None => Ok(Data { parts }),
        }
    }

    /// The parts, which satisfy the requirements of [`new`](Self::new).
    pub fn parts(&self) -> &Parts {
        &self.parts
    }

    /// The coefficients of a series in one channel (luminance, red and blue, if there are three).
    ///
    /// # Panics
    /// If there is no such series or channel.
    pub fn coefficients(&self, series: Series, channel: usize) -> &[f32] {
        let count = series.count as usize;
        let start = if count == 0 { 0 } else { series.start as usize + channel * count };
        &self.parts.coefficients[start..start + count]
    }

    /// The series of a pair of knots: one of the viewer and one of the light.
    ///
    /// # Panics
    /// If there is no such knot.
    pub fn series(&self, viewer: usize, light: usize) -> Series {
        self.parts.series[viewer * self.parts.mu.len() + light]
    }

    /// The aspect of a pair of knots, unless one of them is on the horizon.
    pub(super) fn aspect(&self, viewer: usize, light: usize) -> Option<Aspect> {
        let (viewer, light) = (self.parts.mu[viewer], self.parts.mu[light]);
        if viewer == 0.0 || light == 0.0 {
            return None;
        }
        // Light that travels down comes from the front.
        let side = if light < 0.0 { Side::Front } else { Side::Back };
        let scatter = if (viewer > 0.0) == (side == Side::Front) { Scatter::Reflection } else { Scatter::Transmission };
        Some(Aspect { scatter, light: side })
    }

    /// An additional factor for `f`, because radiance changes with the refractive index.
    pub(super) fn radiance(&self, aspect: Aspect) -> f64 {
        let eta = f64::from(self.parts.eta);
        match (aspect.scatter, aspect.light) {
            (Scatter::Reflection, _) => 1.0,
            (Scatter::Transmission, Side::Front) => eta * eta,
            (Scatter::Transmission, Side::Back) => 1.0 / (eta * eta),
        }
    }

    /// The aspects that have coefficients.
    pub(super) fn measured(&self) -> Vec<Aspect> {
        let knots = self.parts.mu.len();
        let has = |wanted: &Aspect| {
            let lit = |at: &usize| self.parts.series[*at].count > 0;
            (0..knots * knots).filter(lit).any(|at| self.aspect(at / knots, at % knots) == Some(*wanted))
        };
        Aspect::ALL.into_iter().filter(has).collect()
    }
}
