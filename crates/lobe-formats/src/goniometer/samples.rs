//! The rows of a table, in radians.

use lobe_table::Channels;

/// Rows in radians.
pub(super) struct Samples {
    pub angles: Vec<[f64; 4]>,
    /// The line of each.
    pub lines: Vec<u32>,
    /// `[row][channel]`
    pub values: Vec<f32>,
    pub channels: Channels,
    pub is_specular: bool,
}
