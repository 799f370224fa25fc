//! Forms, backends and geometry against each other and against double precision.

mod backends;
mod files;
mod meshes;
mod rays;
mod reference;
mod robust;
mod watertight;
