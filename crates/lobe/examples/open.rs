//! Opens a measured material and evaluates it for one pair of directions.

use std::error::Error;

use lobe::Material;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/conductor-7x8x13.ddr");

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let material = Material::open(FILE)?;
    println!("{} with {} channels, on {}", material.kind(), material.channel_count(), material.backend());

    // Unit vectors away from the surface, normal on +z: wi to the light, wo to the viewer, here in the mirror
    // direction.
    let (wi, wo) = ([0.6, 0.0, 0.8], [-0.6, 0.0, 0.8]);
    let mut f = vec![0.0; material.channel_count()];
    material.eval(wi, wo, &mut f);
    for (name, value) in material.channels().names().iter().zip(&f) {
        println!("{name}: {value:.3} 1/sr");
    }
    assert!(f.iter().all(|value| *value > 0.0));
    Ok(())
}
