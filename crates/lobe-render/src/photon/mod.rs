//! Photons: places where light has arrived, which can be searched by position.
//!
//! The map consists of columns sorted by cell, light path and surface, so it does not depend on the order in which
//! threads have followed the paths. A register of photons is compared with one place at a time; near photons are listed
//! in the order of the map, so sums over them have the same bits on lanes of any width.

mod gather;
mod light_map;
mod map;

pub(crate) use gather::{Near, gather};
pub(crate) use light_map::LightMap;
pub(crate) use map::{Photon, Photons};
