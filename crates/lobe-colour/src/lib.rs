//! What the channels of a measured material mean as colour.
//!
//! There is one observer, CIE 1931 of 2 degrees, and one white, D65. A BRDF turns the spectrum of the light into that
//! of what is seen, so the colour of a material is its colour under a light: under D65, where a perfect white has Y = 1
//! and linear sRGB 1, 1, 1. XYZ in files is taken to be relative to the same white; nothing is adapted from one white
//! to another, except the bands of window sheets (see [`NamedBands`]) and pictures with [`Primaries`] of their own.
//!
//! - [`Channels`]: what the numbers of a value mean;
//! - [`Reduction`]: from these to XYZ or to linear sRGB, a linear map;
//! - [`luminance()`]: how much each channel counts when directions are drawn;
//! - [`RGB_TO_XYZ`], [`XYZ_TO_RGB`], [`WHITE`], [`LUMINANCE`]: the numbers behind them;
//! - [`Primaries`]: other RGB spaces than sRGB, in which pictures of surroundings come;
//! - [`ToneMap`], [`encode`]: from linear sRGB to bytes;
//! - [`delta_e`]: how far two colours are apart to the eye.
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
