//! A renderer for measured materials, which follows the paths of a tile as waves on SIMD lanes.
//!
//! A tile is rendered as a wave: all of its paths at the same depth. Camera rays are traced in packets, hits are sorted
//! by material, each material is evaluated and sampled in full lanes for all of its hits at once, shadow rays are
//! traced, and the paths that continue are the next wave.
//!
//! - [`World`] has triangles, materials ([`shader`]) and lights ([`light`]); [`scene`] reads it from a file.
//! - [`render()`] makes a [`Film`] of it with an [integrator]; [`picture`] writes films as EXR and PNG.
//! - Random numbers depend only on pixel, sample and dimension, and a film sums in integers. So the picture does not
//!   depend on threads, tiles, machines or the order of work; backends in strict form all give the same picture.
//!
//! Nearly everything has the kind of light that travels along a path as a parameter. It is a [`Transport`]: [`Rgb`],
//! [`Bands`] of wavelengths, or polarised light over either, [`Stokes`]. Colours in scenes are in linear sRGB, and
//! become smooth spectra if wavelengths are followed; measured spectra are used as they are.
//!
//! Coordinates are right-handed with +y up. Lengths are in any unit, angles in radians, and radiance in W/(m^2 sr) or
//! any multiple of it.
#![forbid(unsafe_code)]

mod camera;
mod channels;
mod clock;
mod columns;
mod connect;
mod film;
pub mod integrator;
mod interaction;
pub mod light;
mod merge;
mod passes;
mod photon;
pub mod picture;
mod place;
pub mod preview;
mod random;
mod render;
pub mod scene;
mod settings;
pub mod shader;
pub mod stage;
mod stats;
mod steps;
mod transform;
mod transport;
mod vec3;
mod vectors;
mod wavefront;
mod world;

pub use camera::{Camera, CameraError, CameraPdf, CameraSample, Filter, View};
pub use channels::Channels;
pub use film::{Film, FirstHit, Pixel, RADIANCE_UNIT, Rect, SURFACE_UNIT, Sample};
pub use integrator::Integrator;
pub use merge::{Gap, MergeError, merge, merge_in};
pub use render::render;
pub use settings::{Progress, RenderError, Settings};
pub use stats::{DEPTHS, Shading, Stats};
pub use steps::{Step, render_until};
pub use transport::{
    BandConversion, Bands, Bounce, Components, Conversion, Energy16, EnergyRgb, Mueller, Polarisation, RadianceSums,
    Rgb, Rows, Stokes, Stokes16, StokesConversion, StokesRgb, Transport, TransportMode,
};
pub use world::{Shape, World, WorldBuilder, WorldError};
