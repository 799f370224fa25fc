//! What stands in the leaves of a tree: triangles, or instances of trees of triangles.

use lobe_lane::{Floats, Ints, Lanes, Mask};

use crate::block::{Block, Found, RAYS, first_ray, group_bits, mask_of};
use crate::bvh::Child;
use crate::slab::SlabRay;
use crate::triangles::{Corners, SLOTS, TriangleBlock};
use crate::woop::{ShearRay, axes_of};

/// What a walk calls when it comes to a leaf. Hits go to `found` if they are nearer than what stands there.
pub(crate) trait Leaves {
    /// Several rays have met the leaf: those of `live`, a bit each.
    fn packet<L: Lanes>(&mut self, lanes: L, leaf: Child, rays: &Block, live: u64, found: &mut Found);
    /// One ray has met the leaf.
    fn single<L: Lanes>(&mut self, lanes: L, leaf: Child, rays: &Block, ray: usize, found: &mut Found);
}

/// Triangles of one instance.
#[derive(Clone, Copy)]
pub(crate) struct Triangles<'a> {
    pub blocks: &'a [TriangleBlock],
    pub instance: i32,
    /// Any hit is enough.
    pub any: bool,
}

impl Triangles<'_> {
    /// Tests the triangles of a leaf against rays of a group that have one major axis.
    #[inline(always)]
    fn group<L: Lanes>(&self, lanes: L, leaf: Child, rays: &Block, at: usize, bits: u32, found: &mut Found) {
        let at = first_ray::<L>(at);
        let axes = axes_of(rays.major[(at + bits.trailing_zeros() as usize) & (RAYS - 1)]);
        let live = mask_of(lanes, bits);
        let ray = ShearRay::group(lanes, rays, at);
        let blocks = &self.blocks[leaf.first()..leaf.first() + leaf.blocks()];
        let mut index = 0;
        while index < blocks.len() {
            let block = &blocks[index];
            let mut slot = 0;
            while slot < SLOTS {
                let number = block.number(slot);
                if number < 0 {
                    break;
                }
                let candidates = ray.test(lanes, block.one(lanes, slot, axes), live);
                if candidates.mask.any() {
                    let [lower, upper] = extent::<L>(block.one(lanes, slot, [0, 1, 2]));
                    let own = SlabRay::group(lanes, rays, at).interval_any(lanes, lower, upper);
                    let instance = [lanes.load(&rays.enter[at..]), lanes.load(&rays.leave[at..])];
                    let (t, fits) = limited::<L>(candidates.t, own, instance);
                    let best = lanes.load(&found.t[at..]);
                    let number = lanes.splat_int(number);
                    let other = lanes.splat_int(self.instance);
                    let old_number = lanes.load_int(&found.primitive[at..]);
                    let old_other = lanes.load_int(&found.instance[at..]);
                    // Of two hits at one place the smaller numbers win, whoever comes first.
                    let first = number.lt(old_number) | (number.eq(old_number) & other.lt(old_other));
                    let nearer = t.lt(best) | (t.eq(best) & first);
                    let hit = candidates.mask & fits & t.ge(lanes.load(&rays.t_min[at..])) & nearer;
                    if hit.any() {
                        let t = if self.any { lanes.splat(f32::NEG_INFINITY) } else { t };
                        let (u, v) = (lanes.load(&found.u[at..]), lanes.load(&found.v[at..]));
                        lanes.store(&mut found.t[at..], lanes.select(hit, t, best));
                        lanes.store(&mut found.u[at..], lanes.select(hit, candidates.u, u));
                        lanes.store(&mut found.v[at..], lanes.select(hit, candidates.v, v));
                        lanes.store_int(&mut found.primitive[at..], lanes.select_int(hit, number, old_number));
                        lanes.store_int(&mut found.instance[at..], lanes.select_int(hit, other, old_other));
                    }
                }
                slot += 1;
            }
            index += 1;
        }
    }
}

/// The lower and the upper corner of the triangles' boxes.
#[inline(always)]
fn extent<L: Lanes>([a, b, c]: Corners<L>) -> [[L::F; 3]; 2] {
    [
        [a[0].min(b[0]).min(c[0]), a[1].min(b[1]).min(c[1]), a[2].min(b[2]).min(c[2])],
        [a[0].max(b[0]).max(c[0]), a[1].max(b[1]).max(c[1]), a[2].max(b[2]).max(c[2])],
    ]
}

/// Moves t into where the ray is inside the boxes of the triangle and of the instance, and says whether that can be. So
/// every box around the triangle holds the hit as the walks see it, and the answer does not depend on the order in
/// which boxes are opened.
#[inline(always)]
fn limited<L: Lanes>(t: L::F, own: [L::F; 2], instance: [L::F; 2]) -> (L::F, L::M) {
    let t = t.max(instance[0]).min(instance[1]).max(own[0]).min(own[1]);
    (t, own[0].le(own[1]) & t.ge(instance[0]) & t.le(instance[1]))
}

impl Leaves for Triangles<'_> {
    #[inline(always)]
    fn packet<L: Lanes>(&mut self, lanes: L, leaf: Child, rays: &Block, live: u64, found: &mut Found) {
        let mut live = live;
        while live != 0 {
            let at = first_ray::<L>(live.trailing_zeros() as usize);
            let mut bits = group_bits::<L>(live, at);
            live ^= (bits as u64) << at;
            let majors = lanes.load_int(&rays.major[at..]);
            while bits != 0 {
                // Once, but where the group looks along a diagonal.
                let major = rays.major[(at + bits.trailing_zeros() as usize) & (RAYS - 1)];
                let same = majors.eq(lanes.splat_int(major)).bits() & bits;
                self.group(lanes, leaf, rays, at, same, found);
                bits &= !same;
            }
        }
    }

    #[inline(always)]
    fn single<L: Lanes>(&mut self, lanes: L, leaf: Child, rays: &Block, index: usize, found: &mut Found) {
        let index = index & (RAYS - 1);
        let ray = ShearRay::single(lanes, rays, index);
        let axes = axes_of(rays.major[index]);
        let step = if L::LANES < SLOTS { L::LANES } else { SLOTS };
        let all = lanes.first_n(SLOTS);
        let blocks = &self.blocks[leaf.first()..leaf.first() + leaf.blocks()];
        let mut at = 0;
        while at < blocks.len() {
            let block = &blocks[at];
            let mut slot = 0;
            // Empty slots come last.
            while slot < SLOTS && block.number(slot) >= 0 {
                let candidates = ray.test(lanes, block.several(lanes, slot, axes), all);
                if candidates.mask.any() {
                    let [lower, upper] = extent::<L>(block.several(lanes, slot, [0, 1, 2]));
                    let own = SlabRay::single(lanes, rays, index).interval_any(lanes, lower, upper);
                    let instance = [lanes.splat(rays.enter[index]), lanes.splat(rays.leave[index])];
                    let (t, fits) = limited::<L>(candidates.t, own, instance);
                    let within = t.ge(lanes.splat(rays.t_min[index])) & t.le(lanes.splat(found.t[index]));
                    let mut bits = (candidates.mask & fits & within).bits();
                    while bits != 0 {
                        let lane = bits.trailing_zeros() as usize;
                        bits &= bits - 1;
                        let (t, number) = (lanes.extract(t, lane), block.number(slot + lane));
                        let best = found.t[index];
                        let old = (found.primitive[index], found.instance[index]);
                        if t < best || (t == best && (number, self.instance) < old) {
                            found.t[index] = if self.any { f32::NEG_INFINITY } else { t };
                            found.u[index] = lanes.extract(candidates.u, lane);
                            found.v[index] = lanes.extract(candidates.v, lane);
                            found.primitive[index] = number;
                            found.instance[index] = self.instance;
                        }
                    }
                }
                slot += step;
            }
            at += 1;
        }
    }
}
