//! The descent of a [`TensorTree`] in SIMD lanes.

use std::f32::consts::FRAC_1_PI;

use lobe_lane::{Floats, Ints, Lanes, Mask};

use super::tree::{INSET, Node, Rank, TensorTree};
use crate::invalid::Invalid;
use crate::passes::block::Column;
use crate::passes::unit::POLE;

/// The nodes of a tree, laid out so that a branch and a leaf are read in the same way: as a grid of nodes or values
/// whose first dimension varies slowest.
#[derive(Clone, Debug)]
pub(crate) struct Walk {
    /// The bits of the position of the first node or value of the grid, and its number of cells along each dimension,
    /// negated if they are nodes.
    nodes: Vec<[f32; 2]>,
}

impl Walk {
    /// # Errors
    /// [`Invalid`] if the tree has more nodes or values than bit patterns of positive floats.
    pub(crate) fn new(tree: &TensorTree) -> Result<Self, Invalid> {
        // No pattern may be a NaN, because a processor need not preserve the bits of a NaN.
        let most = f32::INFINITY.to_bits() as usize;
        if tree.nodes().len().max(tree.values().len()) >= most {
            let found = format!("{} nodes and {} values", tree.nodes().len(), tree.values().len());
            return Err(Invalid::new("ScatteringData", found, format!("less than {most} of each")));
        }
        let dimensions = tree.rank().dimensions();
        let mut place: Vec<usize> = (0..tree.nodes().len()).collect();
        for node in tree.nodes() {
            if let Node::Branch(first) = *node {
                // In the file, dimension 0 varies fastest among children, and slowest among values.
                for child in 0..1_usize << dimensions {
                    let reversed = child.reverse_bits() >> (usize::BITS as usize - dimensions);
                    place[first as usize + child] = first as usize + reversed;
                }
            }
        }
        let mut nodes = vec![[0.0; 2]; place.len()];
        for (node, place) in tree.nodes().iter().zip(place) {
            nodes[place] = match *node {
                Node::Branch(first) => [f32::from_bits(first), -2.0],
                Node::Leaf { first, level } => [f32::from_bits(first), (1_u32 << level) as f32],
            };
        }
        Ok(Walk { nodes })
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }

    /// The values of `tree`, from which this was built, at the positions of queries `0..n`.
    #[inline(always)]
    pub(crate) fn run<L: Lanes, const DIMENSIONS: usize>(
        &self,
        lanes: L,
        n: usize,
        tree: &TensorTree,
        positions: &[Column; 4],
        out: &mut Column,
    ) {
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let mut query = 0;
        while query < n {
            let mut position = [zero; DIMENSIONS];
            let mut dimension = 0;
            while dimension < DIMENSIONS {
                position[dimension] = positions[dimension].load(lanes, query);
                dimension += 1;
            }
            let (mut node, mut found) = (lanes.splat_int(0), lanes.splat_int(0));
            let mut walking = lanes.first_n(L::LANES);
            loop {
                let [first, cells] = lanes.gather_pair(&self.nodes, node);
                let size = cells.abs();
                let (count, last) = (size.to_int(), size - one);
                let mut cell = lanes.splat_int(0);
                let mut dimension = 0;
                while dimension < DIMENSIONS {
                    let x = position[dimension] * size;
                    let whole = x.min(last).to_int();
                    cell = cell * count + whole;
                    position[dimension] = x - whole.to_float();
                    dimension += 1;
                }
                node = first.bits() + cell;
                // Lanes that have arrived continue among arbitrary nodes until all have arrived.
                found = lanes.select_int(walking, node, found);
                walking = walking & cells.lt(zero);
                if !walking.any() {
                    break;
                }
            }
            out.store(lanes, query, lanes.gather(tree.values(), found));
            query += L::LANES;
        }
    }
}

/// The positions in the unit cube of queries `0..n`, for light from `wi` to `wo`, unit vectors.
#[inline(always)]
pub(crate) fn positions<L: Lanes>(
    lanes: L,
    n: usize,
    rank: Rank,
    wi: &[Column; 3],
    wo: &[Column; 3],
    out: &mut [Column; 4],
) {
    let [a, b, c, d] = out;
    let mut query = 0;
    while query < n {
        let (x, y) = (-wi[0].load(lanes, query), -wi[1].load(lanes, query));
        let (u, v) = (wo[0].load(lanes, query), wo[1].load(lanes, query));
        match rank {
            Rank::Three => {
                let radius = lanes.mul_add(x, x, y * y).sqrt();
                let pole = lanes.splat(POLE);
                let tilted = pole.lt(radius);
                let scale = lanes.splat(1.0) / radius.max(pole);
                let (cos, sin) = (lanes.select(tilted, x * scale, lanes.splat(1.0)), (y * scale).masked(tilted));
                let (u, v) = (lanes.mul_add(cos, u, sin * v), lanes.mul_add(cos, v, -(sin * u)));
                let inner = lanes.mul_add(radius, lanes.splat(-0.5), lanes.splat((0.5 - INSET) as f32));
                let [second, third] = square(lanes, u, v);
                a.store(lanes, query, inner.max(lanes.splat(0.0)));
                b.store(lanes, query, second);
                c.store(lanes, query, third);
            }
            Rank::Four => {
                let ([first, second], [third, fourth]) = (square(lanes, x, y), square(lanes, u, v));
                a.store(lanes, query, first);
                b.store(lanes, query, second);
                c.store(lanes, query, third);
                d.store(lanes, query, fourth);
            }
        }
        query += L::LANES;
    }
}

/// Shirley and Chiu's concentric map of the unit disk onto the unit square, as [`super::square`].
///
/// All four wedges are treated as one: the coordinate along the nearer axis is the radius, and that along the other
/// axis is the radius times the angle from the nearer axis, in units of an eighth of a turn.
#[inline(always)]
fn square<L: Lanes>(lanes: L, x: L::F, y: L::F) -> [L::F; 2] {
    let (half, one) = (lanes.splat(0.5), lanes.splat(1.0));
    let length = lanes.mul_add(x, x, y * y).sqrt();
    let radius = length.min(one);
    let wide = y.abs().le(x.abs());
    let (along, across) = (lanes.select(wide, x, y), lanes.select(wide, y, x));
    let span = lanes.splat(f32::MIN_POSITIVE).max(length + along.abs());
    let angle = lobe_math::double_atan(lanes, across / span);
    let (along, across) = (radius.mul_sign(along), radius * (angle * lanes.splat(4.0 * FRAC_1_PI)));
    let (a, b) = (lanes.select(wide, along, across), lanes.select(wide, across, along));
    [lanes.mul_add(a, half, half), lanes.mul_add(b, half, half)]
}
