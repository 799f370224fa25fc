//! A material as it was measured: knots and values, nothing derived.
//!
//! [`Samples`] is what a file reader produces and what a [`Table`](crate::Table) is built from. It keeps the
//! knots in `f64` radians and the values in `f32`, in the order that the evaluator wants them.

use thiserror::Error;

/// The axes of the specular coordinate system, in the order of every `[_; 4]` in this crate.
pub const AXIS_NAMES: [&str; 4] = ["sigma", "psi", "theta", "phi"];

/// Which side of the surface the light leaves on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scatter {
    /// A BRDF: `wi` and `wo` on the same side.
    Reflection,
    /// A BTDF: `wo` on the other side. The zenith of `(theta, phi)` is the mirror image, about the surface, of the
    /// straight-through (or refracted) ray, so tables of both kinds have the same geometry.
    Transmission,
}

/// What the channels of a table stand for.
#[derive(Clone, Debug, PartialEq)]
pub enum Channels {
    /// One value, no colour.
    Mono,
    /// Linear red, green, blue; the file says no more about the primaries.
    Rgb,
    /// CIE tristimulus values X, Y, Z.
    Xyz,
    /// One channel a wavelength, in nm, in the file's order.
    Spectral(Vec<f64>),
    /// Bands that have names only, such as `Visible` and `Solar`.
    Named(Vec<String>),
}

impl Channels {
    /// How many channels there are.
    pub fn count(&self) -> usize {
        match self {
            Channels::Mono => 1,
            Channels::Rgb | Channels::Xyz => 3,
            Channels::Spectral(wavelengths) => wavelengths.len(),
            Channels::Named(names) => names.len(),
        }
    }

    /// A name for each channel, in order: `Y`, or `R G B`, or `X Y Z`, or `550nm`, or what the file calls it.
    pub fn names(&self) -> Vec<String> {
        match self {
            Channels::Mono => vec!["Y".into()],
            Channels::Rgb => ["R", "G", "B"].map(String::from).into(),
            Channels::Xyz => ["X", "Y", "Z"].map(String::from).into(),
            Channels::Spectral(wavelengths) => wavelengths.iter().map(|nm| format!("{nm}nm")).collect(),
            Channels::Named(names) => names.clone(),
        }
    }
}

/// Why knots and values do not make a table.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SamplesError {
    /// An axis without a knot.
    #[error("the {axis} axis has no knots; expected at least one")]
    NoKnots {
        /// Name of the axis.
        axis: &'static str,
    },
    /// A knot that is NaN or infinite.
    #[error("{axis} knot {index} is {value}; expected a finite angle")]
    KnotNotFinite {
        /// Name of the axis.
        axis: &'static str,
        /// Position in the list of knots.
        index: usize,
        /// What was found.
        value: f64,
    },
    /// Knots that do not ascend strictly, also after rounding to `f32`.
    #[error("{axis} knot {index} is {value} rad after {previous} rad; expected strictly ascending knots")]
    KnotsNotAscending {
        /// Name of the axis.
        axis: &'static str,
        /// Position of the second of the two knots.
        index: usize,
        /// The first of the two knots.
        previous: f64,
        /// The second of the two knots.
        value: f64,
    },
    /// A knot outside what the axis can hold.
    #[error("{axis} knot {index} is {value} rad; expected an angle in [0, {limit}] rad")]
    KnotOutOfRange {
        /// Name of the axis.
        axis: &'static str,
        /// Position in the list of knots.
        index: usize,
        /// What was found.
        value: f64,
        /// The largest angle that the axis can hold.
        limit: f64,
    },
    /// The value count is not the product of the axis sizes and the channels.
    #[error("{found} values; expected {expected} = sigma x psi x theta x phi x channels")]
    ValueCount {
        /// What was found.
        found: usize,
        /// What the axes and channels ask for.
        expected: usize,
    },
    /// The table would have more entries than memory can address.
    #[error("the axes and channels ask for more values than memory can address")]
    TooLarge,
    /// No channel, or a wavelength that is no positive finite number.
    #[error("{0}")]
    Channels(String),
    /// A value that is NaN or infinite.
    #[error("value {index} is {value}; expected a finite number")]
    ValueNotFinite {
        /// Position in the value array.
        index: usize,
        /// What was found.
        value: f32,
    },
    /// As many refraction offsets as sigma knots are needed, all finite.
    #[error("{0}")]
    Refraction(String),
}

/// A measured BRDF or BTDF on a grid of specular coordinates, as in a file.
///
/// Axes, all in radians (see [`coords`](crate::coords) for the geometry):
/// `sigma` in `[0, pi/2]`, `psi` in `[0, 2 pi]`, `theta` in `[0, pi]`, `phi` in `[0, 2 pi]`, strictly ascending and
/// not uniform in general. An isotropic table has one psi knot. Values are `f` in 1/sr, without the cosine, in the
/// order `[sigma][psi][theta][phi][channel]`, the channel fastest. Negative values, which measurements have, are kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    scatter: Scatter,
    knots: [Vec<f64>; 4],
    refraction: Option<Vec<f64>>,
    channels: Channels,
    values: Vec<f32>,
}

/// The largest angle an axis can hold, in radians, with room for a knot that was rounded up in its file.
const LIMITS: [f64; 4] = {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    [FRAC_PI_2, TAU, PI, TAU]
};
const ROUNDING: f64 = 1e-5;

impl Samples {
    /// Checks knots and values and keeps them. `knots` are in the order of [`AXIS_NAMES`], in radians.
    ///
    /// # Errors
    /// [`SamplesError`] names the axis, the position, what was found and what was expected.
    pub fn new(
        scatter: Scatter,
        knots: [Vec<f64>; 4],
        channels: Channels,
        values: Vec<f32>,
    ) -> Result<Self, SamplesError> {
        let mut expected = channels.count();
        if let Channels::Spectral(wavelengths) = &channels
            && let Some(bad) = wavelengths.iter().find(|nm| !(nm.is_finite() && **nm > 0.0))
        {
            return Err(SamplesError::Channels(format!("wavelength {bad}; expected a positive number of nm")));
        }
        if expected == 0 {
            return Err(SamplesError::Channels("no channels; expected at least one".into()));
        }
        for (index, axis_knots) in knots.iter().enumerate() {
            check_knots(AXIS_NAMES[index], axis_knots, LIMITS[index])?;
            expected = expected.checked_mul(axis_knots.len()).ok_or(SamplesError::TooLarge)?;
        }
        if values.len() != expected {
            return Err(SamplesError::ValueCount { found: values.len(), expected });
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(SamplesError::ValueNotFinite { index, value: values[index] });
        }
        Ok(Samples { scatter, knots, refraction: None, channels, values })
    }

    /// Adds the refraction offsets of a BTDF: one angle in radians per sigma knot, by which the zenith of the
    /// `(theta, phi)` frame lies away from `sigma` (`sigmat - sigma` in a DDT file).
    ///
    /// # Errors
    /// [`SamplesError::Refraction`] unless there are as many finite offsets as sigma knots.
    pub fn with_refraction(mut self, offsets: Vec<f64>) -> Result<Self, SamplesError> {
        if offsets.len() != self.knots[0].len() {
            let expected = self.knots[0].len();
            return Err(SamplesError::Refraction(format!(
                "{} refraction offsets; expected one per sigma knot, {expected}",
                offsets.len()
            )));
        }
        if let Some(bad) = offsets.iter().find(|o| !o.is_finite()) {
            return Err(SamplesError::Refraction(format!("refraction offset {bad}; expected a finite angle")));
        }
        self.refraction = Some(offsets);
        Ok(self)
    }

    /// Reflection or transmission.
    pub fn scatter(&self) -> Scatter {
        self.scatter
    }

    /// The knots of sigma, psi, theta and phi, in radians.
    pub fn knots(&self) -> &[Vec<f64>; 4] {
        &self.knots
    }

    /// The refraction offset at each sigma knot, in radians, where the table has them.
    pub fn refraction(&self) -> Option<&[f64]> {
        self.refraction.as_deref()
    }

    /// What the channels stand for.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// All values, `f` in 1/sr, `[sigma][psi][theta][phi][channel]`.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// `true` where psi has one knot, so that the value does not depend on the rotation of the sample.
    pub fn is_isotropic(&self) -> bool {
        self.knots[1].len() == 1
    }

    /// The channels at one node; `node` holds the knot indices of sigma, psi, theta and phi.
    ///
    /// # Panics
    /// Where an index is outside its axis.
    pub fn texel(&self, node: [usize; 4]) -> &[f32] {
        let mut at = 0;
        for (axis, index) in self.knots.iter().zip(node) {
            assert!(index < axis.len(), "knot index {index} outside an axis of {}", axis.len());
            at = at * axis.len() + index;
        }
        let channels = self.channels.count();
        &self.values[at * channels..][..channels]
    }
}

fn check_knots(axis: &'static str, knots: &[f64], limit: f64) -> Result<(), SamplesError> {
    if knots.is_empty() {
        return Err(SamplesError::NoKnots { axis });
    }
    for (index, &value) in knots.iter().enumerate() {
        if !value.is_finite() {
            return Err(SamplesError::KnotNotFinite { axis, index, value });
        }
        if value < -ROUNDING || value > limit + ROUNDING {
            return Err(SamplesError::KnotOutOfRange { axis, index, value, limit });
        }
        if index > 0 && value as f32 <= knots[index - 1] as f32 {
            return Err(SamplesError::KnotsNotAscending { axis, index, previous: knots[index - 1], value });
        }
    }
    Ok(())
}
