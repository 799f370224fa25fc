//! Generated meshes.

use lobe_trace::Mesh;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub fn random(seed: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed)
}

/// A surface over a grid of `n` by `m` cells, closed in a parameter if its last row is the first.
fn grid(n: usize, m: usize, closed: [bool; 2], point: impl Fn(f64, f64) -> [f64; 3]) -> Mesh {
    let (rows, columns) = (n + !closed[0] as usize, m + !closed[1] as usize);
    let mut positions = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            positions.push(point(i as f64 / n as f64, j as f64 / m as f64).map(|x| x as f32));
        }
    }
    let at = |i: usize, j: usize| (i % rows * columns + j % columns) as u32;
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Mesh::new(positions, triangles).unwrap()
}

/// The unit sphere; the triangles at the poles have two equal corners.
pub fn sphere(n: usize) -> Mesh {
    use std::f64::consts::{PI, TAU};
    let ring = |t: f64| if t == 0.0 || t == 1.0 { 0.0 } else { (PI * t).sin() };
    grid(n, 2 * n, [false, true], |s, t| {
        let (r, phi) = (ring(s), TAU * t);
        [r * phi.cos(), r * phi.sin(), (PI * s).cos()]
    })
}

/// A tube along the (2, 3) torus knot, about 3 across.
pub fn torus_knot(n: usize, m: usize) -> Mesh {
    use std::f64::consts::TAU;
    let center = |t: f64| {
        let a = TAU * t;
        let r = 1.0 + 0.4 * (3.0 * a).cos();
        [r * (2.0 * a).cos(), r * (2.0 * a).sin(), 0.4 * (3.0 * a).sin()]
    };
    grid(n, m, [true, true], |s, t| {
        let (p, q) = (center(s), center(s + 1e-4));
        let along: [f64; 3] = std::array::from_fn(|i| q[i] - p[i]);
        let across = normalized(cross(along, [p[0], p[1], p[2] + 0.3]));
        let up = normalized(cross(along, across));
        let (sin, cos) = (TAU * t).sin_cos();
        std::array::from_fn(|i| p[i] + 0.17 * (cos * across[i] + sin * up[i]))
    })
}

/// A waving square of cloth.
pub fn cloth(n: usize) -> Mesh {
    grid(n, n, [false, false], |s, t| {
        let (x, y) = (2.0 * s - 1.0, 2.0 * t - 1.0);
        [x, y, 0.15 * (7.0 * x).sin() * (5.0 * y + x).cos()]
    })
}

/// Random triangles: some ordinary, some flat boxes, needles, points, copies of another.
pub fn soup(n: usize) -> Mesh {
    let mut rng = random(7);
    let mut positions: Vec<[f32; 3]> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for kind in 0..n {
        let center: [f32; 3] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let mut corner = |size: [f32; 3]| -> [f32; 3] {
            std::array::from_fn(|axis| center[axis] + size[axis] * rng.random_range(-1.0f32..1.0))
        };
        let first = positions.len() as u32;
        match kind % 6 {
            0 | 1 => positions.extend([corner([0.1; 3]), corner([0.1; 3]), corner([0.1; 3])]),
            2 => positions.extend([corner([0.1, 0.1, 0.0]), corner([0.1, 0.1, 0.0]), corner([0.1, 0.1, 0.0])]),
            3 => positions.extend([corner([0.5, 0.0, 1e-4]), corner([0.5, 1e-4, 0.0]), corner([0.5, 0.0, 0.0])]),
            4 => positions.extend([center; 3]),
            _ => {
                triangles.push(triangles[triangles.len() / 2]);
                continue;
            }
        }
        triangles.push([first, first + 1, first + 2]);
    }
    Mesh::new(positions, triangles).unwrap()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn normalized(a: [f64; 3]) -> [f64; 3] {
    let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / length)
}
