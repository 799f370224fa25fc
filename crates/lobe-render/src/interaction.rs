//! Surface interactions: points on surfaces that rays have hit, computed in lanes. No operations are fused, so the bits
//! are the same on every machine.

use lobe::{Backend, Floats, Kernel, Lanes};
use lobe_lane::{Block, Mask};
use lobe_trace::{HitSoA, RaySoA};

use crate::columns::{Column, RAYS, ZEROS, ensure_len, load, store, vector};
use crate::place::Place;
use crate::transport::Transport;
use crate::vec3::Vec3;
use crate::vectors::{add, blend, cross, dot, max_component, neg, perpendicular, scale, select, sub, unit_or};
use crate::world::{Corner, MaterialGroup, World};

/// The surface interactions of a wave, sorted by material.
#[derive(Debug, Default)]
pub(crate) struct Interactions {
    blocks: Vec<InteractionBlock>,
    /// Which group of triangles each is on.
    groups: Vec<u32>,
    /// Back along the rays, in the frames of the material.
    wo: Vec<Vec3>,
}

/// A point on a surface in each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceInteraction<L: Lanes> {
    pub position: [L::F; 3],
    /// The origin of shadow rays: `position`, moved out of the facets that hide a smooth surface from itself.
    pub lifted: [L::F; 3],
    /// Unit normal of the triangle, on the side of the shading normal.
    pub geometric: [L::F; 3],
    /// The frame of the material: x along the tangent, z along the shading normal.
    pub frame: [[L::F; 3]; 3],
    /// Distance from the surface at which rays begin.
    step: L::F,
}

impl<L: Lanes> SurfaceInteraction<L> {
    /// Transforms a direction from the world to the frame.
    #[inline(always)]
    pub fn local(&self, world: [L::F; 3]) -> [L::F; 3] {
        [dot::<L>(self.frame[0], world), dot::<L>(self.frame[1], world), dot::<L>(self.frame[2], world)]
    }

    /// Transforms a direction from the frame to the world.
    #[inline(always)]
    pub fn world(&self, local: [L::F; 3]) -> [L::F; 3] {
        blend::<L>(self.frame, local)
    }

    /// `true` if the direction is on the same side of the facet and of the smooth surface. If it is not, light would
    /// leak through the surface.
    #[inline(always)]
    pub fn same_side(&self, lanes: L, world: [L::F; 3], local: [L::F; 3]) -> L::M {
        let zero = lanes.splat(0.0);
        !(dot::<L>(self.geometric, world).gt(zero) ^ local[2].gt(zero))
    }

    /// The origin of a ray at `from`, moved off the surface to the side of `direction`.
    #[inline(always)]
    pub fn offset_origin(&self, lanes: L, from: [L::F; 3], direction: [L::F; 3]) -> [L::F; 3] {
        let below = dot::<L>(self.geometric, direction).lt(lanes.splat(0.0));
        add::<L>(from, scale::<L>(self.geometric, lanes.select(below, -self.step, self.step)))
    }

    /// The factor that corrects importance for the difference between the shading normal and the normal of the triangle
    /// (Veach 1997, section 5.3.2), for a path that arrives from `wo` and continues to `wi`, both in the frame. It is 1
    /// if the normals are equal.
    #[inline(always)]
    pub fn adjoint_correction(&self, lanes: L, wo: [L::F; 3], wi: [L::F; 3]) -> L::F {
        let from = dot::<L>(self.geometric, self.world(wo)).abs();
        let to = dot::<L>(self.geometric, self.world(wi)).abs();
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let divisor = from * wi[2].abs();
        let usable = zero.lt(divisor);
        lanes.select(usable, wo[2].abs() * to / lanes.select(usable, divisor, one), zero)
    }
}

impl Interactions {
    pub fn len(&self) -> usize {
        self.groups.len()
    }

    /// One of the interactions.
    pub fn place(&self, hit: usize) -> Place {
        let (block, at) = (&self.blocks[hit / RAYS], hit % RAYS);
        Place {
            position: vector(&block.position, at),
            lifted: vector(&block.lifted, at),
            geometric: vector(&block.geometric, at),
            frame: block.frame.each_ref().map(|axis| vector(axis, at)),
            step: block.step[at],
        }
    }

    /// The point on the triangle.
    pub fn position(&self, hit: usize) -> Vec3 {
        vector(&self.blocks[hit / RAYS].position, hit % RAYS)
    }

    /// The normal of the triangle.
    pub fn geometric(&self, hit: usize) -> Vec3 {
        vector(&self.blocks[hit / RAYS].geometric, hit % RAYS)
    }

    /// Which group of triangles each is on.
    pub fn groups(&self) -> &[u32] {
        &self.groups
    }

    /// Back along the rays, in the frames of the material.
    pub fn wo(&self) -> &[Vec3] {
        &self.wo
    }

    /// The shading normal.
    pub fn normal(&self, hit: usize) -> Vec3 {
        vector(&self.blocks[hit / RAYS].frame[2], hit % RAYS)
    }

    /// The frame of the material: x along the tangent, z along the shading normal.
    pub fn frame(&self, hit: usize) -> [Vec3; 3] {
        self.blocks[hit / RAYS].frame.each_ref().map(|axis| vector(axis, hit % RAYS))
    }

    /// The cosine between the ray and the normal of the triangle, positive if the ray hit the side from which the
    /// corners are counterclockwise.
    pub fn front(&self, hit: usize) -> f32 {
        self.blocks[hit / RAYS].front[hit % RAYS]
    }

    /// The interactions from `at` on, which is a multiple of the number of lanes. Lanes beyond the last one are
    /// unspecified.
    #[inline(always)]
    pub fn load<L: Lanes>(&self, lanes: L, at: usize) -> SurfaceInteraction<L> {
        let (block, at) = (&self.blocks[at / RAYS], at & (RAYS - L::LANES));
        SurfaceInteraction {
            position: load(lanes, &block.position, at),
            lifted: load(lanes, &block.lifted, at),
            geometric: load(lanes, &block.geometric, at),
            frame: [
                load(lanes, &block.frame[0], at),
                load(lanes, &block.frame[1], at),
                load(lanes, &block.frame[2], at),
            ],
            step: lanes.load(&block.step[at..]),
        }
    }

    /// Finds the interactions of some of the rays, which must be of unit length and must all have hit something.
    pub fn find<T: Transport>(
        &mut self,
        backend: Backend,
        world: &World<T>,
        which: &[u32],
        rays: &RaySoA,
        found: &HitSoA,
    ) {
        self.groups.clear();
        self.wo.clear();
        ensure_len(&mut self.blocks, which.len().div_ceil(RAYS), InteractionBlock::ZEROS);
        let World { corners, triangles, groups: materials, .. } = world;
        let (corners, triangles) = (corners.as_slice(), triangles.as_slice());
        self.find_on(backend, FoundOn { corners, triangles, materials }, which, rays, found);
    }

    /// Not generic, so that the kernel is compiled once for all transports.
    fn find_on(&mut self, backend: Backend, on: FoundOn<'_>, which: &[u32], rays: &RaySoA, found: &HitSoA) {
        backend.run(FindInteractions { on, which, rays, found, hits: self });
    }
}

/// The triangles of a world.
#[derive(Clone, Copy)]
struct FoundOn<'a> {
    corners: &'a [Corner],
    triangles: &'a [[u32; 4]],
    materials: &'a [MaterialGroup],
}

/// [`Interactions::find`] in lanes.
struct FindInteractions<'a> {
    on: FoundOn<'a>,
    which: &'a [u32],
    rays: &'a RaySoA,
    found: &'a HitSoA,
    hits: &'a mut Interactions,
}

/// The input of the kernel for 64 hits.
struct HitBlock {
    /// The offset of the first number of each corner.
    corners: [[i32; RAYS]; 3],
    direction: [Column; 3],
    uv: [Column; 2],
    /// 1 if light may pass through the surface.
    transmits: Column,
}

/// The output of the kernel; see [`SurfaceInteraction`].
#[derive(Clone, Debug)]
struct InteractionBlock {
    position: [Column; 3],
    lifted: [Column; 3],
    geometric: [Column; 3],
    frame: [[Column; 3]; 3],
    step: Column,
    front: Column,
}

impl InteractionBlock {
    const ZEROS: Self = InteractionBlock {
        position: [ZEROS; 3],
        lifted: [ZEROS; 3],
        geometric: [ZEROS; 3],
        frame: [[ZEROS; 3]; 3],
        step: ZEROS,
        front: ZEROS,
    };
}

impl Kernel for FindInteractions<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let FindInteractions { on: FoundOn { corners, triangles: all, materials }, which, rays, found, hits } = self;
        let Interactions { blocks, groups, wo } = hits;
        let mut known = HitBlock { corners: [[0; RAYS]; 3], direction: [ZEROS; 3], uv: [ZEROS; 2], transmits: ZEROS };
        let mut back = [ZEROS; 3];
        let mut block = 0;
        while block * RAYS < which.len() {
            let places = &mut blocks[block];
            let which = &which[block * RAYS..which.len().min((block + 1) * RAYS)];
            let mut lane = 0;
            while lane < which.len() {
                let ray = which[lane] as usize;
                let [a, b, c, group] = all[found.primitive[ray] as usize];
                let mut k = 0;
                while k < 3 {
                    // Vertices are scattered in memory, so all are prefetched before the first is needed.
                    let corner = [a, b, c][k];
                    lanes.prefetch::<1, _>(corners, corner as usize);
                    known.corners[k][lane] = corner as i32 * NUMBERS as i32;
                    known.direction[k][lane] = rays.direction[k][ray];
                    k += 1;
                }
                known.uv[0][lane] = found.u[ray];
                known.uv[1][lane] = found.v[ray];
                known.transmits[lane] = materials[group as usize].transmits;
                groups.push(group);
                lane += 1;
            }
            let corners = Block::new(corners.as_flattened(), [0, 4, 8]);
            let mut at = 0;
            while at < which.len() {
                store(lanes, &mut back, at, find(lanes, &corners, &known, places, at));
                at += L::LANES;
            }
            for lane in 0..which.len() {
                wo.push(vector(&back, lane));
            }
            block += 1;
        }
    }
}

/// Numbers per corner.
const NUMBERS: usize = size_of::<Corner>() / size_of::<f32>();

/// One corner in each lane: its position, normal and tangent, and the handedness of the frame.
#[inline(always)]
fn corner<L: Lanes>(lanes: L, corners: &Block<'_, 3, 4>, at: &[i32]) -> ([[L::F; 3]; 3], L::F) {
    let [a, b, c] = lanes.gather_quads_at(corners, at);
    ([[a[0], a[1], a[2]], [a[3], b[0], b[1]], [b[2], b[3], c[0]]], c[1])
}

/// How far `wo` stays above the smooth surface at least, as the sine of the angle.
const GRAZING: f32 = 1e-3;

/// Fills in `places`; returns the directions back along the rays, in the frames.
#[inline(always)]
fn find<L: Lanes>(
    lanes: L,
    corners: &Block<'_, 3, 4>,
    known: &HitBlock,
    places: &mut InteractionBlock,
    at: usize,
) -> [L::F; 3] {
    let zero = lanes.splat(0.0);
    let one = lanes.splat(1.0);
    let ([pa, na, ta], handedness) = corner(lanes, corners, &known.corners[0][at..]);
    let ([pb, nb, tb], _) = corner(lanes, corners, &known.corners[1][at..]);
    let ([pc, nc, tc], _) = corner(lanes, corners, &known.corners[2][at..]);
    let [u, v] = [lanes.load(&known.uv[0][at..]), lanes.load(&known.uv[1][at..])];
    let w = one - u - v;
    let toward = neg::<L>(load(lanes, &known.direction, at));
    let transmits = zero.lt(lanes.load(&known.transmits[at..]));

    // About a hundred units in the last place of the largest coordinate of the triangle: the rounding errors of finding
    // the place, and of hitting the triangle again.
    let reach = max_component::<L>(pa).max(max_component::<L>(pb)).max(max_component::<L>(pc));
    let step = (reach * lanes.splat(1.0 / 65_536.0)).max(lanes.splat(1e-9));
    let (ab, ac) = (sub::<L>(pb, pa), sub::<L>(pc, pa));
    let position = add::<L>(pa, add::<L>(scale::<L>(ab, u), scale::<L>(ac, v)));
    // A triangle that was hit has an area, but the square of the area may underflow.
    let mut geometric = unit_or(lanes, cross::<L>(ab, ac), toward);
    let front = dot::<L>(geometric, toward);
    let weights = [w, u, v];
    let normals = [na, nb, nc];
    let mut normal = unit_or(lanes, blend::<L>(normals, weights), geometric);
    let along = blend::<L>([ta, tb, tc], weights);
    let handedness = one.mul_sign(handedness);

    let turned = dot::<L>(geometric, normal).lt(zero);
    geometric = select(lanes, turned, neg::<L>(geometric), geometric);
    // A material that only reflects has two equal sides: the frame is rotated about the tangent.
    let behind = dot::<L>(geometric, toward).lt(zero);
    let turned = behind & !transmits;
    geometric = select(lanes, turned, neg::<L>(geometric), geometric);
    normal = select(lanes, turned, neg::<L>(normal), normal);
    let side = lanes.select(turned, -one, one);
    let above = lanes.select(behind & transmits, -one, one);
    // A smooth normal that points away from the viewer at the silhouette is rotated back.
    let rise = above * dot::<L>(normal, toward);
    let grazing = lanes.splat(GRAZING);
    let low = rise.lt(grazing);
    if low.any() {
        let lift = scale::<L>(toward, above * (grazing - rise));
        normal = select(lanes, low, unit_or(lanes, add::<L>(normal, lift), geometric), normal);
    }
    let flat = sub::<L>(along, scale::<L>(normal, dot::<L>(along, normal)));
    let tangent = unit_or(lanes, flat, perpendicular(lanes, normal));
    let frame = [tangent, scale::<L>(cross::<L>(normal, tangent), handedness), normal];

    // Moves the place to the smooth surface that the normals of the corners describe: Hanika 2021, "Hacking the Shadow
    // Terminator" (Ray Tracing Gems II, chapter 4).
    let mut lifted = position;
    let positions = [pa, pb, pc];
    for k in 0..3 {
        let normal = scale::<L>(normals[k], side);
        let below = (-dot::<L>(sub::<L>(position, positions[k]), normal)).max(zero);
        lifted = add::<L>(lifted, scale::<L>(normal, weights[k] * below));
    }

    store(lanes, &mut places.position, at, position);
    store(lanes, &mut places.lifted, at, lifted);
    store(lanes, &mut places.geometric, at, geometric);
    lanes.store(&mut places.step[at..], step);
    lanes.store(&mut places.front[at..], front);
    let mut wo = [zero; 3];
    for k in 0..3 {
        store(lanes, &mut places.frame[k], at, frame[k]);
        wo[k] = dot::<L>(frame[k], toward);
    }
    wo
}

#[cfg(test)]
mod tests {
    use lobe_scalar::Scalar;

    use super::*;

    #[test]
    fn importance_is_corrected_for_shading_normals_and_only_for_them() {
        let lanes = Scalar::<1>;
        let splat = |v: [f32; 3]| lanes.splat_xyz(v);
        let frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(splat);
        let at = |geometric| SurfaceInteraction::<Scalar<1>> {
            position: splat([0.0; 3]),
            lifted: splat([0.0; 3]),
            geometric: splat(geometric),
            frame,
            step: lanes.splat(0.0),
        };
        let (wo, wi) = (splat([0.6, 0.0, 0.8]), splat([0.0, -0.8, 0.6]));
        let of = |surface: &SurfaceInteraction<Scalar<1>>, wo, wi| {
            lanes.extract(surface.adjoint_correction(lanes, wo, wi), 0)
        };
        assert!((of(&at([0.0, 0.0, 1.0]), wo, wi) - 1.0).abs() < 1e-6);
        // |wo . ns| |wi . ng| / (|wo . ng| |wi . ns|), by hand.
        let bent = at([0.28, 0.0, 0.96]);
        let expected = 0.8 * (0.6 * 0.96) / ((0.6 * 0.28 + 0.8 * 0.96) * 0.6);
        assert!((of(&bent, wo, wi) - expected).abs() < 1e-6);
        // The opposite direction undoes it.
        assert!((of(&bent, wo, wi) * of(&bent, wi, wo) - 1.0).abs() < 1e-6);
        assert_eq!(of(&bent, wo, splat([1.0, 0.0, 0.0])), 0.0);
    }
}
