//! SSDD, "surface scattering distribution data", the open format of libbsdf, version 0.3.
//!
//! Up to four blocks: BRDF, BTDF, specular reflectance and specular transmittance. Each has keys in ASCII, angles in
//! degrees, and values in ASCII or as little-endian `f32`, the first parameter fastest and the channels faster still.
//! Values are `f` in 1/sr, without the cosine; those of specular blocks are a share of the light, 0 to 1.

mod read;
mod write;

pub use read::{matches, read};
pub use write::{Encoding, write};
