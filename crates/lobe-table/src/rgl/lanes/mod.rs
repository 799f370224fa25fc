//! [`Data`](super::Data) prepared for evaluation in SIMD lanes.
//!
//! A block of queries goes through short passes, as in a [`Table`](crate::specular::Table):
//!
//! 1. `frame`: from directions to the half vector, moved to the stored azimuths;
//! 2. `angles`: inverse trigonometry, and positions on the unit square;
//! 3. the slices to blend, by zenith angle and azimuth of `wi`;
//! 4. `invert`: from the position of the half vector back to the uniform position that the visible normals warp to it;
//! 5. `factor`: `ndf / (4 sigma)`, if the material requires it;
//! 6. `spectra`: the texels at the uniform position, weighted and summed.
//!
//! Sampling goes the other way: `draw` warps uniform numbers by the luminance and then by the visible normals,
//! `reflect` turns the half vector into a direction, and the last two passes are the same.

mod angles;
mod batch;
mod draw;
mod factor;
mod frame;
mod grid;
mod invert;
mod passes;
mod reflect;
mod sample;
mod spectra;
mod table;
mod warp;

pub use batch::Wanted;
pub use sample::Drawn;
pub use table::{Options, Table};
