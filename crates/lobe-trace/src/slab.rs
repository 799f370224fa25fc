//! Rays against boxes.
//!
//! Every test computes the same expression from the same numbers, which is monotone in the planes of the box. So the
//! interval that a ray spends in a box contains the interval that it spends in any box inside it, exactly and not only
//! up to rounding.

use lobe_lane::{Floats, Lanes, Mask};

use crate::block::{Block, group_rows, ray_rows};
use crate::bvh::Node;

/// The data of rays for box tests, one value per lane.
#[derive(Clone, Copy)]
pub(crate) struct SlabRay<L: Lanes> {
    inverse: [L::F; 3],
    near: [L::F; 3],
    far: [L::F; 3],
}

impl<L: Lanes> SlabRay<L> {
    /// One ray per lane.
    #[inline(always)]
    pub fn group(lanes: L, rays: &Block, at: usize) -> Self {
        SlabRay {
            inverse: group_rows(lanes, &rays.inverse, at),
            near: group_rows(lanes, &rays.near, at),
            far: group_rows(lanes, &rays.far, at),
        }
    }

    /// One ray in all lanes.
    #[inline(always)]
    pub fn single(lanes: L, rays: &Block, ray: usize) -> Self {
        SlabRay {
            inverse: ray_rows(lanes, &rays.inverse, ray),
            near: ray_rows(lanes, &rays.near, ray),
            far: ray_rows(lanes, &rays.far, ray),
        }
    }

    /// The t at which rays enter and leave boxes, given by the three planes that they reach first and the three that
    /// they reach last. A ray misses the box unless its first number is at most its second.
    #[inline(always)]
    pub fn interval(&self, lanes: L, near: [L::F; 3], far: [L::F; 3]) -> [L::F; 2] {
        let enter_x = lanes.mul_add(near[0], self.inverse[0], self.near[0]);
        let enter_y = lanes.mul_add(near[1], self.inverse[1], self.near[1]);
        let enter_z = lanes.mul_add(near[2], self.inverse[2], self.near[2]);
        let leave_x = lanes.mul_add(far[0], self.inverse[0], self.far[0]);
        let leave_y = lanes.mul_add(far[1], self.inverse[1], self.far[1]);
        let leave_z = lanes.mul_add(far[2], self.inverse[2], self.far[2]);
        [enter_x.max(enter_y).max(enter_z), leave_x.min(leave_y).min(leave_z)]
    }

    /// Like [`interval`](SlabRay::interval), for the box between two corners, for rays of any octants.
    #[inline(always)]
    pub fn interval_any(&self, lanes: L, lower: [L::F; 3], upper: [L::F; 3]) -> [L::F; 2] {
        let (mut near, mut far) = (lower, upper);
        let zero = lanes.splat(0.0);
        let mut axis = 0;
        while axis < 3 {
            let backward = self.inverse[axis].lt(zero);
            near[axis] = lanes.select(backward, upper[axis], lower[axis]);
            far[axis] = lanes.select(backward, lower[axis], upper[axis]);
            axis += 1;
        }
        self.interval(lanes, near, far)
    }
}

/// The rows of a node with the planes that rays of an octant reach first and last.
#[derive(Clone, Copy)]
pub(crate) struct Sides {
    pub near: [usize; 3],
    pub far: [usize; 3],
}

impl Sides {
    #[inline(always)]
    pub fn of(octant: usize) -> Self {
        let [x, y, z] = [octant & 1, octant >> 1 & 1, octant >> 2 & 1];
        Sides { near: [x, 2 + y, 4 + z], far: [1 - x, 3 - y, 5 - z] }
    }

    /// The planes of one child in all lanes.
    #[inline(always)]
    pub fn child<L: Lanes, const W: usize>(&self, lanes: L, node: &Node<W>, slot: usize) -> [[L::F; 3]; 2] {
        let slot = slot & (W - 1);
        let mut planes = [[lanes.splat(0.0); 3]; 2];
        let mut axis = 0;
        while axis < 3 {
            planes[0][axis] = lanes.splat(node.bounds(self.near[axis])[slot]);
            planes[1][axis] = lanes.splat(node.bounds(self.far[axis])[slot]);
            axis += 1;
        }
        planes
    }

    /// The planes of the children from `slot` on, one child per lane; zeros beyond the last.
    #[inline(always)]
    pub fn children<L: Lanes, const W: usize>(&self, lanes: L, node: &Node<W>, slot: usize) -> [[L::F; 3]; 2] {
        let mut planes = [[lanes.splat(0.0); 3]; 2];
        let mut axis = 0;
        while axis < 3 {
            planes[0][axis] = row_from(lanes, node.bounds(self.near[axis]), slot);
            planes[1][axis] = row_from(lanes, node.bounds(self.far[axis]), slot);
            axis += 1;
        }
        planes
    }
}

/// As many entries of a row from `slot` on as there are lanes.
#[inline(always)]
pub(crate) fn row_from<L: Lanes, const W: usize>(lanes: L, row: &[f32; W], slot: usize) -> L::F {
    if L::LANES <= W { lanes.load(&row[slot & (W - L::LANES)..]) } else { lanes.load_partial(row) }
}

/// The smallest of all lanes.
#[inline(always)]
pub(crate) fn least_lane<L: Lanes>(lanes: L, x: L::F) -> f32 {
    let mut buffer = [f32::INFINITY; lobe_lane::MAX_LANES];
    lanes.store(&mut buffer, x);
    // By halves: a chain of comparisons would have one step per lane.
    let mut half = L::LANES / 2;
    while half > 0 {
        let mut lane = 0;
        while lane < half {
            let (a, b) = (buffer[lane], buffer[lane + half]);
            buffer[lane] = if a < b { a } else { b };
            lane += 1;
        }
        half /= 2;
    }
    buffer[0]
}

/// The bits of those of the `W` children starting at `slot` whose lanes are set, moved to their slots.
#[inline(always)]
pub(crate) fn child_bits<L: Lanes, const W: usize>(mask: L::M, slot: usize) -> u32 {
    (mask.bits() << slot) & ((1 << W) - 1)
}
