//! Writes the cloth of the studio again.

use std::path::Path;

use lobe_mesh::generate::{Drape, drape};

fn main() -> Result<(), lobe_mesh::FormatError> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/drape.ply");
    lobe_mesh::ply::write(Path::new(file), &drape(&Drape::default()))
}
