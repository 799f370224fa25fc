//! Several rays tested against boxes as one.

use lobe_lane::{Floats, Lanes, Mask};

use crate::block::{Block, first_ray};
use crate::bvh::Node;
use crate::slab::{Sides, child_bits, least_lane};

/// A ray with two origins and two inverses that represents rays of one octant which begin at `t >= 0`: `(plane -
/// origin) * inverse` is `plane * slow + near` for a plane that rays reach first, `plane * fast + far` for one that
/// they reach last.
///
/// A plane ahead of all origins is reached no sooner than by a ray from the nearest of them with the inverse of
/// smallest magnitude, and no later than by one from the farthest with the largest. A plane behind some origin gives a
/// number below zero for the near planes, which has no effect if no ray begins below zero, and correctly ends the rays
/// for the far planes.
#[derive(Clone, Copy)]
pub(crate) struct Edges<L: Lanes> {
    pub slow: L::F,
    pub near: L::F,
    pub fast: L::F,
    pub far: L::F,
}

impl<L: Lanes> Edges<L> {
    /// Along one axis, from the least and the greatest origins, and the inverses of the edges that begin there. The
    /// rays' `pad` is applied twice, because this test rounds differently from theirs.
    #[inline(always)]
    pub fn new(backward: bool, [low, high]: [L::F; 2], [lower, upper]: [L::F; 2], pad: L::F) -> Self {
        let wide = pad + pad;
        let [ahead, behind, slow, fast] =
            if backward { [low - wide, high + wide, lower, upper] } else { [high + wide, low - wide, upper, lower] };
        Edges { slow, near: -(ahead * slow), fast, far: -(behind * fast) }
    }
}

/// The hull of a group, in all lanes.
#[derive(Clone, Copy)]
pub(crate) struct Hull<L: Lanes> {
    edges: [Edges<L>; 3],
    /// No ray begins before it, and none searches beyond it.
    t_min: L::F,
    end: L::F,
}

impl<L: Lanes> Hull<L> {
    /// Around the rays of `live`; `None` if a ray begins before zero, or if there is only one lane.
    #[inline(always)]
    pub fn around(lanes: L, rays: &Block, at: usize, octant: usize, live: L::M) -> Option<Self> {
        let at = first_ray::<L>(at);
        let t_min = lanes.load(&rays.t_min[at..]);
        if L::LANES == 1 || (t_min.lt(lanes.splat(0.0)) & live).any() {
            return None;
        }
        let [t_min, _] = ends(lanes, t_min, live);
        let [_, pad] = ends(lanes, lanes.load(&rays.pad[at..]), live);
        let zero = lanes.splat(0.0);
        let mut edges = [Edges { slow: zero, near: zero, fast: zero, far: zero }; 3];
        let mut axis = 0;
        while axis < 3 {
            let origins = ends(lanes, lanes.load(&rays.origin[axis][at..]), live);
            let [least, greatest] = ends(lanes, lanes.load(&rays.inverse[axis][at..]), live);
            edges[axis] = Edges::new(octant >> axis & 1 != 0, origins, [greatest, least], pad);
            axis += 1;
        }
        Some(Hull { edges, t_min, end: lanes.splat(f32::INFINITY) })
    }

    /// Updates the ends of the rays of `live`.
    #[inline(always)]
    pub fn shorten(&mut self, lanes: L, ends_at: L::F, live: L::M) {
        let [_, end] = ends(lanes, ends_at, live);
        self.end = end;
    }

    /// One box per lane: the t before which no ray is inside the box, and the t after which none is inside or still
    /// searching.
    #[inline(always)]
    pub fn interval(&self, lanes: L, near: [L::F; 3], far: [L::F; 3]) -> [L::F; 2] {
        let (mut enter, mut leave) = (self.t_min, self.end);
        let mut axis = 0;
        while axis < 3 {
            let edges = &self.edges[axis];
            enter = enter.max(lanes.mul_add(near[axis], edges.slow, edges.near));
            leave = leave.min(lanes.mul_add(far[axis], edges.fast, edges.far));
            axis += 1;
        }
        [enter, leave]
    }

    /// The bits of the children of a node that any of the rays may hit.
    #[inline(always)]
    pub fn children<const W: usize>(&self, lanes: L, node: &Node<W>, sides: &Sides) -> u32 {
        let mut bits = 0;
        let mut slot = 0;
        while slot < W {
            let [near, far] = sides.children(lanes, node, slot);
            let [enter, leave] = self.interval(lanes, near, far);
            bits |= child_bits::<L, W>(enter.le(leave), slot);
            slot += L::LANES;
        }
        bits
    }
}

/// The least and the greatest of the lanes of `live`, in all lanes.
#[inline(always)]
fn ends<L: Lanes>(lanes: L, x: L::F, live: L::M) -> [L::F; 2] {
    let low = lanes.select(live, x, lanes.splat(f32::INFINITY));
    let high = lanes.select(live, -x, lanes.splat(f32::INFINITY));
    [lanes.splat(least_lane(lanes, low)), lanes.splat(-least_lane(lanes, high))]
}
