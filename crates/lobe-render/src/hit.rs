//! Places on surfaces that rays have hit, found in lanes. Nothing is fused, so the bits are the same on every machine.

use lobe::{Backend, Floats, Kernel, Lanes};
use lobe_lane::Mask;
use lobe_trace::{HitSoA, RaySoA};

use crate::vec3::{Vec3, add, dot, scale};
use crate::world::{Corner, World};

/// A place on a surface that a ray has hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    pub position: Vec3,
    /// Where shadow rays begin: `position`, moved out of the facets that hide a smooth surface from itself.
    pub lifted: Vec3,
    /// Normal of the triangle, unit length, on the side of the shading normal.
    pub geometric: Vec3,
    /// Whether the ray met the side that the corners are counterclockwise from.
    pub front: bool,
    /// How far off the surface rays begin.
    step: f32,
    /// The frame of the material: x along the tangent, z along the shading normal.
    pub frame: [Vec3; 3],
    /// Back along the ray, in the frame.
    pub wo: Vec3,
    pub material: u32,
    pub light: Option<u32>,
}

impl Hit {
    /// A direction of the world in the frame.
    pub fn local(&self, world: Vec3) -> Vec3 {
        self.frame.map(|axis| dot(axis, world))
    }

    /// A direction of the frame in the world.
    pub fn world(&self, local: Vec3) -> Vec3 {
        let [t, b, n] = self.frame;
        add(add(scale(t, local[0]), scale(b, local[1])), scale(n, local[2]))
    }

    /// Whether the direction is on the same side of the facet as of the smooth surface. Where it is not, light would
    /// leak through the surface.
    pub fn sees(&self, world: Vec3, local: Vec3) -> bool {
        (dot(self.geometric, world) > 0.0) == (local[2] > 0.0)
    }

    /// A ray's origin at this place, off the surface on the side that `direction` leads to.
    pub fn leave(&self, from: Vec3, direction: Vec3) -> Vec3 {
        let step = if dot(self.geometric, direction) < 0.0 { -self.step } else { self.step };
        add(from, scale(self.geometric, step))
    }
}

impl<const C: usize> World<C> {
    /// The places that some of the rays, which are of unit length, have hit; all of them have hit something.
    pub(crate) fn hits(&self, backend: Backend, which: &[u32], rays: &RaySoA, found: &HitSoA, out: &mut Vec<Hit>) {
        out.clear();
        out.reserve(which.len());
        backend.run(Meeting { world: self, which, rays, found, out });
    }
}

struct Meeting<'a, const C: usize> {
    world: &'a World<C>,
    which: &'a [u32],
    rays: &'a RaySoA,
    found: &'a HitSoA,
    out: &'a mut Vec<Hit>,
}

/// Rays that are looked at together: enough that what was put together by scalars has left for the cache when lanes
/// read it.
const BLOCK: usize = 64;

/// A number of each of them.
type Column = [f32; BLOCK];

/// What is known of some rays.
struct Known {
    /// Position, normal and tangent of each corner.
    corners: [[Column; 10]; 3],
    direction: [Column; 3],
    uv: [Column; 2],
    /// 1 where light may pass through.
    transmits: Column,
}

/// What is found out about them.
struct Found {
    position: [Column; 3],
    lifted: [Column; 3],
    geometric: [Column; 3],
    frame: [[Column; 3]; 3],
    wo: [Column; 3],
    step: Column,
    /// Positive where the ray met the front.
    front: Column,
}

const NOTHING: Column = [0.0; BLOCK];

impl<const C: usize> Kernel for Meeting<'_, C> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Meeting { world, which, rays, found, out } = self;
        let mut known =
            Known { corners: [[NOTHING; 10]; 3], direction: [NOTHING; 3], uv: [NOTHING; 2], transmits: NOTHING };
        let mut places = Found {
            position: [NOTHING; 3],
            lifted: [NOTHING; 3],
            geometric: [NOTHING; 3],
            frame: [[NOTHING; 3]; 3],
            wo: [NOTHING; 3],
            step: NOTHING,
            front: NOTHING,
        };
        for which in which.chunks(BLOCK) {
            let mut parts = [0; BLOCK];
            for (lane, ray) in which.iter().enumerate() {
                let ray = *ray as usize;
                let [a, b, c, part] = world.triangles[found.primitive[ray] as usize];
                let [first, second, third] = &mut known.corners;
                spread(&world.corners[a as usize], first, lane);
                spread(&world.corners[b as usize], second, lane);
                spread(&world.corners[c as usize], third, lane);
                for k in 0..3 {
                    known.direction[k][lane] = rays.direction[k][ray];
                }
                known.uv[0][lane] = found.u[ray];
                known.uv[1][lane] = found.v[ray];
                known.transmits[lane] = world.parts[part as usize].transmits;
                parts[lane] = part;
            }
            let mut at = 0;
            while at < which.len() {
                find(lanes, &known, &mut places, at);
                at += L::LANES;
            }
            for (lane, part) in parts[..which.len()].iter().enumerate() {
                let part = &world.parts[*part as usize];
                out.push(Hit {
                    position: vector(&places.position, lane),
                    lifted: vector(&places.lifted, lane),
                    geometric: vector(&places.geometric, lane),
                    front: places.front[lane] > 0.0,
                    step: places.step[lane],
                    frame: [
                        vector(&places.frame[0], lane),
                        vector(&places.frame[1], lane),
                        vector(&places.frame[2], lane),
                    ],
                    wo: vector(&places.wo, lane),
                    material: part.material,
                    light: part.light,
                });
            }
        }
    }
}

/// A number of a vertex to each column.
#[inline(always)]
fn spread(Corner(values): &Corner, columns: &mut [Column; 10], lane: usize) {
    let mut k = 0;
    while k < values.len() {
        columns[k][lane] = values[k];
        k += 1;
    }
}

/// How far `wo` stays above the smooth surface, at least: the sine of the angle.
const GRAZING: f32 = 1e-3;

#[inline(always)]
fn find<L: Lanes>(lanes: L, known: &Known, places: &mut Found, at: usize) {
    let zero = lanes.splat(0.0);
    let one = lanes.splat(1.0);
    let [a, b, c] = [&known.corners[0], &known.corners[1], &known.corners[2]];
    let [pa, pb, pc] = [load(lanes, &a[..3], at), load(lanes, &b[..3], at), load(lanes, &c[..3], at)];
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
    let normals = [load(lanes, &a[3..6], at), load(lanes, &b[3..6], at), load(lanes, &c[3..6], at)];
    let mut normal = unit_or(lanes, blend::<L>(normals, weights), geometric);
    let tangents = [load(lanes, &a[6..9], at), load(lanes, &b[6..9], at), load(lanes, &c[6..9], at)];
    let along = blend::<L>(tangents, weights);
    let handedness = one.mul_sign(lanes.load(&a[9][at..]));

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
    let corners = [pa, pb, pc];
    for k in 0..3 {
        let normal = times::<L>(normals[k], side);
        let below = (-product::<L>(less::<L>(position, corners[k]), normal)).max(zero);
        lifted = plus::<L>(lifted, times::<L>(normal, weights[k] * below));
    }

    put(lanes, &mut places.position, at, position);
    put(lanes, &mut places.lifted, at, lifted);
    put(lanes, &mut places.geometric, at, geometric);
    let mut wo = [zero; 3];
    for k in 0..3 {
        put(lanes, &mut places.frame[k], at, frame[k]);
        wo[k] = product::<L>(frame[k], toward);
    }
    put(lanes, &mut places.wo, at, wo);
    lanes.store(&mut places.step[at..], step);
    lanes.store(&mut places.front[at..], front);
}

#[inline(always)]
fn load<L: Lanes>(lanes: L, columns: &[Column], at: usize) -> [L::F; 3] {
    [lanes.load(&columns[0][at..]), lanes.load(&columns[1][at..]), lanes.load(&columns[2][at..])]
}

#[inline(always)]
fn put<L: Lanes>(lanes: L, columns: &mut [Column; 3], at: usize, vector: [L::F; 3]) {
    for k in 0..3 {
        lanes.store(&mut columns[k][at..], vector[k]);
    }
}

#[inline(always)]
fn vector(columns: &[Column; 3], at: usize) -> Vec3 {
    [columns[0][at], columns[1][at], columns[2][at]]
}

#[inline(always)]
fn blend<L: Lanes>([a, b, c]: [[L::F; 3]; 3], [u, v, w]: [L::F; 3]) -> [L::F; 3] {
    plus::<L>(plus::<L>(times::<L>(a, u), times::<L>(b, v)), times::<L>(c, w))
}

#[inline(always)]
fn plus<L: Lanes>(a: [L::F; 3], b: [L::F; 3]) -> [L::F; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn less<L: Lanes>(a: [L::F; 3], b: [L::F; 3]) -> [L::F; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn minus<L: Lanes>(a: [L::F; 3]) -> [L::F; 3] {
    [-a[0], -a[1], -a[2]]
}

#[inline(always)]
fn times<L: Lanes>(a: [L::F; 3], s: L::F) -> [L::F; 3] {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline(always)]
fn product<L: Lanes>(a: [L::F; 3], b: [L::F; 3]) -> L::F {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn across<L: Lanes>(a: [L::F; 3], b: [L::F; 3]) -> [L::F; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn either<L: Lanes>(lanes: L, mask: L::M, a: [L::F; 3], b: [L::F; 3]) -> [L::F; 3] {
    [lanes.select(mask, a[0], b[0]), lanes.select(mask, a[1], b[1]), lanes.select(mask, a[2], b[2])]
}

#[inline(always)]
fn largest<L: Lanes>(a: [L::F; 3]) -> L::F {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

/// The unit vector along `a`, or `other` where it points nowhere.
#[inline(always)]
fn unit_or<L: Lanes>(lanes: L, a: [L::F; 3], other: [L::F; 3]) -> [L::F; 3] {
    // Scaled by the largest component first, so that no square overflows or vanishes.
    let size = largest::<L>(a);
    let sound = lanes.splat(1e-30).lt(size) & size.lt(lanes.splat(1e30));
    let one = lanes.splat(1.0);
    let a = times::<L>(a, one / size);
    either(lanes, sound, times::<L>(a, one / product::<L>(a, a).sqrt()), other)
}

/// A unit vector perpendicular to the unit vector `n`.
#[inline(always)]
fn perpendicular<L: Lanes>(lanes: L, n: [L::F; 3]) -> [L::F; 3] {
    // Crossed with the axis that `n` has least of, so that the product is never short.
    let zero = lanes.splat(0.0);
    let [x, y, z] = [n[0].abs(), n[1].abs(), n[2].abs()];
    let with_y_or_z = either(lanes, y.le(z), [-n[2], zero, n[0]], [n[1], -n[0], zero]);
    let along = either(lanes, x.le(y) & x.le(z), [zero, n[2], -n[1]], with_y_or_z);
    times::<L>(along, lanes.splat(1.0) / product::<L>(along, along).sqrt())
}
