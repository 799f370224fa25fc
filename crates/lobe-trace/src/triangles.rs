//! The triangles of a leaf, eight side by side.

use bytemuck::{Pod, Zeroable};
use lobe_lane::{Floats, Lanes};
use lobe_memory::Storage;

use crate::bvh::{Binary, Child, WideBvh};
use crate::slab::row_from;
use crate::{Aabb, Mesh};

/// The number of triangles of a block.
pub(crate) const SLOTS: usize = 8;

/// Corners of triangles, one triangle per lane: `[corner][axis]`.
pub(crate) type Corners<L> = [[<L as Lanes>::F; 3]; 3];

/// Eight triangles in five cache lines. Coordinate `axis` of corner `corner` of triangle `slot` is
/// `rows[3 corner + axis][slot]`; the triangles' numbers follow as bits.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(64))]
pub(crate) struct TriangleBlock {
    rows: [[f32; SLOTS]; 10],
}

impl TriangleBlock {
    const NUMBERS: usize = 9;

    fn new(mesh: &Mesh, triangles: impl Iterator<Item = u32>) -> Self {
        let mut rows = [[0.0; SLOTS]; 10];
        for (slot, triangle) in triangles.take(SLOTS).enumerate() {
            for (row, &x) in rows.iter_mut().zip(mesh.corners(triangle as usize).as_flattened()) {
                row[slot] = x;
            }
            rows[Self::NUMBERS][slot] = f32::from_bits(triangle);
        }
        TriangleBlock { rows }
    }

    /// The number of a triangle in its mesh.
    #[inline(always)]
    pub fn number(&self, slot: usize) -> i32 {
        self.rows[Self::NUMBERS][slot & (SLOTS - 1)].to_bits() as i32
    }

    /// A coordinate of a corner of all triangles.
    #[inline(always)]
    fn row(&self, corner: usize, axis: usize) -> &[f32; SLOTS] {
        // Masked, so that the compiler sees that no row is beyond the last, and emits no check.
        &self.rows[3 * corner + (axis & 3)]
    }

    /// The corners of one triangle in all lanes, their coordinates in the order of `axes`.
    #[inline(always)]
    pub fn one<L: Lanes>(&self, lanes: L, slot: usize, axes: [usize; 3]) -> Corners<L> {
        let slot = slot & (SLOTS - 1);
        let mut corners = [[lanes.splat(0.0); 3]; 3];
        let mut at = 0;
        while at < 9 {
            corners[at / 3][at % 3] = lanes.splat(self.row(at / 3, axes[at % 3])[slot]);
            at += 1;
        }
        corners
    }

    /// The corners of the triangles from `slot` on, one triangle per lane; lanes beyond the last are to be ignored.
    #[inline(always)]
    pub fn several<L: Lanes>(&self, lanes: L, slot: usize, axes: [usize; 3]) -> Corners<L> {
        let mut corners = [[lanes.splat(0.0); 3]; 3];
        let mut at = 0;
        while at < 9 {
            corners[at / 3][at % 3] = row_from(lanes, self.row(at / 3, axes[at % 3]), slot);
            at += 1;
        }
        corners
    }

    /// A row of the box of one triangle: lower x, upper x, lower y, ...
    #[inline(always)]
    pub fn side(&self, slot: usize, row: usize) -> f32 {
        let (axis, upper) = (row / 2, row & 1 != 0);
        let mut side = self.row(0, axis)[slot & (SLOTS - 1)];
        let mut corner = 1;
        while corner < 3 {
            let x = self.row(corner, axis)[slot & (SLOTS - 1)];
            // As in lanes, even for two zeros of different sign: the later one wins.
            let first = if upper { side > x } else { side < x };
            side = if first { side } else { x };
            corner += 1;
        }
        side
    }

    /// The lower and the upper corners of the boxes of the triangles from `slot` on, one triangle per lane.
    #[inline(always)]
    pub fn extent<L: Lanes>(&self, lanes: L, slot: usize) -> [[L::F; 3]; 2] {
        let [a, b, c] = self.several(lanes, slot, [0, 1, 2]);
        [
            [a[0].min(b[0]).min(c[0]), a[1].min(b[1]).min(c[1]), a[2].min(b[2]).min(c[2])],
            [a[0].max(b[0]).max(c[0]), a[1].max(b[1]).max(c[1]), a[2].max(b[2]).max(c[2])],
        ]
    }
}

/// A mesh ready to be traced: its tree and its triangles in the order of the leaves.
#[derive(Clone, Debug)]
pub(crate) struct Tree<const W: usize> {
    pub bvh: WideBvh<W>,
    pub blocks: Storage<TriangleBlock>,
}

impl<const W: usize> Tree<W> {
    pub fn build(mesh: &Mesh) -> Self {
        let triangles = mesh.triangles().len();
        let (mut seen, mut boxes) = (Vec::with_capacity(triangles), Vec::with_capacity(triangles));
        for triangle in 0..triangles {
            let corners = mesh.corners(triangle);
            if can_be_hit(corners) {
                seen.push(triangle as u32);
                boxes.push(Aabb::of(corners));
            }
        }
        let binary = Binary::build(&boxes, true);
        let mut leaves = Vec::new();
        let bvh = WideBvh::collapse(&binary, SLOTS, |places| {
            leaves.push(places.clone());
            Child::leaf(leaves.len() - 1, places.len())
        });
        let mut blocks = Storage::zeros(leaves.len());
        for (block, places) in blocks.as_mut_slice().iter_mut().zip(leaves) {
            *block = TriangleBlock::new(mesh, binary.order[places].iter().map(|&place| seen[place as usize]));
        }
        Tree { bvh, blocks }
    }
}

/// `false` for a triangle with two equal corners. Two of its edge functions cancel exactly for every ray, so it need
/// not be in the tree.
fn can_be_hit([a, b, c]: [[f32; 3]; 3]) -> bool {
    a != b && b != c && c != a
}
