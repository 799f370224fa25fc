//! Triangles as leaves, one block per leaf.

use lobe_lane::{Floats, Ints, Lanes, MAX_LANES, Mask};

use crate::block::{Block, Found, RAYS, first_ray, group_bits, mask_of};
use crate::bundles::Bundles;
use crate::bvh::Child;
use crate::leaves::{Around, Leaves};
use crate::slab::{Sides, SlabRay};
use crate::triangles::{SLOTS, TriangleBlock};
use crate::woop::{ShearRay, axes_of, axes_of_any};

/// Triangles of one instance.
pub(crate) struct Triangles<'a> {
    blocks: &'a [TriangleBlock],
    instance: i32,
    /// Rays were transformed into the instance's space: hits are kept inside its box.
    transformed: bool,
    /// Any hit is enough.
    any: bool,
    /// The boxes of triangles of the block that was tested last, in the order of a node's rows.
    boxes: [[f32; MAX_LANES]; 6],
}

/// If a large packet has at most this many rays, they are tested one by one, each against all triangles at once.
const FEW: u32 = 10;

impl<'a> Triangles<'a> {
    pub fn new(blocks: &'a [TriangleBlock], instance: usize, transformed: bool, any: bool) -> Self {
        Triangles { blocks, instance: instance as i32, transformed, any, boxes: [[0.0; MAX_LANES]; 6] }
    }

    /// The block of a leaf, and its number of triangles.
    #[inline(always)]
    fn block(&self, leaf: Child) -> (&'a TriangleBlock, usize) {
        (&self.blocks[leaf.first()], leaf.count())
    }

    /// Computes the boxes of a block's first triangles.
    #[inline(always)]
    fn fit<L: Lanes>(&mut self, lanes: L, (block, count): (&TriangleBlock, usize)) {
        let mut slot = 0;
        while slot < count {
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

    /// The bits of those of the first triangles, whose boxes have been computed, that any of several rays may hit.
    #[inline(always)]
    fn candidates<L: Lanes>(&self, lanes: L, count: usize, sides: &Sides, around: Around<'_, L>, rays: u64) -> u32 {
        let mut bits = 0;
        let mut slot = 0;
        while slot < count {
            let [mut near, mut far] = [[lanes.splat(0.0); 3]; 2];
            let mut axis = 0;
            while axis < 3 {
                near[axis] = lanes.load(&self.boxes[sides.near[axis]][slot..]);
                far[axis] = lanes.load(&self.boxes[sides.far[axis]][slot..]);
                axis += 1;
            }
            match around {
                Around::Nothing => bits = u32::MAX,
                Around::Hull(hull) => {
                    let [enter, leave] = hull.interval(lanes, near, far);
                    bits |= enter.le(leave).bits() << slot;
                }
                Around::Bundles(bundles) => {
                    let mut bundle = Bundles::of(rays.trailing_zeros() as usize);
                    let last = Bundles::of(63 - rays.leading_zeros() as usize);
                    while bundle <= last {
                        let [enter, leave] = bundles.interval(lanes, bundle, near, far);
                        bits |= enter.le(leave).bits() << slot;
                        bundle += 1;
                    }
                }
            }
            slot += L::LANES;
        }
        bits & ((1 << count) - 1)
    }

    /// Tests triangles of a block, those of `slots`, against rays of a group that have one octant and one major axis.
    /// `fitted`: their boxes have been computed. Returns the bits of the rays that hit one.
    #[inline(always)]
    fn group<L: Lanes>(
        &mut self,
        lanes: L,
        (block, slots): (&TriangleBlock, u32),
        (rays, at, bits): (&Block, usize, u32),
        (sides, fitted): (&Sides, bool),
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
            let Some(candidates) = ray.test(lanes, block.one(lanes, slot, axes), live) else { continue };
            if !fitted {
                let mut row = 0;
                while row < 6 {
                    self.boxes[row][slot & (SLOTS - 1)] = block.side(slot, row);
                    row += 1;
                }
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
            // t is clamped to where the ray is inside the boxes of the triangle and of the instance. Every box around
            // the triangle then contains the hit as the walks see it, and no answer depends on the order in which boxes
            // are visited.
            if self.transformed {
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
            // Of two hits at the same t, the smaller numbers win, in any order of visits.
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

    /// Tests the first triangles of a block against one ray, with the axes in its order. Returns whether it hit one.
    #[inline(always)]
    fn one<L: Lanes>(
        &self,
        lanes: L,
        (block, count): (&TriangleBlock, usize),
        (rays, index): (&Block, usize),
        axes: [usize; 3],
        found: &mut Found,
    ) -> bool {
        let ray = ShearRay::single(lanes, rays, index);
        let mut any = false;
        let mut slot = 0;
        while slot < count {
            let there = lanes.first_n(count - slot);
            if let Some(candidates) = ray.test(lanes, block.several(lanes, slot, axes), there) {
                let [lower, upper] = block.extent(lanes, slot);
                let own = SlabRay::single(lanes, rays, index).interval_any(lanes, lower, upper);
                let (mut t, mut hit) = (candidates.t, candidates.mask);
                if self.transformed {
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
            slot += L::LANES;
        }
        any
    }
}

impl Leaves for Triangles<'_> {
    #[inline(always)]
    fn any(&self) -> bool {
        self.any
    }

    #[inline(always)]
    fn packet<L: Lanes>(
        &mut self,
        lanes: L,
        leaf: Child,
        rays: &Block,
        live: u64,
        found: &mut Found,
        around: Around<'_, L>,
    ) -> u64 {
        let sides = Sides::of(rays.octant(live.trailing_zeros() as usize));
        let (block, count) = self.block(leaf);
        // One ray at a time is tested against as many triangles as there are lanes, which is better for few rays.
        let each = count.div_ceil(L::LANES) as u32;
        let fitted = !matches!(around, Around::Nothing);
        let few = match around {
            Around::Nothing => false,
            Around::Hull(_) => 2 * each * live.count_ones() <= count as u32,
            Around::Bundles(_) => each == 1 && live.count_ones() <= FEW,
        };
        let (mut alone, mut left) = if few { (live, 0) } else { (0, live) };
        if fitted && !few {
            self.fit(lanes, (block, count));
        }
        let mut hit = 0;
        while left != 0 {
            let at = first_ray::<L>(left.trailing_zeros() as usize);
            let mut bits = group_bits::<L>(left, at);
            left ^= (bits as u64) << at;
            let slots = if fitted {
                self.candidates(lanes, count, &sides, around, (bits as u64) << at)
            } else {
                (1 << count) - 1
            };
            if bits.count_ones() * each < slots.count_ones() {
                alone |= (bits as u64) << at;
                continue;
            }
            if slots == 0 {
                continue;
            }
            let majors = lanes.load_int(&rays.major[at..]);
            while bits != 0 {
                // Once, unless the group looks along a diagonal.
                let major = rays.major[(at + bits.trailing_zeros() as usize) & (RAYS - 1)];
                let same = majors.eq(lanes.splat_int(major)).bits() & bits;
                let some = self.group(lanes, (block, slots), (rays, at, same), (&sides, fitted), found);
                hit |= (some as u64) << at;
                bits &= !same;
            }
        }
        while alone != 0 {
            let ray = alone.trailing_zeros() as usize & (RAYS - 1);
            alone &= alone - 1;
            let any = self.one(lanes, (block, count), (rays, ray), axes_of(rays.major[ray]), found);
            hit |= u64::from(any) << ray;
        }
        hit
    }

    #[inline(always)]
    fn single<L: Lanes>(&mut self, lanes: L, leaf: Child, rays: &Block, ray: usize, found: &mut Found) {
        let ray = ray & (RAYS - 1);
        self.one(lanes, self.block(leaf), (rays, ray), axes_of_any(rays.major[ray]), found);
    }
}
