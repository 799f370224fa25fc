//! Reflectance to measure: analytic models, a simulated woven cloth, and the virtual goniometers that turn them, or any
//! other [`Surface`], into a table of any representation.
//!
//! Everything here is plain `f64` for one pair of directions at a time: the reference from which tables are made and
//! with which they are compared, not the evaluator.
//!
//! Directions are unit vectors that point away from the surface, whose normal is `+z`: `wi` toward the light, `wo`
//! toward the viewer. Values are RGB in 1/sr without the cosine.
#![forbid(unsafe_code)]

mod albedo;
mod blinn;
pub mod cloth;
mod coated;
mod conductor;
mod film;
mod fresnel;
pub mod goniometer;
mod halton;
mod lambert;
mod microfacet;
mod mix;
mod model;
mod oren_nayar;
mod phong;
mod polarised;
mod surface;
mod vec3;
mod ward;

pub use albedo::albedo;
pub use blinn::Blinn;
pub use coated::Coated;
pub use conductor::{Conductor, fresnel_conductor, fresnel_dielectric, half_angle_cosine};
pub use film::Film;
pub use fresnel::{Elements, fresnel};
pub use halton::halton;
pub use lambert::Lambert;
pub use microfacet::Ggx;
pub use mix::Mix;
pub use model::Model;
pub use oren_nayar::OrenNayar;
pub use phong::Phong;
pub use polarised::{RoughCoat, RoughMirrors, base_under};
pub use surface::{Rgb, Surface, is_isotropic};
pub use ward::Ward;
