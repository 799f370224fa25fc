//! Coherent rays: packets of four compared with the scalar instance of the same code.

use std::time::Instant;

use lobe::Backend;
use lobe_mesh::shapes;
use lobe_trace::{Form, HitSoA, Mesh, RayClass, RaySoA, Scene};
use serde::Serialize;

/// One set of rays.
#[derive(Clone, Debug, Serialize)]
pub struct Packets {
    /// The kind of rays.
    pub rays: &'static str,
    /// Millions of rays per second, one lane.
    pub scalar: f64,
    /// Millions of rays per second, four lanes of SSE2.
    pub sse2: f64,
}

/// Rays per side of the picture.
const SIDE: usize = 256;
/// Rays that are traced at a time: a few milliseconds.
const PIECE: usize = 1 << 14;

/// Traces a knot of 70 thousand triangles; empty if there is no SSE2.
pub fn measure(rounds: usize) -> Vec<Packets> {
    let (Ok(scalar), Ok(sse2)) = (Backend::named("scalar"), Backend::named("sse2")) else { return Vec::new() };
    let knot = shapes::torus_knot(2, 3, 0.19, 1000, 35);
    let scene: Scene = Scene::of_mesh(Mesh::new(knot.positions.clone(), knot.triangles.clone()).expect("a mesh"));
    let camera = camera();
    let shadow = shadows(&scene, &camera, sse2);
    let of = |name, rays: &RaySoA, any: bool| {
        let [scalar, sse2] = best_times(&scene, rays, any, [scalar, sse2], rounds);
        let millions = rays.len() as f64 * 1e-6;
        Packets { rays: name, scalar: millions / scalar, sse2: millions / sse2 }
    };
    vec![of("camera", &camera, false), of("shadow", &shadow, true)]
}

/// A picture in squares of 8 by 8 rays, so that packets are neighbours.
fn camera() -> RaySoA {
    let mut rays = RaySoA::with_capacity(SIDE * SIDE);
    for at in 0..SIDE * SIDE {
        let (square, within) = (at / 64, at % 64);
        let (x, y) = (square % (SIDE / 8) * 8 + within % 8, square / (SIDE / 8) * 8 + within / 8);
        let [s, t] = [x, y].map(|i| (i as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0);
        rays.push([0.1, 0.2, 5.0], [0.33 * s, 0.33 * t, -1.0], 0.0, f32::INFINITY);
    }
    rays
}

/// Rays toward a point light from the points that the camera sees, or from the same distance if it sees nothing.
fn shadows(scene: &Scene, camera: &RaySoA, backend: Backend) -> RaySoA {
    let mut hits = HitSoA::new(camera.len());
    scene.intersect(backend, RayClass::Camera, camera.view(), hits.view());
    let mut rays = RaySoA::with_capacity(camera.len());
    for at in 0..camera.len() {
        let t = if hits.t[at].is_finite() { 0.999 * hits.t[at] } else { 5.0 };
        let place: [f32; 3] = std::array::from_fn(|k| camera.origin[k][at] + t * camera.direction[k][at]);
        let light = [3.0, 4.0, 5.0];
        rays.push(place, std::array::from_fn(|k| light[k] - place[k]), 0.0, 1.0);
    }
    rays
}

/// Seconds on each backend: the sums of the best times of the pieces, taken in turn.
fn best_times(scene: &Scene, rays: &RaySoA, any: bool, backends: [Backend; 2], rounds: usize) -> [f64; 2] {
    let mut sums = [0.0; 2];
    let mut rest = rays.view();
    let (mut hits, mut occluded) = (HitSoA::new(PIECE), vec![false; PIECE]);
    while !rest.is_empty() {
        let (piece, others) = rest.split_at(PIECE.min(rest.len()));
        rest = others;
        let mut times = [f64::INFINITY; 2];
        for _ in 0..rounds {
            for (time, backend) in times.iter_mut().zip(backends) {
                let begun = Instant::now();
                if any {
                    let out = &mut occluded[..piece.len()];
                    scene.occluded_by(backend, Form::Packet, piece, out);
                } else {
                    hits = HitSoA::new(piece.len());
                    scene.intersect_by(backend, Form::Packet, piece, hits.view());
                }
                *time = time.min(begun.elapsed().as_secs_f64());
            }
        }
        sums.iter_mut().zip(times).for_each(|(sum, time)| *sum += time);
    }
    std::hint::black_box((hits, occluded));
    sums
}
