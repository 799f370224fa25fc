//! What stands in the leaves of a tree: triangles, or instances of trees of triangles.

use lobe_lane::{Floats, Ints, Lanes, MAX_LANES, Mask};

use crate::block::{Block, Found, RAYS, first_ray, group_bits, mask_of};
use crate::bundles::Bundles;
use crate::bvh::Child;
use crate::slab::{Sides, SlabRay};
use crate::triangles::{SLOTS, TriangleBlock};
use crate::woop::{ShearRay, axes_of};

/// What a walk calls when it comes to a leaf. Hits go to `found` if they are nearer than what stands there.
pub(crate) trait Leaves {
    /// What is worked out once for one ray.
    type Ready<L: Lanes>: Copy;

    /// See [`Ready`](Leaves::Ready).
    fn ready<L: Lanes>(&self, lanes: L, rays: &Block, ray: usize) -> Self::Ready<L>;

    /// Any hit is enough.
    fn any(&self) -> bool;

    /// Has the caches bring a leaf in that may be met.
    fn prefetch<L: Lanes>(&self, lanes: L, leaf: Child);

    /// Several rays of one octant have met the leaf: those of `live`, a bit each. What their bundles, where they have
    /// some, do not meet is left out. Returns which rays may have been hit.
    fn packet<L: Lanes>(
        &mut self,
        lanes: L,
        leaf: Child,
        rays: &Block,
        live: u64,
        found: &mut Found,
        bundles: Option<&Bundles>,
    ) -> u64;

    /// One ray has met the leaf.
    fn single<L: Lanes>(
        &mut self,
        lanes: L,
        leaf: Child,
        rays: &Block,
        ray: usize,
        ready: Self::Ready<L>,
        found: &mut Found,
    );
}

/// Triangles of one instance.
pub(crate) struct Triangles<'a> {
    blocks: &'a [TriangleBlock],
    instance: i32,
    /// Rays were carried into the instance's space: hits are kept inside its box.
    carried: bool,
    /// Any hit is enough.
    any: bool,
    /// The boxes of the triangles of the block that was tested last, in the order of a node's rows.
    boxes: [[f32; MAX_LANES]; 6],
}

/// How few rays of a leaf are traced one by one against all triangles of a block.
const FEW: u32 = 10;

/// The bits of all triangles of a block.
const ALL: u32 = (1 << SLOTS) - 1;

impl<'a> Triangles<'a> {
    pub fn new(blocks: &'a [TriangleBlock], instance: usize, carried: bool, any: bool) -> Self {
        Triangles { blocks, instance: instance as i32, carried, any, boxes: [[0.0; MAX_LANES]; 6] }
    }
}

impl Triangles<'_> {
    /// Works out the boxes of a block's triangles.
    #[inline(always)]
    fn fit<L: Lanes>(&mut self, lanes: L, block: &TriangleBlock) {
        let mut slot = 0;
        while slot < SLOTS {
            let [lower, upper] = block.extent(lanes, slot);
            let mut axis = 0;
            while axis < 3 {
                lanes.store(&mut self.boxes[2 * axis][slot..], lower[axis]);
                lanes.store(&mut self.boxes[2 * axis + 1][slot..], upper[axis]);
                axis += 1;
            }
            slot += L::LANES;
        }
    }

    /// The bits of the triangles, their boxes at hand, that bundles of rays meet.
    #[inline(always)]
    fn met<L: Lanes>(&self, lanes: L, sides: &Sides, bundles: &Bundles, rays: u64) -> u32 {
        let mut bits = 0;
        let mut slot = 0;
        while slot < SLOTS {
            let [mut near, mut far] = [[lanes.splat(0.0); 3]; 2];
            let mut axis = 0;
            while axis < 3 {
                near[axis] = lanes.load(&self.boxes[sides.near[axis]][slot..]);
                far[axis] = lanes.load(&self.boxes[sides.far[axis]][slot..]);
                axis += 1;
            }
            let mut bundle = Bundles::of(rays.trailing_zeros() as usize);
            let last = Bundles::of(63 - rays.leading_zeros() as usize);
            while bundle <= last {
                let [enter, leave] = bundles.interval(lanes, bundle, near, far);
                bits |= enter.le(leave).bits() << slot;
                bundle += 1;
            }
            slot += L::LANES;
        }
        bits & ALL
    }

    /// Tests triangles of a block, those of `slots`, whose boxes are at hand, against rays of a group that have one octant and one major axis.
    #[inline(always)]
    fn group<L: Lanes>(
        &mut self,
        lanes: L,
        (block, slots): (&TriangleBlock, u32),
        (rays, at, bits): (&Block, usize, u32),
        sides: &Sides,
        found: &mut Found,
    ) -> u32 {
        let at = first_ray::<L>(at);
        let axes = axes_of(rays.major[(at + bits.trailing_zeros() as usize) & (RAYS - 1)]);
        let live = mask_of(lanes, bits);
        let ray = ShearRay::group(lanes, rays, at);
        let mut slots = slots;
        let mut some = 0;
        while slots != 0 {
            let slot = slots.trailing_zeros() as usize;
            slots &= slots - 1;
            let candidates = ray.test(lanes, block.one(lanes, slot, axes), live);
            if !candidates.mask.any() {
                continue;
            }
            let [mut near, mut far] = [[lanes.splat(0.0); 3]; 2];
            let mut axis = 0;
            while axis < 3 {
                near[axis] = lanes.splat(self.boxes[sides.near[axis]][slot & (SLOTS - 1)]);
                far[axis] = lanes.splat(self.boxes[sides.far[axis]][slot & (SLOTS - 1)]);
                axis += 1;
            }
            let own = SlabRay::group(lanes, rays, at).interval(lanes, near, far);
            let (mut t, mut hit) = (candidates.t, candidates.mask);
            // t is moved into where the ray is inside the boxes of the triangle and of the instance. So every box around
            // the triangle holds the hit as the walks see it, and no answer depends on the order in which boxes are opened.
            if self.carried {
                let instance = [lanes.load(&rays.enter[at..]), lanes.load(&rays.leave[at..])];
                t = t.max(instance[0]).min(instance[1]).max(own[0]).min(own[1]);
                hit = hit & t.ge(instance[0]) & t.le(instance[1]);
            } else {
                t = t.max(own[0]).min(own[1]);
            }
            let best = lanes.load(&found.t[at..]);
            hit = hit & own[0].le(own[1]) & t.ge(lanes.load(&rays.t_min[at..])) & t.le(best);
            if !hit.any() {
                continue;
            }
            let number = lanes.splat_int(block.number(slot));
            let other = lanes.splat_int(self.instance);
            let old_number = lanes.load_int(&found.primitive[at..]);
            let old_other = lanes.load_int(&found.instance[at..]);
            // Of two hits at one place the smaller numbers win, whoever comes first.
            let first = number.lt(old_number) | (number.eq(old_number) & other.lt(old_other));
            let hit = hit & (t.lt(best) | first);
            some |= hit.bits();
            let t = if self.any { lanes.splat(f32::NEG_INFINITY) } else { t };
            let (u, v) = (lanes.load_int(&found.u[at..]), lanes.load_int(&found.v[at..]));
            lanes.store(&mut found.t[at..], lanes.select(hit, t, best));
            lanes.store_int(&mut found.u[at..], lanes.select_int(hit, candidates.u.bits(), u));
            lanes.store_int(&mut found.v[at..], lanes.select_int(hit, candidates.v.bits(), v));
            lanes.store_int(&mut found.primitive[at..], lanes.select_int(hit, number, old_number));
            lanes.store_int(&mut found.instance[at..], lanes.select_int(hit, other, old_other));
        }
        some
    }

    /// Tests all triangles of a block against one ray.
    #[inline(always)]
    fn one<L: Lanes>(
        &self,
        lanes: L,
        block: &TriangleBlock,
        (rays, index): (&Block, usize),
        (ray, axes): OneRay<L>,
        found: &mut Found,
    ) -> bool {
        let mut any = false;
        let all = lanes.first_n(SLOTS);
        let mut slot = 0;
        while slot < SLOTS {
            let candidates = ray.test(lanes, block.several(lanes, slot, axes), all);
            if candidates.mask.any() {
                let [lower, upper] = block.extent(lanes, slot);
                let own = SlabRay::single(lanes, rays, index).interval_any(lanes, lower, upper);
                let (mut t, mut hit) = (candidates.t, candidates.mask);
                if self.carried {
                    let instance = [lanes.splat(rays.enter[index]), lanes.splat(rays.leave[index])];
                    t = t.max(instance[0]).min(instance[1]).max(own[0]).min(own[1]);
                    hit = hit & t.ge(instance[0]) & t.le(instance[1]);
                } else {
                    t = t.max(own[0]).min(own[1]);
                }
                let within = t.ge(lanes.splat(rays.t_min[index])) & t.le(lanes.splat(found.t[index]));
                let mut bits = (hit & own[0].le(own[1]) & within).bits();
                while bits != 0 {
                    let lane = bits.trailing_zeros() as usize;
                    bits &= bits - 1;
                    let (t, number) = (lanes.extract(t, lane), block.number(slot + lane));
                    let best = found.t[index];
                    let old = (found.primitive[index], found.instance[index]);
                    if t < best || (t == best && (number, self.instance) < old) {
                        any = true;
                        found.t[index] = if self.any { f32::NEG_INFINITY } else { t };
                        found.u[index] = lanes.extract_int(candidates.u.bits(), lane);
                        found.v[index] = lanes.extract_int(candidates.v.bits(), lane);
                        found.primitive[index] = number;
                        found.instance[index] = self.instance;
                    }
                }
            }
            slot += if L::LANES < SLOTS { L::LANES } else { SLOTS };
        }
        any
    }
}

/// What triangle tests know of one ray: the ray in all lanes, and the order of its axes.
type OneRay<L> = (ShearRay<L>, [usize; 3]);

impl Leaves for Triangles<'_> {
    type Ready<L: Lanes> = OneRay<L>;

    #[inline(always)]
    fn ready<L: Lanes>(&self, lanes: L, rays: &Block, ray: usize) -> OneRay<L> {
        (ShearRay::single(lanes, rays, ray), axes_of(rays.major[ray & (RAYS - 1)]))
    }

    #[inline(always)]
    fn any(&self) -> bool {
        self.any
    }

    #[inline(always)]
    fn prefetch<L: Lanes>(&self, lanes: L, leaf: Child) {
        if let Some(block) = self.blocks.get(leaf.first()) {
            block.prefetch(lanes);
        }
    }

    #[inline(always)]
    fn packet<L: Lanes>(
        &mut self,
        lanes: L,
        leaf: Child,
        rays: &Block,
        live: u64,
        found: &mut Found,
        bundles: Option<&Bundles>,
    ) -> u64 {
        let mut hit = 0;
        let sides = Sides::of(rays.octant(live.trailing_zeros() as usize));
        let blocks = &self.blocks[leaf.first()..leaf.first() + leaf.blocks()];
        let mut index = 0;
        while index < blocks.len() {
            let block = &blocks[index];
            index += 1;
            let mut live = live;
            if L::LANES >= SLOTS && live.count_ones() <= FEW {
                while live != 0 {
                    let ray = live.trailing_zeros() as usize & (RAYS - 1);
                    live &= live - 1;
                    let any = self.one(lanes, block, (rays, ray), self.ready(lanes, rays, ray), found);
                    hit |= u64::from(any) << ray;
                }
                continue;
            }
            self.fit(lanes, block);
            while live != 0 {
                let at = first_ray::<L>(live.trailing_zeros() as usize);
                let mut bits = group_bits::<L>(live, at);
                live ^= (bits as u64) << at;
                let slots = match bundles {
                    Some(bundles) => self.met(lanes, &sides, bundles, (bits as u64) << at),
                    None => ALL,
                };
                if slots == 0 {
                    continue;
                }
                // A ray at a time takes all triangles at once: better where rays are fewer.
                if L::LANES >= SLOTS && bits.count_ones() < slots.count_ones() {
                    while bits != 0 {
                        let ray = (at + bits.trailing_zeros() as usize) & (RAYS - 1);
                        bits &= bits - 1;
                        let any = self.one(lanes, block, (rays, ray), self.ready(lanes, rays, ray), found);
                        hit |= u64::from(any) << ray;
                    }
                }
                let majors = lanes.load_int(&rays.major[at..]);
                while bits != 0 {
                    // Once, but where the group looks along a diagonal.
                    let major = rays.major[(at + bits.trailing_zeros() as usize) & (RAYS - 1)];
                    let same = majors.eq(lanes.splat_int(major)).bits() & bits;
                    let some = self.group(lanes, (block, slots), (rays, at, same), &sides, found);
                    hit |= (some as u64) << at;
                    bits &= !same;
                }
            }
        }
        hit
    }

    #[inline(always)]
    fn single<L: Lanes>(
        &mut self,
        lanes: L,
        leaf: Child,
        rays: &Block,
        index: usize,
        ready: OneRay<L>,
        found: &mut Found,
    ) {
        let index = index & (RAYS - 1);
        let blocks = &self.blocks[leaf.first()..leaf.first() + leaf.blocks()];
        let mut at = 0;
        while at < blocks.len() {
            self.one(lanes, &blocks[at], (rays, index), ready, found);
            at += 1;
        }
    }
}
