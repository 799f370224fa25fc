//! A material as measured: knots and values, nothing derived.
//!
//! [`Data`] is what a file reader produces and what a [`Table`](super::Table) is built from. It stores the knots in
//! `f64` radians and the values in `f32`, in the order that the evaluator needs.

use crate::grid::check::{AxisOf, check};
use crate::{Channels, GridError, Scatter};

/// The axes of the specular coordinate system, in the order of every `[_; 4]` in this crate.
pub const AXIS_NAMES: [&str; 4] = ["sigma", "psi", "theta", "phi"];

/// A measured BRDF or BTDF on a grid in specular coordinates, as in a file.
///
/// Axes, all in radians (see [`coords`](crate::specular::coords) for the geometry): `sigma` in `[0, pi/2]`, `psi` in
/// `[0, 2 pi]`, `theta` in `[0, pi]`, `phi` in `[0, 2 pi]`, strictly ascending and in general not uniform. An isotropic
/// table has one psi knot. Values are `f` in 1/sr, without the cosine, in the order
/// `[sigma][psi][theta][phi][channel]`, the channel fastest. Negative values, which measurements contain, are kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    scatter: Scatter,
    knots: [Vec<f64>; 4],
    refraction: Option<Vec<f64>>,
    channels: Channels,
    values: Vec<f32>,
}

const AXES: [AxisOf; 4] = {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    let [sigma, psi, theta, phi] = AXIS_NAMES;
    [
        AxisOf { name: sigma, limit: FRAC_PI_2 },
        AxisOf { name: psi, limit: TAU },
        AxisOf { name: theta, limit: PI },
        AxisOf { name: phi, limit: TAU },
    ]
};

impl Data {
    /// Checks knots and values and stores them. `knots` are in the order of [`AXIS_NAMES`], in radians.
    ///
    /// # Errors
    /// [`GridError`] names the axis, the position, what was found and what was expected.
    pub fn new(
        scatter: Scatter,
        knots: [Vec<f64>; 4],
        channels: Channels,
        values: Vec<f32>,
    ) -> Result<Self, GridError> {
        check(&AXES, &knots, &channels, &values)?;
        Ok(Data { scatter, knots, refraction: None, channels, values })
    }

    /// Adds the refraction offsets of a BTDF: one angle in radians per sigma knot, by which the zenith of the `(theta,
    /// phi)` frame differs from `sigma` (`sigmat - sigma` in a DDT file).
    ///
    /// # Errors
    /// [`GridError::Refraction`] unless there is one finite offset per sigma knot.
    pub fn with_refraction(mut self, offsets: Vec<f64>) -> Result<Self, GridError> {
        if offsets.len() != self.knots[0].len() {
            let expected = self.knots[0].len();
            return Err(GridError::Refraction(format!(
                "{} refraction offsets; expected one per sigma knot, {expected}",
                offsets.len()
            )));
        }
        if let Some(bad) = offsets.iter().find(|o| !o.is_finite()) {
            return Err(GridError::Refraction(format!("refraction offset {bad}; expected a finite angle")));
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

    /// The refraction offset at each sigma knot, in radians, if the table has them.
    pub fn refraction(&self) -> Option<&[f64]> {
        self.refraction.as_deref()
    }

    /// The meaning of the channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// All values, `f` in 1/sr, `[sigma][psi][theta][phi][channel]`.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// `true` if psi has one knot, so that the value does not depend on the rotation of the sample.
    pub fn is_isotropic(&self) -> bool {
        self.knots[1].len() == 1
    }

    /// The channels at one node; `node` holds the knot indices of sigma, psi, theta and phi.
    ///
    /// # Panics
    /// If an index is outside its axis.
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
