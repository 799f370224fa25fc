//! The evaluation of a [`TensorTree`] one query at a time in `f64`: the reference for the lanes.

use super::tree::{INSET, Node, Rank, TensorTree};

/// The largest error of a coordinate in the unit cube in lanes.
const ROUNDING: f64 = 6e-7;

impl TensorTree {
    /// The value for light from `wi` to `wo`, unit vectors that point away from the surface, each on either side.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        self.at(self.position(wi, wo))
    }

    /// All values that [`eval`](Self::eval) may have in the lanes: that of the cell and, if the position is within
    /// rounding of another cell, that of the other cell too.
    pub fn candidates(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f64> {
        let position = self.position(wi, wo);
        let corners = 0..1_usize << self.rank.dimensions();
        let moved = |corner: usize| {
            let toward = |dimension: usize| if corner >> dimension & 1 == 1 { ROUNDING } else { -ROUNDING };
            std::array::from_fn(|dimension| (position[dimension] + toward(dimension)).clamp(0.0, 1.0))
        };
        std::iter::once(position).chain(corners.map(moved)).map(|position| self.at(position)).collect()
    }

    /// The exact share of the light from `wi` that is scattered to all directions of the exit side: the map of the disk
    /// onto the square preserves areas, so it is pi times the mean over the square.
    pub fn albedo(&self, wi: [f64; 3]) -> f64 {
        let position = self.position(wi, [0.0, 0.0, 1.0]);
        let incident = self.rank.dimensions() - 2;
        // Nodes, with the place of the light in each and the share of the square that each fills.
        let mut pending = vec![(0_usize, [position[0], position[1]], 1.0_f64)];
        let mut sum = 0.0;
        while let Some((node, mut light, share)) = pending.pop() {
            match self.nodes[node] {
                Node::Branch(first) => {
                    let mut child = first as usize;
                    for (dimension, x) in light[..incident].iter_mut().enumerate() {
                        let upper = *x >= 0.5;
                        child += usize::from(upper) << dimension;
                        *x = 2.0 * *x - f64::from(u8::from(upper));
                    }
                    pending.extend((0..4).map(|exit| (child + (exit << incident), light, 0.25 * share)));
                }
                Node::Leaf { first, level } => {
                    let cells = 1_usize << level;
                    let of_light = light[..incident]
                        .iter()
                        .fold(0, |at, x| at * cells + ((x * cells as f64) as usize).min(cells - 1));
                    let values = &self.values[first as usize + of_light * cells * cells..][..cells * cells];
                    sum += share * values.iter().map(|&f| f64::from(f)).sum::<f64>() / values.len() as f64;
                }
            }
        }
        std::f64::consts::PI * sum
    }

    /// The position of a pair in the unit cube.
    fn position(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 4] {
        match self.rank {
            Rank::Three => isotropic_position(wi, wo),
            Rank::Four => {
                let ([a, b], [c, d]) = (square(-wi[0], -wi[1]), square(wo[0], wo[1]));
                [a, b, c, d]
            }
        }
    }

    /// The value at a position in the unit cube; a tree of rank 3 ignores the fourth coordinate.
    pub(super) fn at(&self, mut position: [f64; 4]) -> f64 {
        let dimensions = self.rank.dimensions();
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Branch(first) => {
                    let mut child = 0;
                    for (dimension, x) in position[..dimensions].iter_mut().enumerate() {
                        let upper = *x >= 0.5;
                        child |= usize::from(upper) << dimension;
                        *x = 2.0 * *x - f64::from(u8::from(upper));
                    }
                    node = first as usize + child;
                }
                Node::Leaf { first, level } => {
                    let cells = 1_usize << level;
                    let cell = position[..dimensions]
                        .iter()
                        .fold(0, |at, x| at * cells + ((x * cells as f64) as usize).min(cells - 1));
                    return f64::from(self.values[first as usize + cell]);
                }
            }
        }
    }
}

/// The position of a direction pair in a tree of rank 3. The exit direction is rotated with the incident one onto the
/// plane of incidence; only the lower half of the radius dimension is in use, as in the files.
fn isotropic_position(wi: [f64; 3], wo: [f64; 3]) -> [f64; 4] {
    let (x, y) = (-wi[0], -wi[1]);
    let radius = x.hypot(y);
    let (cos, sin) = if radius > 0.0 { (x / radius, y / radius) } else { (1.0, 0.0) };
    let [c, d] = square(cos * wo[0] + sin * wo[1], cos * wo[1] - sin * wo[0]);
    [(0.5 - INSET - 0.5 * radius).max(0.0), c, d, 0.0]
}

/// Shirley and Chiu's concentric map of the unit disk onto the unit square.
pub fn square(x: f64, y: f64) -> [f64; 2] {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    let r = x.hypot(y).min(1.0);
    let mut phi = y.atan2(x);
    if phi < -FRAC_PI_4 {
        phi += 2.0 * PI;
    }
    let (a, b) = if phi < FRAC_PI_4 {
        (r, phi * r / FRAC_PI_4)
    } else if phi < 3.0 * FRAC_PI_4 {
        ((FRAC_PI_2 - phi) * r / FRAC_PI_4, r)
    } else if phi < 5.0 * FRAC_PI_4 {
        (-r, (PI - phi) * r / FRAC_PI_4)
    } else {
        ((phi - 3.0 * FRAC_PI_2) * r / FRAC_PI_4, -r)
    };
    [0.5 * (a + 1.0), 0.5 * (b + 1.0)]
}
