//! No ray from inside a closed mesh escapes, in particular not through its edges and vertices.

use lobe_backend::Backend;
use lobe_trace::{Affine, Form, MISS, Mesh, RaySoA, Scene, SceneBuilder};
use rand::RngExt;

use crate::backends::intersect;
use crate::meshes;

/// From a few points inside, through every vertex, the middle of every edge, and points along it.
fn through_edges(mesh: &Mesh, origins: &[[f32; 3]]) -> RaySoA {
    let mut rng = meshes::random(11);
    let mut rays = RaySoA::default();
    for &origin in origins {
        let mut aim = |target: [f32; 3]| {
            let direction = std::array::from_fn(|axis| target[axis] - origin[axis]);
            rays.push(origin, direction, 0.0, f32::INFINITY);
        };
        mesh.positions().iter().for_each(|&vertex| aim(vertex));
        for triangle in 0..mesh.triangles().len() {
            let [a, b, _] = mesh.corners(triangle);
            for s in [0.5, rng.random_range(0.0f32..1.0), 1e-6] {
                aim(std::array::from_fn(|axis| a[axis] + s * (b[axis] - a[axis])));
            }
        }
    }
    rays
}

fn leaks(backend: Backend, scene: &Scene, rays: &RaySoA) {
    for form in Form::ALL {
        let hits = intersect(backend, scene, rays, form);
        let leaks = hits.primitive.iter().filter(|&&primitive| primitive == MISS).count();
        assert_eq!(leaks, 0, "{backend} {form:?}: of {} rays", rays.len());
    }
}

/// Runs on backends of every width and rounding.
fn no_leak(scene: &Scene, rays: &RaySoA) {
    Backend::forms().into_iter().for_each(|backend| leaks(backend, scene, rays));
}

const ORIGINS: [[f32; 3]; 4] = [[0.0; 3], [0.1, -0.2, 0.3], [0.5, 0.5, -0.5], [-0.9, 0.01, 0.0]];

#[test]
fn sphere() {
    let mesh = meshes::sphere(40);
    let rays = through_edges(&mesh, &ORIGINS);
    no_leak(&Scene::of_mesh(mesh), &rays);
}

/// Vertices with many digits, triangles a few hundred units in the last place across.
#[test]
fn small_sphere_far_from_the_origin() {
    let shift = [100.123, -57.31, 12.77];
    let place = |p: [f32; 3]| std::array::from_fn(|axis| shift[axis] + 0.05 * p[axis]);
    let sphere = meshes::sphere(24);
    let positions = sphere.positions().iter().map(|&p| place(p)).collect();
    let mesh = Mesh::new(positions, sphere.triangles().to_vec()).unwrap();
    let rays = through_edges(&mesh, &ORIGINS.map(|p| place(p.map(|x| 0.9 * x))));
    no_leak(&Scene::of_mesh(mesh), &rays);
}

/// So small that the edge functions are zero in single precision.
#[test]
fn tiny_sphere() {
    let place = |p: [f32; 3]| p.map(|x| x * 1e-24);
    let sphere = meshes::sphere(16);
    let mesh = Mesh::new(sphere.positions().iter().map(|&p| place(p)).collect(), sphere.triangles().to_vec()).unwrap();
    let mut rays = through_edges(&sphere, &ORIGINS);
    rays.origin.iter_mut().flatten().for_each(|x| *x *= 1e-24);
    no_leak(&Scene::of_mesh(mesh), &rays);
}

#[test]
fn instance() {
    let sphere = meshes::sphere(24);
    let map = Affine { rows: [[0.3, 0.9, 0.0, 5.0], [-1.1, 0.2, 0.1, -3.0], [0.0, 0.3, 0.02, 7.0]] };
    let placed = Mesh::new(sphere.positions().iter().map(|&p| map.point(p)).collect(), sphere.triangles().to_vec());
    let rays = through_edges(&placed.unwrap(), &ORIGINS.map(|p| map.point(p)));
    let mut builder = SceneBuilder::new();
    let mesh = builder.mesh(sphere);
    builder.instance(mesh, map);
    no_leak(&builder.build(|_| ()).unwrap(), &rays);
}

/// A box of twelve triangles, thousands of units long, and rays along its diagonals and edges.
#[test]
fn long_box() {
    let positions: Vec<[f32; 3]> = (0..8)
        .map(|i| [(i & 1) as f32 * 8000.1 - 1.3, (i >> 1 & 1) as f32 * 3.7 - 1.1, (i >> 2) as f32 * 0.013 - 0.007])
        .collect();
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = Mesh::new(positions, triangles).unwrap();
    let mut rng = meshes::random(5);
    let origins: Vec<[f32; 3]> = (0..200)
        .map(|_| [rng.random_range(-1.0..7000.0), rng.random_range(-1.0..2.0), rng.random_range(-0.006..0.005)])
        .collect();
    let rays = through_edges(&mesh, &origins);
    no_leak(&Scene::of_mesh(mesh), &rays);
}
