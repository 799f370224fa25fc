//! Batches and packets of rays through a scene.

use lobe_backend::Backend;
use lobe_lane::{Floats, Ints, Kernel, Lanes, Mask};

use crate::block::{Block, Found, RAYS, first_ray};
use crate::instances::Instances;
use crate::packet::{Packet, PacketHits};
use crate::rays::{Hits, MISS, Rays};
use crate::scene::Scene;
use crate::triangle_leaves::Triangles;
use crate::walk::{Nodes, Stacks, Walk};
use crate::{Form, RayClass};

/// Compiled once, here, for trees of eight children per node.
impl Scene<8> {
    /// Finds the nearest hits of a batch of rays.
    ///
    /// # Panics
    /// If `rays` and `hits` differ in length.
    pub fn intersect(&self, backend: Backend, class: RayClass, rays: Rays<'_>, hits: Hits<'_>) {
        self.intersect_by(backend, class.form(), rays, hits);
    }

    /// The same with any form of walk, for comparison: the hits have the same bits.
    ///
    /// # Panics
    /// If `rays` and `hits` differ in length.
    pub fn intersect_by(&self, backend: Backend, form: Form, rays: Rays<'_>, hits: Hits<'_>) {
        backend.run(Intersect::new(self, form, rays, hits));
    }

    /// Finds which rays of a batch hit anything.
    ///
    /// # Panics
    /// If `rays` and `out` differ in length.
    pub fn occluded(&self, backend: Backend, class: RayClass, rays: Rays<'_>, out: &mut [bool]) {
        self.occluded_by(backend, class.form(), rays, out);
    }

    /// The same with any form of walk, for comparison: the answers are the same.
    ///
    /// # Panics
    /// If `rays` and `out` differ in length.
    pub fn occluded_by(&self, backend: Backend, form: Form, rays: Rays<'_>, out: &mut [bool]) {
        backend.run(Occluded::new(self, form, rays, out));
    }
}

/// The working memory of tracing one scene. Creating it allocates; tracing with it does not.
#[derive(Debug)]
pub struct Tracer<'s, const W: usize> {
    scene: &'s Scene<W>,
    rays: Block,
    local: Block,
    found: Found,
    top: Stacks,
    bottom: Stacks,
}

impl<'s, const W: usize> Tracer<'s, W> {
    /// Working memory for a scene.
    pub fn new(scene: &'s Scene<W>) -> Self {
        let deepest = scene.trees.iter().map(|tree| tree.bvh.stack).max().unwrap_or(0);
        // A scene of one untransformed mesh takes one walk, not one within another.
        let below = if scene.plain().is_some() { 0 } else { deepest };
        Tracer {
            scene,
            rays: Block::new(),
            local: Block::new(),
            found: Found::new(),
            top: Stacks::new(scene.top.stack.max(deepest)),
            bottom: Stacks::new(below),
        }
    }

    /// The nearest hits of the rays of `live`. Call it inside a kernel.
    #[inline(always)]
    pub fn intersect_packet<L: Lanes>(
        &mut self,
        lanes: L,
        class: RayClass,
        rays: Packet<L>,
        live: L::M,
    ) -> PacketHits<L> {
        let live = self.set(lanes, 0, rays, live);
        self.trace(lanes, packet_form(class), false, live.bits() as u64);
        self.conclude(lanes, 0)
    }

    /// Which rays of `live` hit anything. Call it inside a kernel.
    #[inline(always)]
    pub fn occluded_packet<L: Lanes>(&mut self, lanes: L, class: RayClass, rays: Packet<L>, live: L::M) -> L::M {
        let live = self.set(lanes, 0, rays, live);
        self.trace(lanes, packet_form(class), true, live.bits() as u64);
        !lanes.load_int(&self.found.primitive).eq(lanes.splat_int(Found::NONE))
    }

    /// Stores a group of rays. Returns which are valid.
    #[inline(always)]
    fn set<L: Lanes>(&mut self, lanes: L, at: usize, rays: Packet<L>, live: L::M) -> L::M {
        let reach = self.scene.bounds().reach();
        // A finite limit keeps a ray that misses a box from seeming to hit it at infinity. NaN stays NaN.
        let t_max = lanes.splat(f32::MAX).min(rays.t_max);
        let valid = self.rays.prepare(lanes, at, Packet { t_max, ..rays }, live, reach);
        self.found.reset(lanes, at, lanes.select(valid, t_max, lanes.splat(f32::NEG_INFINITY)));
        valid
    }

    /// Traces the stored rays.
    #[inline(always)]
    fn trace<L: Lanes>(&mut self, lanes: L, form: Form, any: bool, live: u64) {
        let Tracer { scene, rays, local, found, top, bottom } = self;
        if let Some(tree) = scene.plain() {
            let leaves = &mut Triangles::new(tree.blocks.as_slice(), 0, false, any);
            Walk { bvh: Nodes::new(&tree.bvh, tree.blocks.as_slice()), leaves, rays: &*rays, found, stacks: top }
                .trace(lanes, form, live);
        } else {
            let leaves = &mut Instances { scene: *scene, form, any, local, stacks: bottom };
            Walk { bvh: Nodes::new::<f32>(&scene.top, &[]), leaves, rays: &*rays, found, stacks: top }
                .trace(lanes, form, live);
        }
    }

    /// The hits found for a group.
    #[inline(always)]
    fn conclude<L: Lanes>(&self, lanes: L, at: usize) -> PacketHits<L> {
        let at = first_ray::<L>(at);
        let primitive = lanes.load_int(&self.found.primitive[at..]);
        let mask = !primitive.eq(lanes.splat_int(Found::NONE));
        let miss = lanes.splat_int(MISS);
        PacketHits {
            mask,
            t: lanes.select(mask, lanes.load(&self.found.t[at..]), lanes.splat(f32::INFINITY)),
            u: lanes.load_int(&self.found.u[at..]).as_float(),
            v: lanes.load_int(&self.found.v[at..]).as_float(),
            primitive: lanes.select_int(mask, primitive, miss),
            instance: lanes.select_int(mask, lanes.load_int(&self.found.instance[at..]), miss),
        }
    }

    /// Stores up to 64 rays, starting at `from`. Returns the bits of the valid ones.
    #[inline(always)]
    fn set_block<L: Lanes>(&mut self, lanes: L, rays: &Rays<'_>, from: usize) -> u64 {
        let mut live = 0;
        let mut at = 0;
        while at < RAYS {
            let start = if from + at < rays.len() { from + at } else { rays.len() };
            let [o_x, o_y, o_z] = rays.origin;
            let [d_x, d_y, d_z] = rays.direction;
            let packet = Packet {
                origin: [
                    lanes.load_partial(&o_x[start..]),
                    lanes.load_partial(&o_y[start..]),
                    lanes.load_partial(&o_z[start..]),
                ],
                direction: [
                    lanes.load_partial(&d_x[start..]),
                    lanes.load_partial(&d_y[start..]),
                    lanes.load_partial(&d_z[start..]),
                ],
                t_min: lanes.load_partial(&rays.t_min[start..]),
                t_max: lanes.load_partial(&rays.t_max[start..]),
            };
            let there = lanes.first_n(rays.len() - start);
            live |= (self.set(lanes, at, packet, there).bits() as u64) << at;
            at += L::LANES;
        }
        live
    }
}

/// A packet of one ray per lane is never large.
#[inline(always)]
fn packet_form(class: RayClass) -> Form {
    match class.form() {
        Form::Large => Form::Hybrid,
        form => form,
    }
}

/// Finds the nearest hits of a batch, as a kernel: for trees of four children per node and lanes that are not a
/// [`Backend`]. In all other cases call [`Scene::intersect`].
#[derive(Debug)]
pub struct Intersect<'a, const W: usize> {
    scene: &'a Scene<W>,
    form: Form,
    rays: Rays<'a>,
    hits: Hits<'a>,
}

impl<'a, const W: usize> Intersect<'a, W> {
    /// The kernel for these rays.
    ///
    /// # Panics
    /// If `rays` and `hits` differ in length.
    pub fn new(scene: &'a Scene<W>, form: Form, rays: Rays<'a>, hits: Hits<'a>) -> Self {
        assert_eq!(rays.len(), hits.len(), "one hit per ray");
        Intersect { scene, form, rays, hits }
    }
}

impl<const W: usize> Kernel for Intersect<'_, W> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Intersect { scene, form, rays, hits } = self;
        let mut tracer = Tracer::new(scene);
        let mut from = 0;
        while from < rays.len() {
            let live = tracer.set_block(lanes, &rays, from);
            tracer.trace(lanes, form, false, live);
            let mut at = 0;
            while at < RAYS && from + at < rays.len() {
                let found = tracer.conclude(lanes, at);
                let start = from + at;
                lanes.store_partial(&mut hits.t[start..], found.t);
                lanes.store_partial(&mut hits.u[start..], found.u);
                lanes.store_partial(&mut hits.v[start..], found.v);
                lanes.store_int_partial(&mut hits.primitive[start..], found.primitive);
                lanes.store_int_partial(&mut hits.instance[start..], found.instance);
                at += L::LANES;
            }
            from += RAYS;
        }
    }
}

/// Finds which rays of a batch hit anything, as a kernel: for trees of four children per node and lanes that are not a
/// [`Backend`]. In all other cases call [`Scene::occluded`].
#[derive(Debug)]
pub struct Occluded<'a, const W: usize> {
    scene: &'a Scene<W>,
    form: Form,
    rays: Rays<'a>,
    out: &'a mut [bool],
}

impl<'a, const W: usize> Occluded<'a, W> {
    /// The kernel for these rays.
    ///
    /// # Panics
    /// If `rays` and `out` differ in length.
    pub fn new(scene: &'a Scene<W>, form: Form, rays: Rays<'a>, out: &'a mut [bool]) -> Self {
        assert_eq!(rays.len(), out.len(), "one answer per ray");
        Occluded { scene, form, rays, out }
    }
}

impl<const W: usize> Kernel for Occluded<'_, W> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Occluded { scene, form, rays, out } = self;
        let mut tracer = Tracer::new(scene);
        let mut from = 0;
        while from < rays.len() {
            let live = tracer.set_block(lanes, &rays, from);
            tracer.trace(lanes, form, true, live);
            let mut at = 0;
            while at < RAYS && from + at < rays.len() {
                out[from + at] = tracer.found.primitive[at] != Found::NONE;
                at += 1;
            }
            from += RAYS;
        }
    }
}
