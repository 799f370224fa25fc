//! Triangle meshes on which to show measured materials.
//!
//! [`read`] opens PLY, OBJ, glTF and Mitsuba's serialized files; [`shapes`] makes a sphere, a plane, a disk, a cuboid
//! and tubes; [`generate`] makes the scenes of the previews: a draped cloth, a material ball, a knot. All of them give
//! a [`Geometry`], whose [`complete`](Geometry::complete) adds the normals and tangents that are missing, and whose
//! [`refined`](Geometry::refined) cuts coarse triangles into finer ones.
//!
//! # Conventions
//!
//! - Coordinates are right-handed, and +y is up in every mesh made here. Files keep their own axes.
//! - Triangles are counterclockwise seen from outside.
//! - Texture coordinates are (u, v) with v **up**: (0, 0) is the lower left corner of an image. glTF counts v downward,
//!   so its reader turns v into `1 - v`.
//! - A tangent `t` is the unit direction of dp/du made perpendicular to the normal `n`; dp/dv points to the side of
//!   `w * cross(n, t)`, where w is the fourth component, +1 or -1. So (t, w * cross(n, t), n) is the frame in which psi of
//!   an anisotropic material is measured.
//!
//! Everything is computed in an order that does not depend on threads, in IEEE arithmetic and with the elementary
//! functions of `libm`, so that the same input gives the same bytes on any machine.
#![forbid(unsafe_code)]

mod file;
pub mod generate;
mod geometry;
pub mod gltf;
mod normals;
pub mod obj;
pub mod ply;
mod polygon;
mod read;
mod refine;
pub mod serialized;
pub mod shapes;
mod tangents;

pub use geometry::{Geometry, GeometryError, Group, Parts};
pub use lobe_files::{FormatError, Place};
pub use normals::Shading;
pub use read::read;
