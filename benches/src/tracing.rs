//! Meshes and rays for measurements of tracing.

use std::collections::HashMap;
use std::f32::consts::TAU;

use lobe::Backend;
use lobe_trace::{HitSoA, MISS, Mesh, RayClass, RaySoA, Scene};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

type V = [f32; 3];

fn add(a: V, b: V, s: f32) -> V {
    std::array::from_fn(|i| a[i] + s * b[i])
}
fn dot(a: V, b: V) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn normalized(a: V) -> V {
    a.map(|x| x / dot(a, a).sqrt())
}

/// Vertices and triangles.
pub type Parts = (Vec<V>, Vec<[u32; 3]>);

/// A tube along a torus knot, of `2 along around` triangles.
pub fn knot(along: usize, around: usize) -> Parts {
    let center = |i: usize| -> V {
        let a = TAU * i as f32 / along as f32;
        let r = 1.0 + 0.4 * (3.0 * a).cos();
        [r * (2.0 * a).cos(), r * (2.0 * a).sin(), 0.4 * (3.0 * a).sin()]
    };
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..along {
        let p = center(i);
        let across = normalized(cross(add(center(i + 1), p, -1.0), [p[0], p[1], p[2] + 0.3]));
        let up = normalized(cross(add(center(i + 1), p, -1.0), across));
        for j in 0..around {
            let (sin, cos) = (TAU * j as f32 / around as f32).sin_cos();
            positions.push(add(add(p, across, 0.2 * cos), up, 0.2 * sin));
            let at = |i: usize, j: usize| (i % along * around + j % around) as u32;
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (positions, triangles)
}

/// Each triangle becomes four, and the vertices move a little, so that neighbours are not coplanar.
pub fn subdivided((mut positions, triangles): Parts) -> Parts {
    let mut middles = HashMap::new();
    let mut fine = Vec::with_capacity(4 * triangles.len());
    for [a, b, c] in triangles {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
            *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                positions.push(add(positions[p as usize], positions[q as usize], 1.0).map(|x| 0.5 * x));
                positions.len() as u32 - 1
            })
        });
        fine.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    let moved =
        |[x, y, z]: V| [x + 0.002 * (90.0 * y).sin(), y + 0.002 * (80.0 * z).sin(), z + 0.002 * (70.0 * x).sin()];
    (positions.into_iter().map(moved).collect(), fine)
}

/// A mesh scaled to three units, inside a closed room of six.
///
/// # Panics
/// If the mesh is invalid.
pub fn in_room((positions, mut triangles): Parts) -> Mesh {
    let end = |axis: usize, most: f32| positions.iter().fold(-f32::INFINITY, |end, p| end.max(most * p[axis]));
    let [low, high]: [V; 2] = [-1.0, 1.0].map(|most| std::array::from_fn(|axis| most * end(axis, most)));
    let size = (0..3).fold(0.0, |size: f32, axis| size.max(high[axis] - low[axis]));
    let placed = |p: &V| std::array::from_fn(|axis| 3.0 / size * (p[axis] - 0.5 * (low[axis] + high[axis])));
    let mut positions: Vec<V> = positions.iter().map(placed).collect();
    let base = positions.len() as u32;
    positions.extend((0..8).map(|i| -> V { std::array::from_fn(|axis| if i >> axis & 1 == 0 { -3.0 } else { 3.0 }) }));
    for [a, b, c, d] in [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]] {
        triangles.extend([[a, b, c], [a, c, d]].map(|corners| corners.map(|corner| corner + base)));
    }
    Mesh::new(positions, triangles).expect("a good mesh")
}

/// Rays of one kind.
#[derive(Clone, Debug)]
pub struct RaySet {
    /// Short name.
    pub name: &'static str,
    /// The purpose of the rays.
    pub class: RayClass,
    /// Any hit is enough.
    pub any: bool,
    /// The rays.
    pub rays: RaySoA,
}

/// Rays in the room: the rays of a picture with this many pixels, and the rays that follow from each of them.
pub fn sets(scene: &Scene, pixels: usize) -> Vec<RaySet> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let camera = camera(pixels);
    let mirror = next(scene, &camera, |d, _, n| (add(d, n, -2.0 * dot(d, n)), f32::INFINITY));
    let mut scatter = |_: V, _: V, n: V| loop {
        let p: V = std::array::from_fn(|_| rng.random_range(-1.0f32..1.0));
        if (0.01..1.0).contains(&dot(p, p)) {
            break (add(n, normalized(p), 0.999), f32::INFINITY);
        }
    };
    let diffuse = next(scene, &camera, &mut scatter);
    let diffuse2 = next(scene, &diffuse, &mut scatter);
    let light = [1.5, 2.0, 2.5];
    let shadow = next(scene, &camera, |_, place, _| (add(light, place, -1.0), 1.0));
    let set = |name, class, any, rays| RaySet { name, class, any, rays };
    vec![
        set("camera", RayClass::Camera, false, camera),
        set("shadow", RayClass::Shadow, true, shadow),
        set("mirror", RayClass::Mirror, false, mirror),
        set("diffuse", RayClass::Diffuse, false, diffuse),
        set("diffuse2", RayClass::Diffuse, false, diffuse2),
    ]
}

/// A picture in tiles of 8 by 8 pixels, each in Morton order, about 50 degrees wide.
fn camera(pixels: usize) -> RaySoA {
    let mut rays = RaySoA::with_capacity(pixels * pixels);
    for at in 0..pixels * pixels {
        let (tile, within) = (at / 64, at % 64);
        let even = |bits: usize| bits & 1 | bits >> 1 & 2 | bits >> 2 & 4;
        let (x, y) = (tile % (pixels / 8) * 8 + even(within), tile / (pixels / 8) * 8 + even(within >> 1));
        let [s, t] = [x, y].map(|x| (x as f32 + 0.5) / pixels as f32 * 2.0 - 1.0);
        rays.push([0.9, -0.3, 2.6], [0.5 * s - 0.4, 0.5 * t + 0.05, -1.0], 0.0, f32::INFINITY);
    }
    rays
}

/// Secondary rays: a function of the direction, position and normal of a hit gives the ray.
fn next(scene: &Scene, rays: &RaySoA, mut turn: impl FnMut(V, V, V) -> (V, f32)) -> RaySoA {
    let mut hits = HitSoA::new(rays.len());
    scene.intersect(Backend::scalar(), RayClass::Diffuse, rays.view(), hits.view());
    let mut out = RaySoA::with_capacity(rays.len());
    for ray in 0..rays.len() {
        if hits.primitive[ray] == MISS {
            continue;
        }
        let at = |rows: &[Vec<f32>; 3]| -> V { [rows[0][ray], rows[1][ray], rows[2][ray]] };
        let (origin, direction) = (at(&rays.origin), at(&rays.direction));
        let [a, b, c] = scene.mesh_of(0).corners(hits.primitive[ray] as usize);
        let normal = normalized(cross(add(b, a, -1.0), add(c, a, -1.0)));
        let normal = if dot(normal, direction) > 0.0 { normal.map(|x| -x) } else { normal };
        let place = add(add(origin, direction, hits.t[ray]), normal, 1e-4);
        let (direction, end) = turn(direction, place, normal);
        out.push(place, direction, 0.0, end);
    }
    out
}
