//! Pairs of directions as a renderer queries them.

use std::f32::consts::TAU;

use lobe::Buffer;
use lobe::table::specular::coords::directions_to_angles;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// Pairs of directions as separate components, `wi` toward the light and `wo` toward the viewer.
#[derive(Clone, Debug)]
pub struct Pairs {
    /// Components of `wi`.
    pub wi: [Buffer<f32>; 3],
    /// Components of `wo`.
    pub wo: [Buffer<f32>; 3],
}

impl FromIterator<([f32; 3], [f32; 3])> for Pairs {
    fn from_iter<I: IntoIterator<Item = ([f32; 3], [f32; 3])>>(pairs: I) -> Self {
        let (wi, wo): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
        let columns = |w: &[[f32; 3]]| [0, 1, 2].map(|k| w.iter().map(|w| w[k]).collect());
        Pairs { wi: columns(&wi), wo: columns(&wo) }
    }
}

/// How neighbouring queries relate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// Neighbouring pixels of a picture.
    Coherent,
    /// No relation.
    Incoherent,
}

impl Input {
    /// Both, in the order of the report.
    pub const ALL: [Input; 2] = [Input::Incoherent, Input::Coherent];

    /// `coherent` or `incoherent`.
    pub fn name(self) -> &'static str {
        match self {
            Input::Coherent => "coherent",
            Input::Incoherent => "incoherent",
        }
    }

    /// `count` pairs.
    pub fn pairs(self, count: usize) -> Pairs {
        match self {
            Input::Coherent => Pairs::sphere_picture(count),
            Input::Incoherent => Pairs::uniform(count),
        }
    }

    /// The angles, in radians, between `wo` and the mirror direction of `count` pairs.
    pub fn thetas(self, count: usize) -> Vec<f64> {
        let (wi, wo) = self.pairs(count).vectors();
        let theta = |(wi, wo): (&[f32; 3], &[f32; 3])| {
            directions_to_angles(wi.map(f64::from), wo.map(f64::from), |sigma| sigma)[2]
        };
        wi.iter().zip(&wo).map(theta).collect()
    }
}

impl Pairs {
    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.wi[0].len()
    }

    /// `true` if there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Pair `at`.
    pub fn get(&self, at: usize) -> ([f32; 3], [f32; 3]) {
        let at = |w: &[Buffer<f32>; 3]| [w[0][at], w[1][at], w[2][at]];
        (at(&self.wi), at(&self.wo))
    }

    /// The pairs as two lists of vectors.
    pub fn vectors(&self) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
        (0..self.len()).map(|at| self.get(at)).unzip()
    }

    /// Both directions uniform on the upper hemisphere, independent of each other.
    pub fn uniform(count: usize) -> Self {
        let mut rng = Pcg32::seed_from_u64(2005);
        let mut direction = || {
            let (z, turn) = (rng.random_range(1e-3..1.0f32), rng.random::<f32>() * TAU);
            let across = (1.0 - z * z).sqrt();
            [across * turn.cos(), across * turn.sin(), z]
        };
        (0..count).map(|_| (direction(), direction())).collect()
    }

    /// The pixels of a picture of a sphere under a point light, in tiles of 8 x 8 pixels, each in Morton order, so that
    /// every run of four or eight is a block of neighbouring pixels. The tiles are spread over the picture, so that a
    /// few represent all of it. The local frame's x axis follows the circles of latitude.
    pub fn sphere_picture(count: usize) -> Self {
        const SIZE: u32 = 760;
        const TILE: u32 = 8 * 8;
        // The tiles of a square whose side is the next power of two.
        const TILES: u32 = SIZE.next_power_of_two().pow(2) / TILE;
        // Odd, and near the golden section of the number of tiles, so that every tile comes once, far from the previous
        // one.
        const STEP: u32 = (TILES as f64 * 0.618) as u32 | 1;
        let light = [2.0f32, 3.0, 4.0];
        let mut pairs = Vec::new();
        let mut pixel = 0u32;
        while pairs.len() < count {
            // A picture that is used up begins again: it has more visible pixels than any workload requests at once.
            let tile = (pixel / TILE).wrapping_mul(STEP) % TILES;
            let code = tile * TILE + pixel % TILE;
            pixel = (pixel + 1) % (TILES * TILE);
            let (px, py) = (even_bits(code), even_bits(code >> 1));
            if px >= SIZE || py >= SIZE {
                continue;
            }
            let ndc = |p: u32| 2.0 * (p as f32 + 0.5) / SIZE as f32 - 1.0;
            let (x, y) = (ndc(px), ndc(py));
            let inside = 1.0 - x * x - y * y;
            if inside <= 1e-3 {
                continue;
            }
            let n = [x, y, inside.sqrt()];
            // Orthographic camera: the viewer is at +z for every pixel.
            let view = [0.0, 0.0, 1.0];
            let to_light = normalize([light[0] - n[0], light[1] - n[1], light[2] - n[2]]);
            let tangent = normalize([n[2], 0.0, -n[0]]);
            let bitangent = cross(n, tangent);
            let local = |w: [f32; 3]| [dot(w, tangent), dot(w, bitangent), dot(w, n)];
            let (wi, wo) = (local(to_light), local(view));
            if wi[2] > 0.0 && wo[2] > 0.0 {
                pairs.push((wi, wo));
            }
        }
        pairs.into_iter().collect()
    }
}

/// The bits at even positions, compacted.
fn even_bits(code: u32) -> u32 {
    (0..16).fold(0, |sum, bit| sum | (code >> (2 * bit) & 1) << bit)
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn normalize(a: [f32; 3]) -> [f32; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}
