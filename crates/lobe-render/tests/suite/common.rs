//! Small worlds for tests.

use std::path::Path;
use std::sync::Arc;

use lobe::Options;
use lobe_render::integrator::{AmbientOcclusion, Integrator, Path as PathTracing, Whitted};
use lobe_render::light::{Environment, Light};
use lobe_render::shader::{Backend, Delta, DeltaShader, Lambert, Shader, open};
use lobe_render::{Camera, Film, Filter, Rect, Settings, Shape, World, WorldBuilder, render};

/// A new folder, which is removed when the value is dropped.
pub fn folder() -> tempfile::TempDir {
    if cfg!(target_os = "wasi") {
        // WASI has no folder for temporary files. This fails if it is named already.
        let _ = tempfile::env::override_temp_dir(Path::new("/tmp"));
    }
    tempfile::tempdir().unwrap()
}

/// Paths of up to 8 surfaces.
pub fn path_tracing() -> Arc<dyn Integrator> {
    path_of(8)
}

/// Paths of up to this many surfaces.
pub fn path_of(depth: u32) -> Arc<dyn Integrator> {
    Arc::new(PathTracing { depth, limit: f32::INFINITY })
}

/// Direct light, and rays over up to this many surfaces.
pub fn whitted(depth: u32) -> Arc<dyn Integrator> {
    Arc::new(Whitted { depth })
}

/// Occlusion by surfaces up to a distance.
pub fn ambient(distance: f32) -> Arc<dyn Integrator> {
    Arc::new(AmbientOcclusion { distance })
}

/// A square of side 2 in the plane y = 0 that faces +y, with its tangent rotated about +y.
pub fn plane(turn: f32) -> Shape {
    let (sin, cos) = turn.sin_cos();
    Shape {
        positions: vec![[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        tangents: vec![[cos, 0.0, -sin, 1.0]; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// A sphere with smooth normals.
pub fn sphere(center: [f32; 3], radius: f32) -> Shape {
    const N: u32 = 64;
    let mut shape = Shape::default();
    for j in 0..=N / 2 {
        for i in 0..=N {
            let (theta, phi) =
                (std::f32::consts::TAU * j as f32 / N as f32, std::f32::consts::TAU * i as f32 / N as f32);
            let normal = [theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos()];
            shape.positions.push([0, 1, 2].map(|k| center[k] + radius * normal[k]));
            shape.normals.push(normal);
            shape.tangents.push([phi.cos(), 0.0, -phi.sin(), 1.0]);
        }
    }
    for j in 0..N / 2 {
        for i in 0..N {
            let [a, b] = [j * (N + 1) + i, (j + 1) * (N + 1) + i];
            shape.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    shape
}

/// The fixture of a woven cloth.
pub const CLOTH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/cloth-17x7x17x13.ddr");

pub fn cloth(backend: Backend) -> Arc<dyn Shader> {
    open(Path::new(CLOTH), &Options::default(), backend).unwrap()
}

pub fn lambert(albedo: f32, backend: Backend) -> Arc<dyn Shader> {
    Arc::new(Lambert::new([albedo; 3], backend))
}

/// A bit of everything: cloth, glass, a mirror, a lamp, a sky, a point light.
pub fn mixed() -> World {
    mixed_on(Backend::best())
}

/// The same with materials that run on a backend.
pub fn mixed_on(backend: Backend) -> World {
    let mut world = WorldBuilder::new();
    let materials: Vec<usize> = [
        cloth(backend),
        Arc::new(DeltaShader(Delta::Glass { eta: 1.5, tint: [1.0, 0.9, 0.8] })),
        Arc::new(DeltaShader(Delta::Mirror([0.9; 3]))),
        lambert(0.5, backend),
    ]
    .into_iter()
    .map(|shader| world.material(shader))
    .collect();
    let floor = Shape { positions: plane(0.4).positions.iter().map(|p| p.map(|x| 3.0 * x)).collect(), ..plane(0.4) };
    world.shape(&floor, materials[0], None, false).unwrap();
    world.shape(&sphere([-0.9, 0.6, 0.0], 0.5), materials[1], None, false).unwrap();
    world.shape(&sphere([0.9, 0.6, 0.0], 0.5), materials[2], None, false).unwrap();
    world.shape(&sphere([0.0, 0.5, -1.0], 0.5), materials[0], None, false).unwrap();
    world.shape(&sphere([0.0, 3.0, 1.0], 0.3), materials[3], Some([12.0, 11.0, 9.0]), false).unwrap();
    world.light(Light::Environment(Environment::gradient([0.3, 0.4, 0.8], [0.5; 3], [0.1; 3]).unwrap()));
    world.light(Light::Point { position: [2.0, 2.0, 2.0], intensity: [3.0; 3] });
    world.build().unwrap()
}

pub fn settings(size: [u32; 2], samples: u32, integrator: Arc<dyn Integrator>) -> Settings {
    let camera = Camera {
        position: [0.0, 1.2, 4.0],
        target: [0.0, 0.5, 0.0],
        up: [0.0, 1.0, 0.0],
        field_of_view: 0.8,
        lens_radius: 0.02,
        focus_distance: None,
    };
    let window = Rect { x: 0, y: 0, width: size[0], height: size[1] };
    Settings {
        camera,
        size,
        window,
        filter: Filter::Tent,
        integrator,
        samples: 0..samples,
        backend: Backend::best(),
        threads: 2,
        time: None,
    }
}

pub fn picture(world: &World, settings: &Settings) -> Film {
    let (film, stats) = render(world, settings, Film::new(settings.window), |_| true).unwrap();
    assert_eq!(stats.invalid, 0, "samples that are not numbers");
    film
}

/// The mean over all pixels and channels.
pub fn mean(film: &Film) -> f64 {
    let sum: f64 = film.colours().flatten().map(f64::from).sum();
    sum / (3 * film.pixels().len()) as f64
}
