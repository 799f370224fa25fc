//! Tests of the readers of meshes, the shapes, and the generated meshes.

mod common;
mod drape;
mod gltf;
mod obj;
mod ply;
mod serialized;
mod shapes;
