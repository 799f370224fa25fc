//! Balls and tiles in a room, each of a different material, so that the hits of neighbouring rays are unrelated after a
//! bounce.

use std::path::Path;
use std::sync::Arc;

use lobe::{Backend, Data, Material, Options, specular};
use lobe_mesh::{Geometry, shapes};
use lobe_render::integrator::Path as PathTracing;
use lobe_render::light::{Environment, Light};
use lobe_render::shader::{BsdfShader, Lambert};
use lobe_render::{Camera, Filter, Rect, Settings, Shape, World, WorldBuilder};

/// A separate table for each of them, with the size of the paper's anisotropic table.
pub const MATERIALS: usize = 36;
/// Balls and tiles per side of the floor.
const SIDE: usize = 6;
const CLOTH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/cloth-17x7x17x13.ddr");

/// The scene with materials on this backend.
pub fn world(backend: Backend) -> anyhow::Result<World> {
    let (_, document) = lobe::formats::open(Path::new(CLOTH))?;
    let Some(Data::Specular(cloth)) = document.only() else { anyhow::bail!("{CLOTH}: no specular table") };
    let mut world = WorldBuilder::new();
    let materials = (0..MATERIALS)
        .map(|number| Ok(world.material(Arc::new(dyed(cloth, number, backend)?))))
        .collect::<anyhow::Result<Vec<_>>>()?;
    let black = world.material(Arc::new(Lambert::new([0.0; 3], backend)));
    let (ball, tile) = (shapes::sphere(0.36, 48), shapes::plane(1.0, 1));
    for (number, &material) in materials.iter().enumerate() {
        let [x, z] = [number % SIDE, number / SIDE].map(|i| i as f32 - 0.5 * (SIDE - 1) as f32);
        world.shape(&moved(&ball, [x, 0.36, z]), material, None, false)?;
        // The tile below it has another material.
        world.shape(&moved(&tile, [x, 0.0, z]), materials[(number * 7 + 11) % MATERIALS], None, false)?;
    }
    // A low ceiling sends much of the light back.
    let ceiling = moved(&shapes::cuboid([8.0, 0.1, 8.0], 1), [0.0, 2.2, 0.0]);
    world.shape(&ceiling, materials[0], None, false)?;
    world.shape(&moved(&shapes::sphere(0.25, 24), [0.5, 1.6, 0.5]), black, Some([30.0; 3]), false)?;
    world.light(Light::Environment(Environment::gradient([0.4, 0.5, 0.7], [0.6; 3], [0.2; 3])?));
    Ok(world.build()?)
}

/// The cloth in another colour.
fn dyed(cloth: &specular::Data, number: usize, backend: Backend) -> anyhow::Result<BsdfShader> {
    let dye: [f32; 3] = std::array::from_fn(|k| 0.5 + 0.5 * ((number * (k + 2) * 5) % 17) as f32 / 16.0);
    let values = cloth.values().iter().enumerate().map(|(at, value)| value * dye[at % 3]).collect();
    let samples = specular::Data::new(cloth.scatter(), cloth.knots().clone(), cloth.channels().clone(), values)?;
    let material = Material::from_samples(samples, &Options::default())?;
    Ok(BsdfShader::measured(material.with_backend(backend))?)
}

/// A mesh at a place.
fn moved(geometry: &Geometry, to: [f32; 3]) -> Shape {
    let whole = geometry.clone().complete();
    Shape {
        positions: whole.positions.iter().map(|p| [0, 1, 2].map(|k| p[k] + to[k])).collect(),
        normals: whole.normals.clone().unwrap_or_default(),
        tangents: whole.tangents.clone().unwrap_or_default(),
        triangles: whole.triangles.clone(),
    }
}

/// The camera, and all settings except the backend and the threads.
pub fn settings() -> Settings {
    let size = [256, 256];
    Settings {
        camera: Camera {
            position: [2.2, 1.5, 5.4],
            target: [0.0, 0.5, 0.0],
            up: [0.0, 1.0, 0.0],
            field_of_view: 0.75,
            lens_radius: 0.0,
            focus_distance: None,
        },
        size,
        window: Rect { x: 0, y: 0, width: size[0], height: size[1] },
        filter: Filter::Tent,
        integrator: Arc::new(PathTracing { depth: 4, limit: f32::INFINITY }),
        samples: 0..2,
        backend: Backend::best(),
        threads: 1,
        time: None,
    }
}
