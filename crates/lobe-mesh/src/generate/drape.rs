//! A cloth draped over a sphere.

use glam::DVec3;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg32;

use super::cloth::{Cloth, Obstacles};
use crate::{Geometry, Parts};

/// The cloth and the sphere that it falls on. Lengths are in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drape {
    /// Seed of the small initial unevenness of the cloth, which decides where folds form.
    pub seed: u64,
    /// Vertices along one side of the cloth.
    pub vertices: usize,
    /// Side of the cloth.
    pub side: f64,
    /// Radius of the sphere, which rests on the ground y = 0 with its centre above the origin.
    pub radius: f64,
    /// The point where the middle of the cloth comes down, x and z.
    pub offset: [f64; 2],
    /// Seconds until the cloth hangs still.
    pub duration: f64,
}

impl Default for Drape {
    fn default() -> Self {
        Drape { seed: 2005, vertices: 128, side: 2.0, radius: 0.42, offset: [0.07, -0.05], duration: 2.2 }
    }
}

/// A square cloth that has fallen on a sphere and the ground.
///
/// It has texture coordinates but no normals yet. At the start u ran along +x and v along -z, both from 0 to 1: the
/// weft of a woven material lies along dp/du, the warp along dp/dv, and psi follows the weave.
///
/// This is a simulation and takes seconds. The steps, their order and all numbers are fixed, so the result is always
/// the same, byte for byte.
///
/// # Panics
/// If there are fewer than 3 vertices along a side.
pub fn drape(drape: &Drape) -> Geometry {
    let n = drape.vertices;
    assert!(n >= 3, "a cloth of {n} x {n} vertices");
    let spacing = drape.side / (n - 1) as f64;
    let mut random = Pcg32::seed_from_u64(drape.seed);
    let start = |i: usize, j: usize, random: &mut Pcg32| {
        let [x, z] = [i, j].map(|k| spacing * k as f64 - drape.side / 2.0);
        let uneven = spacing * random.random_range(-0.1..0.1);
        DVec3::new(x + drape.offset[0], 2.0 * drape.radius + spacing + uneven, drape.offset[1] - z)
    };
    let positions = (0..n * n).map(|k| start(k % n, k / n, &mut random)).collect();
    let mut cloth = Cloth::new(positions, n, spacing);
    cloth.fall(&Obstacles { radius: drape.radius }, drape.duration);

    let index = |i: usize, j: usize| (j * n + i) as u32;
    let share = |k: usize| (k as f64 / (n - 1) as f64) as f32;
    let cell = |k: usize| {
        let (i, j) = (k % (n - 1), k / (n - 1));
        let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
        // Diagonals alternate, because otherwise all folds would look combed to one side.
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    Geometry::new(Parts {
        positions: cloth.positions().map(crate::geometry::narrow).collect(),
        uvs: Some((0..n * n).map(|k| [share(k % n), share(k / n)]).collect()),
        triangles: (0..(n - 1) * (n - 1)).flat_map(cell).collect(),
        ..Parts::default()
    })
    .expect("a grid of finite positions")
}
