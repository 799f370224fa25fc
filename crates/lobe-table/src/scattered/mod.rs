//! Measurements without a grid: any number of outgoing directions for any number of incident ones.
//!
//! Interpolation is linear on two levels of Delaunay triangulations, both in the azimuthal equidistant projection
//! `theta (cos phi, sin phi)`, in which a pole is one point, azimuths have no seam, and a grid stays linear in theta.
//! One triangulation is over the incident directions and selects up to three of them; each of these has one over its
//! own outgoing directions. Between incident directions, the outgoing one is rotated with the mirror direction, so that
//! a peak moves from one measurement to the next instead of fading out here while it fades in there. Outside the
//! measured region, the value at the nearest point of the convex hull is used.

mod bound;
#[cfg(feature = "scattered")]
mod cells;
mod data;
mod line;
#[cfg(feature = "scattered")]
mod locate;
mod mesh;
mod prepared;
#[cfg(feature = "scattered")]
mod regions;
mod representation;
mod rim;
#[cfg(feature = "scattered")]
mod table;

pub use data::{Data, ScatteredError};
pub use representation::KIND;
#[cfg(feature = "scattered")]
pub use table::Table;
