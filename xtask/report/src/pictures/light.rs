//! Rays from the lights: the gain from packets, generation by generation, and the use of lanes.

use std::sync::Arc;
use std::time::Instant;

use lobe::Backend;
use lobe_mesh::{Geometry, shapes};
use lobe_render::integrator::LightTracing;
use lobe_render::{DEPTHS, Film, Settings, Stats, World, render};
use lobe_trace::{Form, HitSoA, MISS, Mesh, RayClass, RaySoA, Scene};
use serde::Serialize;

use super::scene;

/// One generation of light rays.
#[derive(Clone, Debug, Serialize)]
pub struct LightRays {
    /// Number of surfaces that they have met.
    pub generation: usize,
    /// Millions of rays per second, one by one.
    pub single: f64,
    /// Millions of rays per second, in packets as wide as a register.
    pub packet: f64,
    /// Millions of rays per second, in packets of 64.
    pub large: f64,
    /// The share of lanes in use while materials of the `light` integrator were evaluated.
    pub lanes: f64,
}

/// Rays of the first generation.
const RAYS: usize = 1 << 16;
/// Rays that are traced at a time: a few milliseconds.
const PIECE: usize = 1 << 14;
const GENERATIONS: usize = 4;

/// Traces them on a backend, on one thread.
pub fn measure(world: &World, backend: Backend, rounds: usize) -> Vec<LightRays> {
    let (scene, normals) = room();
    let settings = Settings { backend, threads: 1, integrator: Arc::new(LightTracing::default()), ..scene::settings() };
    let (_, stats): (_, Stats) =
        render(world, &settings, Film::new(settings.window), |_| true).expect("a camera, a window and a light");
    let mut rays = emitted();
    let mut found = Vec::new();
    for generation in 0..GENERATIONS.min(DEPTHS) {
        let [single, packet, large] = best_times(&scene, &rays, backend, rounds).map(|s| rays.len() as f64 * 1e-6 / s);
        let lanes = stats.shading([generation]).lanes_in_use();
        found.push(LightRays { generation, single, packet, large, lanes });
        rays = scattered(&scene, &normals, &rays, backend, generation);
    }
    found
}

/// A knot on a floor in a room, and the normals of its triangles.
fn room() -> (Scene, Vec<[f32; 3]>) {
    let parts: [(Geometry, [f32; 3]); 2] = [
        (shapes::torus_knot(2, 3, 0.19, 1000, 35), [0.0, 1.3, 0.0]),
        (shapes::cuboid([6.0, 4.0, 6.0], 1), [0.0, 1.99, 0.0]),
    ];
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (geometry, to) in parts {
        let first = positions.len() as u32;
        positions.extend(geometry.positions.iter().map(|p| -> [f32; 3] { std::array::from_fn(|k| p[k] + to[k]) }));
        triangles.extend(geometry.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
    }
    let mesh = Mesh::new(positions, triangles.clone()).expect("a mesh");
    let normals = (0..triangles.len()).map(|triangle| {
        let [a, b, c] = mesh.corners(triangle);
        let [u, v]: [[f32; 3]; 2] = [b, c].map(|p| std::array::from_fn(|k| p[k] - a[k]));
        unit([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
    });
    let normals = normals.collect();
    (Scene::of_mesh(mesh), normals)
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f32>().sqrt().max(1e-30);
    v.map(|x| x / length)
}

/// The points of a lattice.
fn numbers(i: usize, turn: usize) -> [f32; 4] {
    let x = i as f64 + 0.5 + 0.37 * turn as f64;
    [0.856_674_883_854_502_9, 0.733_891_856_627_126, 0.628_706_721_008_787, 0.538_596_970_946_928]
        .map(|step| (x * step).fract() as f32)
}

/// Directions in proportion to the cosine with a normal.
fn about(normal: [f32; 3], [u, v]: [f32; 2]) -> [f32; 3] {
    let (z, turn) = (1.0 - 2.0 * u, std::f32::consts::TAU * v);
    let ring = (1.0 - z * z).max(0.0).sqrt();
    let sphere = [ring * turn.cos(), ring * turn.sin(), z];
    unit(std::array::from_fn(|k| 0.9999 * sphere[k] + normal[k]))
}

/// Rays from a square lamp under the ceiling.
fn emitted() -> RaySoA {
    let mut rays = RaySoA::with_capacity(RAYS);
    for i in 0..RAYS {
        let [u, v, s, t] = numbers(i, 0);
        rays.push([u - 0.5, 3.9, v - 0.5], about([0.0, -1.0, 0.0], [s, t]), 0.0, f32::INFINITY);
    }
    rays
}

/// Rays from their hits, as from a diffuse surface.
fn scattered(scene: &Scene, normals: &[[f32; 3]], rays: &RaySoA, backend: Backend, turn: usize) -> RaySoA {
    let mut hits = HitSoA::new(rays.len());
    scene.intersect(backend, RayClass::Diffuse, rays.view(), hits.view());
    let mut next = RaySoA::with_capacity(rays.len());
    for at in (0..rays.len()).filter(|&at| hits.primitive[at] != MISS) {
        let direction = [0, 1, 2].map(|k| rays.direction[k][at]);
        let normal = normals[hits.primitive[at] as usize];
        let toward: f32 = (0..3).map(|k| normal[k] * direction[k]).sum();
        let normal = if toward > 0.0 { normal.map(|x| -x) } else { normal };
        let [u, v, ..] = numbers(at, turn + 1);
        let place: [f32; 3] =
            std::array::from_fn(|k| rays.origin[k][at] + hits.t[at] * direction[k] + 1e-4 * normal[k]);
        next.push(place, about(normal, [u, v]), 0.0, f32::INFINITY);
    }
    next
}

/// Seconds of single rays, of packets and of large ones: the sums of the best times of the pieces, taken in turn.
fn best_times(scene: &Scene, rays: &RaySoA, backend: Backend, rounds: usize) -> [f64; 3] {
    let mut sums = [0.0; 3];
    let mut rest = rays.view();
    while !rest.is_empty() {
        let (piece, others) = rest.split_at(PIECE.min(rest.len()));
        rest = others;
        let mut times = [f64::INFINITY; 3];
        for _ in 0..rounds {
            for (time, form) in times.iter_mut().zip([Form::Single, Form::Packet, Form::Large]) {
                let mut hits = HitSoA::new(piece.len());
                let begun = Instant::now();
                scene.intersect_by(backend, form, piece, hits.view());
                *time = time.min(begun.elapsed().as_secs_f64());
                std::hint::black_box(hits);
            }
        }
        sums.iter_mut().zip(times).for_each(|(sum, time)| *sum += time);
    }
    sums
}
