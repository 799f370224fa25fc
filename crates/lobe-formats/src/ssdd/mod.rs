//! SSDD, "surface scattering distribution data", the open format of libbsdf, version 0.3.
//!
//! Up to four blocks: BRDF, BTDF, specular reflectance and specular transmittance. Each has keys in ASCII, angles in
//! degrees, and values in ASCII or as little-endian `f32`, the first parameter fastest and the channels faster still.
//! Values are `f` in 1/sr, without the cosine; those of specular blocks are a share of the light, 0 to 1.

mod read;
mod write;

use lobe_table::spherical_grid::SphericalGrid;
use lobe_table::{Channels, Samples, Scatter};

pub use read::{matches, read};
pub use write::{Encoding, write};

/// One block of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The name in the file; may be empty.
    pub name: String,
    /// The values.
    pub data: Data,
}

/// The values of a block, by its parametrisation.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// A BRDF or BTDF in specular coordinates.
    Specular(Samples),
    /// A BRDF or BTDF in spherical coordinates.
    Spherical(SphericalGrid),
    /// The mirror reflectance or the transmittance straight through.
    Delta(Delta),
}

/// The share of light that a smooth surface mirrors or lets through, by the direction it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Delta {
    /// Mirrored or let through.
    pub scatter: Scatter,
    /// Polar angles, in radians, strictly ascending.
    pub thetas: Vec<f64>,
    /// Azimuths, in radians, strictly ascending; one where they make no difference.
    pub phis: Vec<f64>,
    /// What the channels stand for.
    pub channels: Channels,
    /// `[theta][phi][channel]`, 0 to 1.
    pub values: Vec<f32>,
}
