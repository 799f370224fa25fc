//! Measures surfaces as tensor trees.

use std::f64::consts::FRAC_PI_4;

use lobe_table::window::Block;
use lobe_table::window::tensor_tree::{Node, Rank, TensorTree, TreeError, square};
use rayon::prelude::*;

use crate::Surface;
use crate::vec3::Vec3;

/// How finely a tree divides the directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Rank 3 divides incident directions by their radius, for isotropic surfaces; rank 4 by both coordinates.
    pub rank: Rank,
    /// The largest number of times that each dimension is halved.
    pub depth: u32,
    /// A cell is a leaf if none of its samples differs from their mean by more than this share of the mean, or of the
    /// mean over all directions if that is larger.
    pub error: f64,
}

/// How far below the middle the radii of a tree of rank 3 begin, as in Radiance.
const INSET: f64 = 1e-6;

/// Measures a block of a sheet as one tree per channel, all with the same leaves. The value of a leaf is the mean of
/// `f` at the centres of equal parts of its cell, three (rank 3) or two (rank 4) along each dimension. Cells are halved
/// until they meet [`Refinement::error`] or reach the depth. So that narrow lobes are not missed, every cell is halved
/// at least 4 times (rank 3) or 3 times (rank 4), and a mirror or straight-through direction in a cell is sampled as
/// well.
///
/// # Errors
/// [`TreeError`] if the surface has a value that is not finite, or the depth is larger than a tree may have.
pub fn measure(
    surface: &dyn Surface,
    refinement: Refinement,
    block: Block,
    progress: impl Fn() + Sync,
) -> Result<Vec<TensorTree>, TreeError> {
    let channels = surface.channels().count();
    let builder = Builder { surface, refinement, block, channels, mean: mean(surface, block, channels) };
    let dimensions = refinement.rank.dimensions();
    let root = Cell { low: [0.0; 4], width: 1.0, depth: 0 };
    let tree = match refinement.depth {
        0 => builder.build(root),
        _ => {
            let children: Vec<Tree> = (0..1_usize << dimensions)
                .into_par_iter()
                .map(|child| {
                    let tree = builder.child(root.child(child, dimensions));
                    progress();
                    tree
                })
                .collect();
            Tree::Branch(children)
        }
    };
    (0..channels).map(|channel| flat(refinement.rank, &tree, channel)).collect()
}

/// The number of times that [`measure`] calls `progress`.
pub fn steps(refinement: Refinement) -> usize {
    if refinement.depth == 0 { 0 } else { 1 << refinement.rank.dimensions() }
}

/// The mean of each channel over pairs of directions.
fn mean(surface: &dyn Surface, block: Block, channels: usize) -> Vec<f64> {
    const LIGHTS: u32 = 32;
    const VIEWERS: u32 = 64;
    let mut sums = vec![0.0; channels];
    for light in 1..=LIGHTS {
        let [a, b, ..] = crate::halton(light);
        let wi = disk(a, b);
        let viewers: Vec<Vec3> = (1..=VIEWERS)
            .map(|viewer| {
                let [a, b, ..] = crate::halton(viewer + light * VIEWERS);
                disk(a, b)
            })
            .map(|[x, y]| placed(x, y, exit_side(block)))
            .collect();
        let mut values = vec![0.0; viewers.len() * channels];
        surface.f(placed(wi[0], wi[1], incident_side(block)), &viewers, &mut values);
        for texel in values.chunks_exact(channels) {
            sums.iter_mut().zip(texel).for_each(|(sum, f)| *sum += f / f64::from(LIGHTS * VIEWERS));
        }
    }
    sums
}

fn incident_side(block: Block) -> f64 {
    if matches!(block, Block::TransmissionFront | Block::ReflectionFront) { -1.0 } else { 1.0 }
}

fn exit_side(block: Block) -> f64 {
    if matches!(block, Block::TransmissionFront | Block::ReflectionBack) { 1.0 } else { -1.0 }
}

/// The unit vector above or below a point of the disk.
fn placed(x: f64, y: f64, side: f64) -> Vec3 {
    [x, y, side * (1.0 - x * x - y * y).max(0.0).sqrt()]
}

/// The point of the disk that [`square`] maps to a point of the unit square.
fn disk(a: f64, b: f64) -> [f64; 2] {
    let (a, b) = (2.0 * a - 1.0, 2.0 * b - 1.0);
    // The radius is the larger coordinate, the angle within its quarter is in proportion to the other.
    let (radius, angle) = match (a > -b, a > b) {
        (true, true) => (a, b / a * FRAC_PI_4),
        (true, false) => (b, (2.0 - a / b) * FRAC_PI_4),
        (false, false) => (-a, (4.0 + b / a) * FRAC_PI_4),
        (false, true) => (-b, (6.0 - a / b) * FRAC_PI_4),
    };
    if radius == 0.0 { [0.0; 2] } else { [radius * angle.cos(), radius * angle.sin()] }
}

/// A part of the unit cube.
#[derive(Clone, Copy)]
struct Cell {
    low: [f64; 4],
    width: f64,
    depth: u32,
}

impl Cell {
    /// Child `n` is in the upper half along dimension `d` if bit `d` of `n` is set.
    fn child(self, n: usize, dimensions: usize) -> Cell {
        let width = 0.5 * self.width;
        let mut low = self.low;
        for (dimension, low) in low[..dimensions].iter_mut().enumerate() {
            if n >> dimension & 1 == 1 {
                *low += width;
            }
        }
        Cell { low, width, depth: self.depth + 1 }
    }
}

/// A tree of all channels.
enum Tree {
    Leaf(Vec<f32>),
    Branch(Vec<Tree>),
}

struct Builder<'a> {
    surface: &'a dyn Surface,
    refinement: Refinement,
    block: Block,
    channels: usize,
    mean: Vec<f64>,
}

impl Builder<'_> {
    /// Builds a cell other than the root. The upper half of the radii is not used.
    fn child(&self, cell: Cell) -> Tree {
        match self.refinement.rank {
            Rank::Three if cell.low[0] >= 0.5 => Tree::Leaf(vec![0.0; self.channels]),
            _ => self.build(cell),
        }
    }

    fn build(&self, cell: Cell) -> Tree {
        let (dimensions, certain) = match self.refinement.rank {
            Rank::Three => (3, 4),
            Rank::Four => (4, 3),
        };
        if cell.depth >= self.refinement.depth {
            return Tree::Leaf(self.look(cell).mean);
        }
        if cell.depth >= certain {
            let seen = self.look(cell);
            if seen.is_even {
                return Tree::Leaf(seen.mean);
            }
        }
        Tree::Branch((0..1_usize << dimensions).map(|n| self.child(cell.child(n, dimensions))).collect())
    }

    /// Samples a cell.
    fn look(&self, cell: Cell) -> Seen {
        let mut sums = vec![0.0; self.channels];
        let (mut low, mut high) = (vec![f64::INFINITY; self.channels], vec![f64::NEG_INFINITY; self.channels]);
        let mut bound = |texel: &[f64]| {
            for (channel, f) in texel.iter().enumerate() {
                low[channel] = low[channel].min(*f);
                high[channel] = high[channel].max(*f);
            }
        };
        let lights = self.lights(cell);
        let (first, parts) = match self.refinement.rank {
            Rank::Three => (1, 3),
            Rank::Four => (2, 2),
        };
        let squares = squares(cell, first, parts);
        let count = (lights.len() * squares.len()) as f64;
        for [x, y] in lights {
            // Straight-through and mirrored light has the x and y of the direction in which the light travels.
            let travel = square(x, y);
            let is_within = (0..2).all(|axis| {
                let low = cell.low[first + axis];
                (low..low + cell.width).contains(&travel[axis])
            });
            let exit = exit_side(self.block);
            let mut viewers: Vec<Vec3> = squares.iter().map(|[x, y]| placed(*x, *y, exit)).collect();
            if is_within {
                viewers.push(placed(x, y, exit));
            }
            let mut values = vec![0.0; viewers.len() * self.channels];
            self.surface.f(placed(-x, -y, incident_side(self.block)), &viewers, &mut values);
            for (index, texel) in values.chunks_exact(self.channels).enumerate() {
                bound(texel);
                if index < squares.len() {
                    sums.iter_mut().zip(texel).for_each(|(sum, f)| *sum += f);
                }
            }
        }
        let mean: Vec<f64> = sums.into_iter().map(|sum| sum / count).collect();
        let is_even = mean.iter().enumerate().all(|(channel, mean)| {
            let allowed = self.refinement.error * mean.abs().max(self.mean[channel].abs());
            high[channel] - mean <= allowed && mean - low[channel] <= allowed
        });
        Seen { mean: mean.into_iter().map(|f| f as f32).collect(), is_even }
    }

    /// The directions in which light travels, as points of the disk, at the centres of the parts of a cell.
    fn lights(&self, cell: Cell) -> Vec<[f64; 2]> {
        match self.refinement.rank {
            Rank::Three => {
                const PARTS: usize = 3;
                let middle = |part: usize| cell.low[0] + cell.width * (part as f64 + 0.5) / PARTS as f64;
                (0..PARTS).map(|part| [(1.0 - 2.0 * (middle(part) + INSET)).max(0.0), 0.0]).collect()
            }
            Rank::Four => squares(cell, 0, 2),
        }
    }
}

/// The points of the disk at the centres of the parts of two dimensions of a cell.
fn squares(cell: Cell, first: usize, parts: usize) -> Vec<[f64; 2]> {
    let middle = |axis: usize, part: usize| cell.low[axis] + cell.width * (part as f64 + 0.5) / parts as f64;
    let point = |at: usize| disk(middle(first, at % parts), middle(first + 1, at / parts));
    (0..parts * parts).map(point).collect()
}

/// The samples of a cell.
struct Seen {
    mean: Vec<f32>,
    is_even: bool,
}

/// The nodes and values of one channel: children after their parent, and branches of single leaves as grids.
fn flat(rank: Rank, tree: &Tree, channel: usize) -> Result<TensorTree, TreeError> {
    let dimensions = rank.dimensions();
    let mut nodes = vec![Node::Leaf { first: 0, level: 0 }];
    let mut values: Vec<f32> = Vec::new();
    let mut pending = vec![(0_usize, tree)];
    while let Some((node, tree)) = pending.pop() {
        let position = values.len() as u32;
        match tree {
            Tree::Leaf(value) => {
                nodes[node] = Node::Leaf { first: position, level: 0 };
                values.push(value[channel]);
            }
            Tree::Branch(children) => {
                let leaves: Option<Vec<f32>> = children.iter().map(|child| child.value(channel)).collect();
                match leaves {
                    Some(leaves) => {
                        nodes[node] = Node::Leaf { first: position, level: 1 };
                        // Dimension 0 varies slowest in a grid, but fastest among children.
                        values.extend((0..leaves.len()).map(|at| leaves[reversed(at, dimensions)]));
                    }
                    None => {
                        let first = nodes.len();
                        nodes[node] = Node::Branch(first as u32);
                        nodes.resize(first + children.len(), Node::Leaf { first: 0, level: 0 });
                        pending.extend(children.iter().enumerate().map(|(n, child)| (first + n, child)));
                    }
                }
            }
        }
    }
    TensorTree::new(rank, nodes, values)
}

impl Tree {
    fn value(&self, channel: usize) -> Option<f32> {
        match self {
            Tree::Leaf(value) => Some(value[channel]),
            Tree::Branch(_) => None,
        }
    }
}

/// The same bits in the opposite order.
fn reversed(at: usize, bits: usize) -> usize {
    (0..bits).fold(0, |out, bit| out << 1 | at >> bit & 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Conductor, Ggx, Lambert, Rgb, albedo};

    #[test]
    fn the_disk_and_the_square_are_inverse() {
        for n in 1..400 {
            let [a, b, ..] = crate::halton(n);
            let [x, y] = disk(a, b);
            let [found_a, found_b] = square(x, y);
            assert!((found_a - a).abs() < 1e-12 && (found_b - b).abs() < 1e-12, "{a} {b}");
        }
        assert_eq!(disk(0.5, 0.5), [0.0; 2]);
    }

    #[test]
    fn a_constant_is_one_value_per_cell_that_must_be_halved() {
        let matte = Rgb(Lambert { albedo: [0.5; 3] });
        for rank in [Rank::Three, Rank::Four] {
            let refinement = Refinement { rank, depth: 5, error: 0.01 };
            let trees = measure(&matte, refinement, Block::ReflectionBack, || {}).expect("trees");
            assert_eq!(trees.len(), 3);
            let f = trees[0].eval([0.6, 0.0, 0.8], [0.0, 0.6, 0.8]);
            assert!((f - 0.5 / std::f64::consts::PI).abs() < 1e-6, "{f}");
            let cells: usize = if rank == Rank::Three { 16 * 16 * 8 } else { 4096 };
            assert!(trees[0].values().len() < cells + 64, "{} values", trees[0].values().len());
        }
    }

    /// Both ranks, each within the error that chose the leaves, away from cells that the depth has cut short.
    #[test]
    fn leaves_are_within_the_error() {
        let gold = Rgb(Conductor { ggx: Ggx { alpha: [0.5; 2] }, eta: [1.0; 3], k: [1e6; 3] });
        for (rank, depth, error) in [(Rank::Three, 7, 0.1), (Rank::Four, 4, 0.5)] {
            let refinement = Refinement { rank, depth, error };
            let trees = measure(&gold, refinement, Block::ReflectionBack, || {}).expect("trees");
            let mean = mean(&gold, Block::ReflectionBack, 3)[0];
            let (mut beyond, mut count) = (0, 0);
            for n in 1..2000 {
                let [a, b, c, d] = crate::halton(n);
                let ([x, y], [u, v]) = (disk(a, b), disk(c, d));
                let (wi, wo) = (placed(0.9 * x, 0.9 * y, 1.0), placed(0.9 * u, 0.9 * v, 1.0));
                let mut expected = [0.0; 3];
                gold.f(wi, &[wo], &mut expected);
                let found = trees[0].eval(wi, wo);
                count += 1;
                // Twice the error, because values between the samples may be further off.
                beyond += usize::from((found - expected[0]).abs() > 2.0 * error * expected[0].max(mean));
            }
            assert!(beyond * 50 < count, "{beyond} of {count}");
        }
    }

    #[test]
    fn the_flux_is_that_of_the_surface() {
        let silver = Conductor { ggx: Ggx { alpha: [0.4; 2] }, eta: [1.0; 3], k: [1e6; 3] };
        let refinement = Refinement { rank: Rank::Three, depth: 6, error: 0.05 };
        let trees = measure(&Rgb(silver), refinement, Block::ReflectionBack, || {}).expect("trees");
        for polar in [0.1_f64, 0.8] {
            let wi = [polar.sin(), 0.0, polar.cos()];
            let (found, expected) = (trees[1].albedo(wi), albedo(&silver, wi, 200)[1]);
            assert!((found - expected).abs() < 0.02, "{found} of {expected} at {polar}");
        }
    }
}
