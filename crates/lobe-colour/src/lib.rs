//! The colour of the channels of a measured material.
//!
//! There is one observer, CIE 1931 (2 degrees), and one white, D65. A material has a colour only under a light: here
//! under D65, where a perfect white has Y = 1 and linear sRGB 1, 1, 1. XYZ in files is assumed to be relative to the
//! same white; nothing is adapted from one white to another, except the bands of window sheets (see [`NamedBands`]) and
//! pictures with other [`Primaries`].
//!
//! - [`Channels`]: the meaning of the numbers of a value;
//! - [`Reduction`]: a linear map from these to XYZ or to linear sRGB;
//! - [`luminance()`]: the weight of each channel when directions are drawn;
//! - [`RGB_TO_XYZ`], [`XYZ_TO_RGB`], [`WHITE`], [`LUMINANCE`]: the numbers behind them;
//! - [`Primaries`]: RGB spaces other than sRGB, which environment pictures may use;
//! - [`ToneMap`], [`encode`]: from linear sRGB to bytes;
//! - [`delta_e`]: the perceived difference of two colours.
#![forbid(unsafe_code)]

mod bands;
mod channels;
mod cie;
mod difference;
mod luminance;
mod primaries;
mod reduction;
mod rgb;
mod tone;

pub use bands::NamedBands;
pub use channels::Channels;
pub use difference::delta_e;
pub use luminance::luminance;
pub use primaries::Primaries;
pub use reduction::{NoColour, Reduction, Space};
pub use rgb::{LUMINANCE, RGB_TO_XYZ, WHITE, XYZ_TO_RGB, rgb_to_xyz, xyz_to_rgb};
pub use tone::{ToneMap, encode};
