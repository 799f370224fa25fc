//! Contact between particles of one cloth.

use glam::DVec3;

/// Distance that particles keep, in spacings: more than half the diagonal of a cell, so that none can slip through it.
const THICKNESS: f64 = 0.9;
/// Distance up to which pairs are considered until the next search, in spacings.
const REACH: f64 = 1.9;
/// Share by which friction reduces the sliding of two particles on each other.
const FRICTION: f64 = 0.1;

/// The pairs of particles that may touch before the next search.
pub(super) struct Contacts {
    /// Particles along one side of the cloth.
    n: usize,
    spacing: f64,
    pairs: Vec<[u32; 2]>,
}

impl Contacts {
    pub fn new(n: usize, spacing: f64) -> Contacts {
        Contacts { n, spacing, pairs: Vec::new() }
    }

    /// Finds all pairs within reach, except for those that the weave itself holds close together.
    pub fn search(&mut self, positions: &[DVec3]) {
        let reach = REACH * self.spacing;
        let cell = |p: DVec3| (p / reach).floor().as_i64vec3();
        // Particles in order of their cells: a row of cells along z is one range.
        let mut order: Vec<([i64; 3], u32)> = (0u32..).zip(positions).map(|(i, &p)| (cell(p).to_array(), i)).collect();
        order.sort_unstable();
        self.pairs.clear();
        for (at, &([x, y, z], i)) in order.iter().enumerate() {
            // Half of the neighbouring cells, and the later particles of its own row: each pair is seen once.
            let rows = [[x, y + 1], [x + 1, y - 1], [x + 1, y], [x + 1, y + 1]];
            let begins = rows.map(|[x, y]| order.partition_point(|&(cell, _)| cell < [x, y, z - 1]));
            for ([x, y], begin) in rows.into_iter().zip(begins).chain([([x, y], at + 1)]) {
                for &(_, j) in order[begin..].iter().take_while(|&&(cell, _)| cell <= [x, y, z + 1]) {
                    let near = positions[i as usize].distance_squared(positions[j as usize]) < reach * reach;
                    if near && !self.neighbours(i, j) {
                        self.pairs.push([i, j]);
                    }
                }
            }
        }
    }

    /// `true` if two particles are at most two cells apart in the weave.
    fn neighbours(&self, i: u32, j: u32) -> bool {
        let [(a, b), (c, d)] = [i, j].map(|k| (k as usize % self.n, k as usize / self.n));
        a.abs_diff(c) <= 2 && b.abs_diff(d) <= 2
    }

    /// Moves apart pairs that are too close, and lets them drag each other along a little.
    pub fn separate(&self, positions: &mut [DVec3], former: &[DVec3]) {
        let thickness = THICKNESS * self.spacing;
        for &[a, b] in &self.pairs {
            let [a, b] = [a as usize, b as usize];
            let between = positions[b] - positions[a];
            let square = between.length_squared();
            if square >= thickness * thickness || square == 0.0 {
                continue;
            }
            let distance = square.sqrt();
            let push = between * (0.5 * (thickness / distance - 1.0));
            let slide = (positions[b] - former[b]) - (positions[a] - former[a]);
            let drag = slide * (0.5 * FRICTION);
            positions[a] += drag - push;
            positions[b] += push - drag;
        }
    }
}
