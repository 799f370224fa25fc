//! The checks of knots and values that all grids share.

use super::error::GridError;
use crate::Channels;

/// The name of a grid axis in files, and the angles that it can hold.
pub(crate) struct AxisOf {
    pub(crate) name: &'static str,
    /// The largest angle, in radians; the smallest is 0.
    pub(crate) limit: f64,
}

/// The largest distance of a knot, rounded in its file, beyond its limits, in radians.
pub(crate) const KNOT_ROUNDING: f64 = 1e-5;

/// Checks the knots of each axis, that there are channels, and that each node has a finite value for each channel.
pub(crate) fn check(
    axes: &[AxisOf; 4],
    knots: &[Vec<f64>; 4],
    channels: &Channels,
    values: &[f32],
) -> Result<(), GridError> {
    if let Channels::Spectral(wavelengths) = channels
        && let Some(bad) = wavelengths.iter().find(|nm| !(nm.is_finite() && **nm > 0.0))
    {
        return Err(GridError::Channels(format!("wavelength {bad}; expected a positive number of nm")));
    }
    let mut expected = channels.count();
    if expected == 0 {
        return Err(GridError::Channels("no channels; expected at least one".into()));
    }
    for (axis, knots) in axes.iter().zip(knots) {
        axis.check(knots)?;
        expected = expected.checked_mul(knots.len()).ok_or(GridError::TooLarge)?;
    }
    if values.len() != expected {
        return Err(GridError::ValueCount { found: values.len(), expected });
    }
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(GridError::ValueNotFinite { index, value: values[index] }),
        None => Ok(()),
    }
}

impl AxisOf {
    /// Checks that there are knots, all finite and within the limits, which still ascend after rounding to `f32`.
    fn check(&self, knots: &[f64]) -> Result<(), GridError> {
        let &AxisOf { name: axis, limit } = self;
        if knots.is_empty() {
            return Err(GridError::NoKnots { axis });
        }
        for (index, &value) in knots.iter().enumerate() {
            if !value.is_finite() {
                return Err(GridError::KnotNotFinite { axis, index, value });
            }
            if !(-KNOT_ROUNDING..=limit + KNOT_ROUNDING).contains(&value) {
                return Err(GridError::KnotOutOfRange { axis, index, value, limit });
            }
            if index > 0 && value as f32 <= knots[index - 1] as f32 {
                return Err(GridError::KnotsNotAscending { axis, index, previous: knots[index - 1], value });
            }
        }
        Ok(())
    }
}
