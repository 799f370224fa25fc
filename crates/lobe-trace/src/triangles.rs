//! The triangles of a leaf, four side by side.

use lobe_lane::Lanes;

use crate::bvh::{Binary, Child, WideBvh};
use crate::slab::Sides;
use crate::{Aabb, Mesh};

/// Triangles of a block: more would stand empty in most leaves.
pub(crate) const SLOTS: usize = 4;

/// Corners of triangles, a triangle a lane: `[corner][axis]`.
pub(crate) type Corners<L> = [[<L as Lanes>::F; 3]; 3];

/// Four triangles in four cache lines, the last of which only hits and tests of whole packets touch. Row `row` has the
/// numbers `row SLOTS ..` of a triangle each: coordinate `axis` of corner `corner` is row `3 corner + axis`, then come
/// the triangles' own numbers as bits, and their boxes in the order of a node's rows.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct TriangleBlock {
    floats: [f32; 16 * SLOTS],
}

impl TriangleBlock {
    const NUMBERS: usize = 9;
    const BOXES: usize = 10;

    fn new(mesh: &Mesh, triangles: &[u32]) -> Self {
        // NaN in empty slots: no comparison holds for them.
        let mut floats = [f32::NAN; 16 * SLOTS];
        for slot in 0..SLOTS {
            let number = triangles.get(slot).map_or(-1, |&triangle| triangle as i32);
            floats[Self::NUMBERS * SLOTS + slot] = f32::from_bits(number as u32);
        }
        for (slot, &triangle) in triangles.iter().enumerate() {
            let corners = mesh.corners(triangle as usize);
            for (row, &x) in corners.as_flattened().iter().enumerate() {
                floats[row * SLOTS + slot] = x;
            }
            for (row, bound) in Aabb::of(corners).rows().into_iter().enumerate() {
                floats[(Self::BOXES + row) * SLOTS + slot] = bound;
            }
        }
        TriangleBlock { floats }
    }

    #[inline(always)]
    fn at(&self, row: usize, slot: usize) -> f32 {
        self.floats[(row * SLOTS + slot) & (16 * SLOTS - 1)]
    }

    /// The number of a triangle in its mesh; negative where the slot is empty.
    #[inline(always)]
    pub fn number(&self, slot: usize) -> i32 {
        self.at(Self::NUMBERS, slot).to_bits() as i32
    }

    /// The corners of one triangle in all lanes, their coordinates in the order of `axes`.
    #[inline(always)]
    pub fn one<L: Lanes>(&self, lanes: L, slot: usize, axes: [usize; 3]) -> Corners<L> {
        let mut corners = [[lanes.splat(0.0); 3]; 3];
        let mut at = 0;
        while at < 9 {
            corners[at / 3][at % 3] = lanes.splat(self.at(at / 3 * 3 + axes[at % 3], slot));
            at += 1;
        }
        corners
    }

    /// The corners of the triangles from `slot` on, a triangle a lane; what is beyond the last is to be ignored.
    #[inline(always)]
    pub fn several<L: Lanes>(&self, lanes: L, slot: usize, axes: [usize; 3]) -> Corners<L> {
        let mut corners = [[lanes.splat(0.0); 3]; 3];
        let mut at = 0;
        while at < 9 {
            // The last corner stands in row 8: 16 floats follow it.
            let first = (at / 3 * 3 + axes[at % 3]) * SLOTS + slot;
            corners[at / 3][at % 3] = lanes.load(&self.floats[first..]);
            at += 1;
        }
        corners
    }

    /// The planes of the box of one triangle that rays meet first and last, in all lanes.
    #[inline(always)]
    pub fn one_box<L: Lanes>(&self, lanes: L, slot: usize, sides: &Sides) -> [[L::F; 3]; 2] {
        let mut planes = [[lanes.splat(0.0); 3]; 2];
        let mut axis = 0;
        while axis < 3 {
            planes[0][axis] = lanes.splat(self.at(Self::BOXES + sides.near[axis], slot));
            planes[1][axis] = lanes.splat(self.at(Self::BOXES + sides.far[axis], slot));
            axis += 1;
        }
        planes
    }

    /// The same of the triangles from `slot` on, a triangle a lane.
    #[inline(always)]
    pub fn boxes<L: Lanes>(&self, lanes: L, slot: usize, sides: &Sides) -> [[L::F; 3]; 2] {
        let mut planes = [[lanes.splat(0.0); 3]; 2];
        let mut axis = 0;
        while axis < 3 {
            planes[0][axis] = self.row(lanes, Self::BOXES + sides.near[axis], slot);
            planes[1][axis] = self.row(lanes, Self::BOXES + sides.far[axis], slot);
            axis += 1;
        }
        planes
    }

    /// What stands in a row from `slot` on, zeros beyond its end.
    #[inline(always)]
    fn row<L: Lanes>(&self, lanes: L, row: usize, slot: usize) -> L::F {
        let first = (row * SLOTS + slot) & (16 * SLOTS - 1);
        if L::LANES < SLOTS {
            return lanes.load(&self.floats[first..]);
        }
        let first = first & (15 * SLOTS);
        if L::LANES == SLOTS {
            return lanes.load(&self.floats[first..]);
        }
        lanes.first_four([self.floats[first], self.floats[first + 1], self.floats[first + 2], self.floats[first + 3]])
    }
}

/// A mesh ready to be traced: its tree and its triangles in the order of the leaves.
#[derive(Clone, Debug)]
pub(crate) struct Tree<const W: usize> {
    pub bvh: WideBvh<W>,
    pub blocks: Vec<TriangleBlock>,
}

impl<const W: usize> Tree<W> {
    /// Up to two blocks a leaf: the cost of a tree changes little from 2 to 16 triangles.
    const LEAF: usize = 2 * SLOTS;

    pub fn build(mesh: &Mesh) -> Self {
        let seen: Vec<u32> =
            (0..mesh.triangles().len() as u32).filter(|&triangle| can_be_hit(mesh, triangle)).collect();
        let boxes: Vec<Aabb> = seen.iter().map(|&triangle| Aabb::of(mesh.corners(triangle as usize))).collect();
        let binary = Binary::build(&boxes, Self::LEAF);
        let mut blocks = Vec::with_capacity(seen.len() / 2);
        let bvh = WideBvh::collapse(&binary, |places| {
            let first = blocks.len();
            for run in places.chunks(SLOTS) {
                let mut triangles = [0; SLOTS];
                run.iter().zip(&mut triangles).for_each(|(&place, triangle)| *triangle = seen[place as usize]);
                blocks.push(TriangleBlock::new(mesh, &triangles[..run.len()]));
            }
            Child::leaf(first, blocks.len() - first)
        });
        Tree { bvh, blocks }
    }
}

/// `false` for a triangle with two corners in one place. Two of its edge functions cancel to the bit whatever the ray,
/// so it need not stand in the tree.
fn can_be_hit(mesh: &Mesh, triangle: u32) -> bool {
    let [a, b, c] = mesh.corners(triangle as usize);
    a != b && b != c && c != a
}
