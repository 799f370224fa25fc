//! Readers of meshes, shapes, and the generated scenes.

mod common;
mod drape;
mod gltf;
mod obj;
mod ply;
mod serialized;
mod shapes;
