//! Spectra for rendering: standard illuminants, refractive indices, and the bands of a picture with their colours.
//!
//! - [`Spectrum`]: numbers by wavelength, from a table, a file, an illuminant or a black body;
//! - [`Glass`], [`Metal`]: refractive indices by wavelength;
//! - [`Bands`]: the wavelengths of a picture; conversions from spectra, colours and measured channels to bands, and
//!   from bands to colour.
//!
//! Wavelengths are in nm, in vacuum. Colours are linear sRGB, as in [`lobe_colour`].
#![forbid(unsafe_code)]

mod bands;
mod file;
mod glass;
mod illuminants;
mod metal;
mod metals;
mod observer;
mod resampling;
mod spectrum;
mod upsample;

pub use bands::Bands;
pub use glass::Glass;
pub use metal::Metal;
pub use observer::colours;
pub use resampling::Resampling;
pub use spectrum::{Illuminant, Spectrum, SpectrumError};
