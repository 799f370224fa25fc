//! Sets of rays around a scene.

use lobe_trace::{Aabb, RaySoA};
use rand::RngExt;

use crate::meshes::random;

/// A picture of `n` by `n` pixels in tiles of 8 by 8, from a point outside the box.
pub fn camera(bounds: Aabb, n: usize) -> RaySoA {
    let center: [f32; 3] = std::array::from_fn(|axis| 0.5 * (bounds.lower[axis] + bounds.upper[axis]));
    let size = (0..3).map(|axis| bounds.upper[axis] - bounds.lower[axis]).fold(0.0, f32::max);
    let eye = [center[0] + 1.1 * size, center[1] + 0.7 * size, center[2] + 0.9 * size];
    let mut rays = RaySoA::default();
    for pixel in 0..n * n {
        let (tile, within) = (pixel / 64, pixel % 64);
        let (x, y) = (tile % (n / 8) * 8 + within % 8, tile / (n / 8) * 8 + within / 8);
        let (s, t) = ((x as f32 + 0.5) / n as f32 - 0.5, (y as f32 + 0.5) / n as f32 - 0.5);
        let target = [center[0] - s * size, center[1] + s * size, center[2] + 1.4 * t * size];
        rays.push(eye, std::array::from_fn(|axis| target[axis] - eye[axis]), 0.0, f32::INFINITY);
    }
    rays
}

/// Packets of 64 rays between two small boxes of all sizes, one of which is often a point: all end at about the same t.
pub fn bounded(bounds: Aabb, packets: usize, seed: u64) -> RaySoA {
    let mut rng = random(seed);
    let mut rays = RaySoA::default();
    let mut around = |center: [f32; 3], scale: f32| -> [f32; 3] {
        std::array::from_fn(|axis| {
            center[axis] + scale * (bounds.upper[axis] - bounds.lower[axis] + 1e-3) * rng.random_range(-0.5f32..0.5)
        })
    };
    let middle = std::array::from_fn(|axis| 0.5 * (bounds.lower[axis] + bounds.upper[axis]));
    for packet in 0..packets {
        let (from, to) = (around(middle, 1.2), around(middle, 1.2));
        let width = |shift: usize| [0.0, 0.01, 0.1, 0.3][packet >> shift & 3];
        for ray in 0..64 {
            let (origin, target) = (around(from, width(0)), around(to, width(2)));
            let end = [1.0, 1.0, 0.25, 300.0][packet >> 4 & 3];
            let direction = std::array::from_fn(|axis| (target[axis] - origin[axis]) / end);
            rays.push(origin, direction, 0.0, if ray % 7 == 3 { 0.9 * end } else { end });
        }
    }
    rays
}

/// Rays of every kind: in all directions, along axes, with short and with bounded intervals, and invalid ones.
pub fn mixed(bounds: Aabb, n: usize, seed: u64) -> RaySoA {
    let mut rng = random(seed);
    let mut rays = RaySoA::default();
    for kind in 0..n {
        let mut inside = |scale: f32| -> [f32; 3] {
            std::array::from_fn(|axis| {
                let (low, high) = (bounds.lower[axis], bounds.upper[axis]);
                0.5 * (low + high) + scale * (high - low + 1e-3) * rng.random_range(-0.5f32..0.5)
            })
        };
        let (origin, target) = (inside(2.5), inside(0.9));
        let mut direction: [f32; 3] = std::array::from_fn(|axis| target[axis] - origin[axis]);
        let (mut t_min, mut t_max) = (0.0, f32::INFINITY);
        match kind % 16 {
            0 => direction[kind / 16 % 3] = 0.0,
            1 => direction = std::array::from_fn(|axis| if axis == kind / 16 % 3 { direction[axis] } else { -0.0 }),
            2 => direction = direction.map(|d| d * 1e4),
            3 => t_max = 1.0,
            4 => t_min = 0.8,
            5 => (t_min, t_max) = (0.6, 0.9),
            6 if kind % 32 == 6 => (t_min, t_max) = (-2.0, -0.01),
            6 => t_min = -2.0,
            7 => direction[kind / 16 % 3] *= 1e-30,
            8 if kind % 160 == 8 => direction[1] = f32::NAN,
            8 if kind % 160 == 24 => (t_min, t_max) = (2.0, 1.0),
            8 if kind % 160 == 40 => direction = [0.0; 3],
            8 if kind % 160 == 56 => t_max = f32::NAN,
            _ => {}
        }
        rays.push(origin, direction, t_min, t_max);
    }
    rays
}

/// One set after another.
pub fn joined(sets: &[RaySoA]) -> RaySoA {
    let mut all = RaySoA::default();
    for set in sets {
        for i in 0..set.len() {
            let at = |rows: &[Vec<f32>; 3]| [rows[0][i], rows[1][i], rows[2][i]];
            all.push(at(&set.origin), at(&set.direction), set.t_min[i], set.t_max[i]);
        }
    }
    all
}
