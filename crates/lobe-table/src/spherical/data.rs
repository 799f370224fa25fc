//! A material as it was measured: knots and values, nothing derived.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::grid::check::{AxisOf, KNOT_ROUNDING, check};
use crate::{Channels, GridError, Scatter};

/// The axes of spherical coordinates, in the order of every `[_; 4]` of these grids.
pub const AXIS_NAMES: [&str; 4] = ["theta_i", "phi_i", "theta_o", "phi_o"];

/// A BRDF or BTDF on a grid of `theta_i`, `phi_i`, `theta_o`, `phi_o`, in radians.
///
/// Polar angles are in `[0, pi/2]`, from the normal on the side of their direction; azimuths in `[0, 2 pi]`; all
/// strictly ascending. A grid with one `phi_i` is isotropic: only the difference of the azimuths matters. Values are
/// `f` in 1/sr, without the cosine, `[theta_i][phi_i][theta_o][phi_o][channel]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    scatter: Scatter,
    knots: [Vec<f64>; 4],
    channels: Channels,
    values: Vec<f32>,
    is_mirrored: bool,
}

const AXES: [AxisOf; 4] = {
    let [theta_i, phi_i, theta_o, phi_o] = AXIS_NAMES;
    [
        AxisOf { name: theta_i, limit: FRAC_PI_2 },
        AxisOf { name: phi_i, limit: TAU },
        AxisOf { name: theta_o, limit: FRAC_PI_2 },
        AxisOf { name: phi_o, limit: TAU },
    ]
};

impl Data {
    /// Checks knots and values and stores them.
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
        Ok(Data { scatter, knots, channels, values, is_mirrored: false })
    }

    /// Makes the grid one half of an isotropic material whose other half, across the plane of incidence, is its mirror
    /// image. `phi_o` is then the angle between the azimuths, and values are constant beyond its knots.
    ///
    /// # Errors
    /// [`GridError::KnotOutOfRange`] if there is a second `phi_i`, or a `phi_o` beyond half a turn.
    pub fn mirrored(self) -> Result<Self, GridError> {
        for (axis, limit, least) in [(1, 0.0, 1), (3, PI, 0)] {
            let mut knots = self.knots[axis].iter().enumerate().skip(least);
            if let Some((index, &value)) = knots.find(|(_, knot)| **knot > limit + KNOT_ROUNDING) {
                return Err(GridError::KnotOutOfRange { axis: AXIS_NAMES[axis], index, value, limit });
            }
        }
        Ok(Data { is_mirrored: true, ..self })
    }

    /// `true` if the grid is one half of a material, see [`mirrored`](Self::mirrored).
    pub fn is_mirrored(&self) -> bool {
        self.is_mirrored
    }

    /// Reflection or transmission.
    pub fn scatter(&self) -> Scatter {
        self.scatter
    }

    /// The knots of `theta_i`, `phi_i`, `theta_o` and `phi_o`, in radians.
    pub fn knots(&self) -> &[Vec<f64>; 4] {
        &self.knots
    }

    /// The meaning of the channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// All values, in 1/sr, `[theta_i][phi_i][theta_o][phi_o][channel]`.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// `true` if the value depends only on the difference of the azimuths.
    pub fn is_isotropic(&self) -> bool {
        self.knots[1].len() == 1
    }
}
