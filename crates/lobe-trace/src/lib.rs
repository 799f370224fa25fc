//! Coherent ray tracing on SIMD lanes.
//!
//! A [`Scene`] is built from checked [meshes](Mesh) and their instances. Batches of rays ([`RaySoA`]) are traced with
//! [`Scene::intersect`] (nearest hits) and [`Scene::occluded`] (any hit) on any [`Backend`](lobe_backend::Backend); a
//! caller's own kernel traces one ray per lane with a [`Tracer`].
//!
//! - **The class of a ray determines how it traverses the tree** ([`RayClass`]): 64 rays at once for the camera,
//!   mirrors and lights, one ray against all boxes of a node after a diffuse bounce. Incoherent rays are traced one by
//!   one.
//! - **The traversal does not change the answer.** Box tests are conservative, hits are inside the boxes in which they
//!   are found, and of hits at the same t the smaller (primitive, instance) wins. On
//!   [`strict`](lobe_lane::Lanes::strict) backends, hits also have the same bits on every backend and width; others
//!   differ by the rounding of t, u and v.
//! - **No ray leaks** through a shared edge or vertex (Woop, Benthin, Wald, JCGT 2013).
//! - A ray with a NaN, and a zero-area triangle, hit nothing. [`LIMIT`] bounds all coordinates.
//!
//! ```
//! use lobe_backend::Backend;
//! use lobe_trace::{HitSoA, Mesh, RayClass, RaySoA, Scene};
//!
//! let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! let scene: Scene = Scene::of_mesh(Mesh::new(corners, vec![[0, 1, 2]])?);
//! let mut rays = RaySoA::default();
//! rays.push([0.25, 0.5, 3.0], [0.0, 0.0, -1.0], 0.0, f32::INFINITY);
//! let mut hits = HitSoA::new(1);
//! scene.intersect(Backend::best(), RayClass::Camera, rays.view(), hits.view());
//! assert_eq!((hits.primitive[0], hits.t[0], hits.u[0], hits.v[0]), (0, 3.0, 0.25, 0.5));
//! # Ok::<(), lobe_trace::MeshError>(())
//! ```
#![forbid(unsafe_code)]

mod aabb;
mod block;
mod bundles;
mod bvh;
mod class;
mod hull;
mod instances;
mod leaves;
mod mesh;
mod packet;
#[cfg(feature = "rayon")]
mod parallel;
mod rays;
mod scene;
mod slab;
mod trace;
mod transform;
mod triangle_leaves;
mod triangles;
mod walk;
mod woop;

pub use aabb::Aabb;
pub use class::{Form, RayClass};
pub use mesh::{LIMIT, Mesh, MeshError};
pub use packet::{Packet, PacketHits};
#[cfg(feature = "rayon")]
pub use parallel::{intersect, occluded};
pub use rays::{HitSoA, Hits, MISS, RaySoA, Rays};
pub use scene::{Progress, Scene, SceneBuilder, SceneError};
pub use trace::{Intersect, Occluded, Tracer};
pub use transform::Affine;
