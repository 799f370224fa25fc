//! Instances as leaves: rays are transformed into the space of the instance and traced through its tree there.

use lobe_lane::{Lanes, Mask};

use crate::block::{Block, Found, RAYS, first_ray, group_bits, group_rows, mask_of};
use crate::bvh::Child;
use crate::leaves::{Around, Leaves};
use crate::packet::Packet;
use crate::scene::{Instance, Scene};
use crate::slab::SlabRay;
use crate::triangle_leaves::Triangles;
use crate::walk::{Nodes, Stacks, Walk};
use crate::{Affine, Form};

/// The instances of a scene, and memory for rays in the space of one.
pub(crate) struct Instances<'a, const W: usize> {
    pub scene: &'a Scene<W>,
    pub form: Form,
    /// Any hit is enough.
    pub any: bool,
    pub local: &'a mut Block,
    pub stacks: &'a mut Stacks,
}

impl<const W: usize> Instances<'_, W> {
    /// Transforms rays of a group into the space of an instance. Returns the bits of those that may hit it.
    #[inline(always)]
    fn transform<L: Lanes>(&mut self, lanes: L, instance: &Instance, rays: &Block, at: usize, live: u32) -> u32 {
        let at = first_ray::<L>(at);
        let (mut lower, mut upper) = ([lanes.splat(0.0); 3], [lanes.splat(0.0); 3]);
        let mut axis = 0;
        while axis < 3 {
            lower[axis] = lanes.splat(instance.bounds.lower[axis]);
            upper[axis] = lanes.splat(instance.bounds.upper[axis]);
            axis += 1;
        }
        let [enter, leave] = SlabRay::group(lanes, rays, at).interval_any(lanes, lower, upper);
        lanes.store(&mut self.local.enter[at..], enter);
        lanes.store(&mut self.local.leave[at..], leave);
        let origin = image(lanes, &instance.to_local, group_rows(lanes, &rays.origin, at), 1.0);
        let direction = image(lanes, &instance.to_local, group_rows(lanes, &rays.direction, at), 0.0);
        let t_min = lanes.load(&rays.t_min[at..]);
        let packet = Packet { origin, direction, t_min, t_max: lanes.splat(f32::INFINITY) };
        let reach = self.scene.trees[instance.mesh].bvh.bounds().reach();
        self.local.prepare(lanes, at, packet, mask_of(lanes, live), reach).bits()
    }

    /// Traces rays that have been transformed into the space of an instance.
    #[inline(always)]
    fn trace<L: Lanes>(&mut self, lanes: L, number: usize, form: Form, live: u64, found: &mut Found) {
        let tree = &self.scene.trees[self.scene.instances[number].mesh];
        let leaves = &mut Triangles::new(tree.blocks.as_slice(), number, true, self.any);
        let bvh = Nodes::new(&tree.bvh, tree.blocks.as_slice());
        Walk { bvh, leaves, rays: &*self.local, found, stacks: &mut *self.stacks }.trace(lanes, form, live);
    }
}

/// The image of points (`w` 1) or directions (`w` 0).
#[inline(always)]
fn image<L: Lanes>(lanes: L, map: &Affine, x: [L::F; 3], w: f32) -> [L::F; 3] {
    let mut image = x;
    let mut row = 0;
    while row < 3 {
        let [a, b, c, d] = map.rows[row];
        let sum = lanes.mul_add(lanes.splat(c), x[2], lanes.splat(d * w));
        image[row] = lanes.mul_add(lanes.splat(a), x[0], lanes.mul_add(lanes.splat(b), x[1], sum));
        row += 1;
    }
    image
}

impl<const W: usize> Leaves for Instances<'_, W> {
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
        _around: Around<'_, L>,
    ) -> u64 {
        let instance = &self.scene.instances[leaf.first()];
        let mut transformed = 0;
        let mut at = 0;
        while at < RAYS {
            let bits = group_bits::<L>(live, at);
            if bits != 0 {
                transformed |= (self.transform(lanes, instance, rays, at, bits) as u64) << at;
            } else {
                lanes.store(&mut self.local.t_min[at..], lanes.splat(f32::INFINITY));
            }
            at += L::LANES;
        }
        self.trace(lanes, leaf.first(), self.form, transformed, found);
        transformed
    }

    #[inline(always)]
    fn single<L: Lanes>(&mut self, lanes: L, leaf: Child, rays: &Block, ray: usize, found: &mut Found) {
        let instance = &self.scene.instances[leaf.first()];
        let at = first_ray::<L>(ray);
        let bits = self.transform(lanes, instance, rays, at, 1 << (ray - at));
        self.trace(lanes, leaf.first(), Form::Single, (bits as u64) << at, found);
    }
}
