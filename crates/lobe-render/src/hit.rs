//! Places on surfaces that rays have hit, found in lanes. Nothing is fused, so the bits are the same on every machine.

use lobe::{Backend, Floats, Kernel, Lanes};
use lobe_lane::{Block, Mask};
use lobe_trace::{HitSoA, RaySoA};

use crate::columns::{Column, NOTHING, RAYS, hold, load, store, vector};
use crate::vec3::Vec3;
use crate::vectors::{across, blend, either, largest, less, minus, perpendicular, plus, product, times, unit_or};
use crate::world::{Corner, World};

/// Places on surfaces that rays have hit.
#[derive(Debug, Default)]
pub(crate) struct Hits {
    blocks: Vec<Places>,
    /// Which part of the world each is on.
    parts: Vec<u32>,
    /// Back along the rays, in the frames of the material.
    wo: Vec<Vec3>,
}

/// A place a lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<L: Lanes> {
    pub position: [L::F; 3],
    /// Where shadow rays begin: `position`, moved out of the facets that hide a smooth surface from itself.
    pub lifted: [L::F; 3],
    /// Normal of the triangle, unit length, on the side of the shading normal.
    pub geometric: [L::F; 3],
    /// The frame of the material: x along the tangent, z along the shading normal.
    pub frame: [[L::F; 3]; 3],
    /// How far off the surface rays begin.
    step: L::F,
}

impl<L: Lanes> Place<L> {
    /// A direction of the world in the frame.
    #[inline(always)]
    pub fn local(&self, world: [L::F; 3]) -> [L::F; 3] {
        [product::<L>(self.frame[0], world), product::<L>(self.frame[1], world), product::<L>(self.frame[2], world)]
    }

    /// A direction of the frame in the world.
    #[inline(always)]
    pub fn world(&self, local: [L::F; 3]) -> [L::F; 3] {
        blend::<L>(self.frame, local)
    }

    /// Whether the direction is on the same side of the facet as of the smooth surface. Where it is not, light would
    /// leak through the surface.
    #[inline(always)]
    pub fn sees(&self, lanes: L, world: [L::F; 3], local: [L::F; 3]) -> L::M {
        let zero = lanes.splat(0.0);
        !(product::<L>(self.geometric, world).gt(zero) ^ local[2].gt(zero))
    }

    /// The origin of a ray at this place, off the surface on the side that `direction` leads to.
    #[inline(always)]
    pub fn leave(&self, lanes: L, from: [L::F; 3], direction: [L::F; 3]) -> [L::F; 3] {
        let below = product::<L>(self.geometric, direction).lt(lanes.splat(0.0));
        plus::<L>(from, times::<L>(self.geometric, lanes.select(below, -self.step, self.step)))
    }
}

impl Hits {
    pub fn len(&self) -> usize {
        self.parts.len()
    }

    /// Which part of the world each is on.
    pub fn parts(&self) -> &[u32] {
        &self.parts
    }

    /// Back along the rays, in the frames of the material.
    pub fn wo(&self) -> &[Vec3] {
        &self.wo
    }

    /// The shading normal.
    pub fn normal(&self, hit: usize) -> Vec3 {
        vector(&self.blocks[hit / RAYS].frame[2], hit % RAYS)
    }

    /// The cosine between the ray and the normal of the triangle, positive where the ray met the side that the corners
    /// are counterclockwise from.
    pub fn front(&self, hit: usize) -> f32 {
        self.blocks[hit / RAYS].front[hit % RAYS]
    }

    /// The places from `at` on, which the number of lanes divides. Lanes beyond the last place have any numbers.
    #[inline(always)]
    pub fn places<L: Lanes>(&self, lanes: L, at: usize) -> Place<L> {
        let (block, at) = (&self.blocks[at / RAYS], at & (RAYS - L::LANES));
        Place {
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

    /// Finds the places that some of the rays, which are of unit length, have hit; all of them have hit something.
    pub fn find<const C: usize>(
        &mut self,
        backend: Backend,
        world: &World<C>,
        which: &[u32],
        rays: &RaySoA,
        found: &HitSoA,
    ) {
        self.parts.clear();
        self.wo.clear();
        hold(&mut self.blocks, which.len().div_ceil(RAYS), Places::NOTHING);
        backend.run(Finding { world, which, rays, found, hits: self });
    }
}

/// [`Hits::find`] in lanes.
struct Finding<'a, const C: usize> {
    world: &'a World<C>,
    which: &'a [u32],
    rays: &'a RaySoA,
    found: &'a HitSoA,
    hits: &'a mut Hits,
}

/// What is known of some rays.
struct Known {
    /// Where the first number of each corner is.
    corners: [[i32; RAYS]; 3],
    direction: [Column; 3],
    uv: [Column; 2],
    /// 1 where light may pass through.
    transmits: Column,
}

/// What is found out about them; see [`Place`].
#[derive(Clone, Debug)]
struct Places {
    position: [Column; 3],
    lifted: [Column; 3],
    geometric: [Column; 3],
    frame: [[Column; 3]; 3],
    step: Column,
    front: Column,
}

impl Places {
    const NOTHING: Self = Places {
        position: [NOTHING; 3],
        lifted: [NOTHING; 3],
        geometric: [NOTHING; 3],
        frame: [[NOTHING; 3]; 3],
        step: NOTHING,
        front: NOTHING,
    };
}

impl<const C: usize> Kernel for Finding<'_, C> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Finding { world, which, rays, found, hits } = self;
        let Hits { blocks, parts, wo } = hits;
        let (all, corners) = (world.triangles.as_slice(), world.corners.as_slice());
        let mut known =
            Known { corners: [[0; RAYS]; 3], direction: [NOTHING; 3], uv: [NOTHING; 2], transmits: NOTHING };
        let mut back = [NOTHING; 3];
        for (which, places) in which.chunks(RAYS).zip(blocks) {
            for (lane, ray) in which.iter().enumerate() {
                let ray = *ray as usize;
                let [a, b, c, part] = all[found.primitive[ray] as usize];
                for (column, corner) in known.corners.iter_mut().zip([a, b, c]) {
                    // Vertices are anywhere in memory: all are asked for before the first is needed.
                    lanes.prefetch::<1, _>(corners, corner as usize);
                    column[lane] = corner as i32 * NUMBERS as i32;
                }
                for k in 0..3 {
                    known.direction[k][lane] = rays.direction[k][ray];
                }
                known.uv[0][lane] = found.u[ray];
                known.uv[1][lane] = found.v[ray];
                known.transmits[lane] = world.parts[part as usize].transmits;
                parts.push(part);
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
        }
    }
}

/// How many numbers a corner has.
const NUMBERS: usize = size_of::<Corner>() / size_of::<f32>();

/// Corners a lane: their positions, normals and tangents, and the handedness of the frames.
#[inline(always)]
fn corner<L: Lanes>(lanes: L, corners: &Block<'_, 3, 4>, at: &[i32]) -> ([[L::F; 3]; 3], L::F) {
    let [a, b, c] = lanes.gather_quads(corners, lanes.load_int(at));
    ([[a[0], a[1], a[2]], [a[3], b[0], b[1]], [b[2], b[3], c[0]]], c[1])
}

/// How far `wo` stays above the smooth surface, at least: the sine of the angle.
const GRAZING: f32 = 1e-3;

/// Fills in `places`; returns the ways back along the rays, in the frames.
#[inline(always)]
fn find<L: Lanes>(lanes: L, corners: &Block<'_, 3, 4>, known: &Known, places: &mut Places, at: usize) -> [L::F; 3] {
    let zero = lanes.splat(0.0);
    let one = lanes.splat(1.0);
    let ([pa, na, ta], handedness) = corner(lanes, corners, &known.corners[0][at..]);
    let ([pb, nb, tb], _) = corner(lanes, corners, &known.corners[1][at..]);
    let ([pc, nc, tc], _) = corner(lanes, corners, &known.corners[2][at..]);
    let [u, v] = [lanes.load(&known.uv[0][at..]), lanes.load(&known.uv[1][at..])];
    let w = one - u - v;
    let toward = minus::<L>(load(lanes, &known.direction, at));
    let transmits = zero.lt(lanes.load(&known.transmits[at..]));

    // A hundred units in the last place or so of the largest coordinate of the triangle: what finding the place, and
    // meeting the triangle again, lose.
    let reach = largest::<L>(pa).max(largest::<L>(pb)).max(largest::<L>(pc));
    let step = (reach * lanes.splat(1.0 / 65_536.0)).max(lanes.splat(1e-9));
    let (ab, ac) = (less::<L>(pb, pa), less::<L>(pc, pa));
    let position = plus::<L>(pa, plus::<L>(times::<L>(ab, u), times::<L>(ac, v)));
    // A triangle that was hit has an area; still, it may be too small for its square.
    let mut geometric = unit_or(lanes, across::<L>(ab, ac), toward);
    let front = product::<L>(geometric, toward);
    let weights = [w, u, v];
    let normals = [na, nb, nc];
    let mut normal = unit_or(lanes, blend::<L>(normals, weights), geometric);
    let along = blend::<L>([ta, tb, tc], weights);
    let handedness = one.mul_sign(handedness);

    let turned = product::<L>(geometric, normal).lt(zero);
    geometric = either(lanes, turned, minus::<L>(geometric), geometric);
    // What reflects only has two equal sides: the frame is turned about the tangent.
    let behind = product::<L>(geometric, toward).lt(zero);
    let turned = behind & !transmits;
    geometric = either(lanes, turned, minus::<L>(geometric), geometric);
    normal = either(lanes, turned, minus::<L>(normal), normal);
    let side = lanes.select(turned, -one, one);
    let above = lanes.select(behind & transmits, -one, one);
    // A smooth normal that turns away from the viewer at the silhouette is turned back.
    let rise = above * product::<L>(normal, toward);
    let grazing = lanes.splat(GRAZING);
    let low = rise.lt(grazing);
    if low.any() {
        let lift = times::<L>(toward, above * (grazing - rise));
        normal = either(lanes, low, unit_or(lanes, plus::<L>(normal, lift), geometric), normal);
    }
    let flat = less::<L>(along, times::<L>(normal, product::<L>(along, normal)));
    let tangent = unit_or(lanes, flat, perpendicular(lanes, normal));
    let frame = [tangent, times::<L>(across::<L>(normal, tangent), handedness), normal];

    // The place moved to the smooth surface that the normals of the corners describe: Hanika 2021, "Hacking the Shadow
    // Terminator" (Ray Tracing Gems II, chapter 4).
    let mut lifted = position;
    let positions = [pa, pb, pc];
    for k in 0..3 {
        let normal = times::<L>(normals[k], side);
        let below = (-product::<L>(less::<L>(position, positions[k]), normal)).max(zero);
        lifted = plus::<L>(lifted, times::<L>(normal, weights[k] * below));
    }

    store(lanes, &mut places.position, at, position);
    store(lanes, &mut places.lifted, at, lifted);
    store(lanes, &mut places.geometric, at, geometric);
    lanes.store(&mut places.step[at..], step);
    lanes.store(&mut places.front[at..], front);
    let mut wo = [zero; 3];
    for k in 0..3 {
        store(lanes, &mut places.frame[k], at, frame[k]);
        wo[k] = product::<L>(frame[k], toward);
    }
    wo
}
