//! Errors for knots and values that cannot form a grid, or a grid for lanes.

use thiserror::Error;

use super::axis::AxisError;

/// Knots and values that cannot form a grid.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GridError {
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
    /// Knots that do not ascend strictly after rounding to `f32`.
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
    /// A knot outside the range of the axis.
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
    #[error("{found} values; expected {expected}, the knots of the four axes and the channels multiplied")]
    ValueCount {
        /// What was found.
        found: usize,
        /// What the axes and channels require.
        expected: usize,
    },
    /// The table would have more entries than memory can address.
    #[error("the axes and channels require more values than memory can address")]
    TooLarge,
    /// No channel, or a wavelength that is not a positive finite number.
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
    /// Refraction offsets that are not finite, or not one per sigma knot.
    #[error("{0}")]
    Refraction(String),
}

/// Knots and values that cannot form a table for lanes.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TableError {
    /// Knots that cannot form an axis.
    #[error("{axis}: {source}")]
    Axis {
        /// Name of the axis.
        axis: &'static str,
        /// What is wrong with it.
        source: AxisError,
    },
    /// More floats than a lane's 32-bit index reaches.
    #[error("a table of {channels} channels and {nodes} nodes has more floats than a 32-bit index reaches")]
    TooLarge {
        /// The product of the numbers of knots of all axes.
        nodes: usize,
        /// The number of channels.
        channels: usize,
    },
}
