//! 64 rays, with everything that traversal needs, computed once.

use lobe_lane::{Floats, Ints, Lanes, Mask};

use crate::mesh::LIMIT;
use crate::packet::Packet;

/// The number of rays of a block, which is a multiple of every number of lanes.
pub(crate) const RAYS: usize = 64;

/// One float per ray.
pub(crate) type Row = [f32; RAYS];

/// Rays in one space. A *group* is as many neighbouring rays as there are lanes; `at` is always the first ray of a
/// group.
///
/// A box test, which must not miss, takes a plane `x = p` to be reached at `p inverse + near`. It is moved by the ray's
/// *pad* against the ray for the near planes (`near`) and along it for the far planes (`far`). The pad, `2^-20` of the
/// largest magnitude involved, covers what the box test and the triangle test lose to rounding: at most 4 and 8
/// half-units in its last place.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Block {
    pub origin: [Row; 3],
    pub direction: [Row; 3],
    /// `+inf` for a ray that is absent, invalid or already answered.
    pub t_min: Row,
    pub inverse: [Row; 3],
    pub near: [Row; 3],
    pub far: [Row; 3],
    pub pad: Row,
    /// `-x / z`, `-y / z` and `1 / z` of the direction, its axes permuted so that z has the largest magnitude.
    pub shear: [Row; 3],
    /// The origin with its axes permuted in the same way.
    pub pivot: [Row; 3],
    /// Which axis became z.
    pub major: [i32; RAYS],
    /// Bit `a` is the sign of the direction along axis `a`.
    pub octant: [i32; RAYS],
    /// The range to which the t of hits is clamped: where the ray is inside the box of the instance.
    pub enter: Row,
    /// See [`enter`](Block::enter).
    pub leave: Row,
}

impl Block {
    pub fn new() -> Self {
        let (rows, row) = ([[0.0; RAYS]; 3], [0.0; RAYS]);
        Block {
            origin: rows,
            direction: rows,
            t_min: row,
            inverse: rows,
            near: rows,
            far: rows,
            pad: row,
            shear: rows,
            pivot: rows,
            major: [0; RAYS],
            octant: [0; RAYS],
            enter: [f32::NEG_INFINITY; RAYS],
            leave: [f32::INFINITY; RAYS],
        }
    }

    /// Fills in a group. `reach` is the largest magnitude of a coordinate of the traced geometry. Returns the mask of
    /// valid rays.
    #[inline(always)]
    pub fn prepare<L: Lanes>(&mut self, lanes: L, at: usize, packet: Packet<L>, live: L::M, reach: f32) -> L::M {
        let at = first_ray::<L>(at);
        let Packet { origin: [o_x, o_y, o_z], direction: [d_x, d_y, d_z], t_min, t_max } = packet;
        let (a_x, a_y, a_z) = (d_x.abs(), d_y.abs(), d_z.abs());
        let limit = lanes.splat(LIMIT);
        let is_x = a_x.ge(a_y) & a_x.ge(a_z);
        let is_y = !is_x & a_y.ge(a_z);
        let largest = lanes.select(is_x, a_x, lanes.select(is_y, a_y, a_z));
        // Written so that NaN fails.
        let within = a_x.le(limit) & a_y.le(limit) & a_z.le(limit) & largest.ge(lanes.splat(1.0 / LIMIT));
        let near_enough = o_x.abs().le(limit) & o_y.abs().le(limit) & o_z.abs().le(limit);
        let valid = live & within & near_enough & t_min.le(t_max);

        // Dead rays get harmless numbers, so that everything computed from them stays finite.
        let origin = [o_x.masked(valid), o_y.masked(valid), o_z.masked(valid)];
        let direction = [d_x.masked(valid), d_y.masked(valid), lanes.select(valid, d_z, lanes.splat(1.0))];
        let [o_x, o_y, o_z] = origin;
        let (is_x, is_y) = (is_x & valid, is_y & valid);
        let size = o_x.abs().max(o_y.abs()).max(o_z.abs()) + lanes.splat(reach);
        let pad = size * lanes.splat(1.0 / 1_048_576.0);
        // A tiny component has no finite inverse. Across the whole scene this replacement moves the ray by less than
        // the pad.
        let floor = lanes.select(valid, largest, lanes.splat(1.0)) * lanes.splat(1.0 / 1_073_741_824.0);
        let mut octant = lanes.splat_int(0);
        let mut inverses = origin;
        let mut axis = 0;
        while axis < 3 {
            let (o, d) = (origin[axis], direction[axis]);
            let steep = lanes.select(d.abs().lt(floor), floor.mul_sign(d), d);
            let inverse = lanes.splat(1.0) / steep;
            inverses[axis] = inverse;
            let shift = pad.mul_sign(d);
            lanes.store(&mut self.origin[axis][at..], o);
            lanes.store(&mut self.direction[axis][at..], d);
            lanes.store(&mut self.inverse[axis][at..], inverse);
            lanes.store(&mut self.near[axis][at..], -((o + shift) * inverse));
            lanes.store(&mut self.far[axis][at..], -((o - shift) * inverse));
            let sign = d.bits().shr::<31>();
            octant = octant | (sign * lanes.splat_int(1 << axis));
            axis += 1;
        }
        let [x, y, _] = turned(lanes, is_x, is_y, direction);
        let [.., inverse] = turned(lanes, is_x, is_y, inverses);
        lanes.store(&mut self.shear[0][at..], -(x * inverse));
        lanes.store(&mut self.shear[1][at..], -(y * inverse));
        lanes.store(&mut self.shear[2][at..], inverse);
        let [x, y, z] = turned(lanes, is_x, is_y, origin);
        lanes.store(&mut self.pivot[0][at..], x);
        lanes.store(&mut self.pivot[1][at..], y);
        lanes.store(&mut self.pivot[2][at..], z);
        let major = lanes.select_int(is_x, lanes.splat_int(0), lanes.splat_int(2));
        lanes.store_int(&mut self.major[at..], lanes.select_int(is_y, lanes.splat_int(1), major));
        lanes.store_int(&mut self.octant[at..], octant);
        lanes.store(&mut self.pad[at..], pad);
        lanes.store(&mut self.t_min[at..], lanes.select(valid, t_min, lanes.splat(f32::INFINITY)));
        valid
    }

    /// The octant of a ray.
    #[inline(always)]
    pub fn octant(&self, ray: usize) -> usize {
        self.octant[ray & (RAYS - 1)] as usize & 7
    }

    /// `true` if all live rays of the group that begins at `at` point into one octant.
    #[inline(always)]
    pub fn group_is_coherent<L: Lanes>(&self, lanes: L, at: usize, live: L::M) -> bool {
        lanes.uniform(lanes.load_int(&self.octant[first_ray::<L>(at)..]), live).0
    }

    /// The rays of `live` that point into an octant and begin at `t >= 0`.
    #[inline(always)]
    pub fn of_octant<L: Lanes>(&self, lanes: L, octant: usize, live: u64) -> u64 {
        let octant = lanes.splat_int(octant as i32);
        let mut same = 0;
        let mut at = 0;
        while at < RAYS {
            let forward = lanes.load(&self.t_min[at..]).ge(lanes.splat(0.0));
            same |= ((lanes.load_int(&self.octant[at..]).eq(octant) & forward).bits() as u64) << at;
            at += L::LANES;
        }
        same & live
    }
}

/// Coordinates with the axes permuted so that z is the major one.
#[inline(always)]
fn turned<L: Lanes>(lanes: L, is_x: L::M, is_y: L::M, [x, y, z]: [L::F; 3]) -> [L::F; 3] {
    [
        lanes.select(is_x, y, lanes.select(is_y, z, x)),
        lanes.select(is_x, z, lanes.select(is_y, x, y)),
        lanes.select(is_x, x, lanes.select(is_y, y, z)),
    ]
}

/// Returns `at`; the compiler learns that a whole group follows it.
#[inline(always)]
pub(crate) fn first_ray<L: Lanes>(at: usize) -> usize {
    at & (RAYS - L::LANES)
}

/// Three rows of a group, one ray per lane.
#[inline(always)]
pub(crate) fn group_rows<L: Lanes>(lanes: L, rows: &[Row; 3], at: usize) -> [L::F; 3] {
    let at = first_ray::<L>(at);
    [lanes.load(&rows[0][at..]), lanes.load(&rows[1][at..]), lanes.load(&rows[2][at..])]
}

/// Three rows of one ray, in all lanes.
#[inline(always)]
pub(crate) fn ray_rows<L: Lanes>(lanes: L, rows: &[Row; 3], ray: usize) -> [L::F; 3] {
    let ray = ray & (RAYS - 1);
    [lanes.splat(rows[0][ray]), lanes.splat(rows[1][ray]), lanes.splat(rows[2][ray])]
}

/// The bits of the group that begins at ray `at`.
#[inline(always)]
pub(crate) fn group_bits<L: Lanes>(live: u64, at: usize) -> u32 {
    (live >> (at & (RAYS - 1))) as u32 & ((1u32 << L::LANES) - 1)
}

/// The mask with the lanes of these bits set.
#[inline(always)]
pub(crate) fn mask_of<L: Lanes>(lanes: L, bits: u32) -> L::M {
    const POWERS: [i32; 16] = {
        let mut powers = [0; 16];
        let mut lane = 0;
        while lane < 16 {
            powers[lane] = 1 << lane;
            lane += 1;
        }
        powers
    };
    let powers = lanes.load_int(&POWERS);
    (lanes.splat_int(bits as i32) & powers).eq(powers)
}

/// The hits found for 64 rays.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Found {
    /// The nearest t so far; before the first hit, the end of the ray. `-inf` after a hit if any hit is enough.
    pub t: Row,
    /// As bits, because rows of integers are written whole: for floats selected by a mask, compilers emit masked
    /// stores, which take 40 steps on some processors.
    pub u: [i32; RAYS],
    /// As bits.
    pub v: [i32; RAYS],
    /// [`Found::NONE`] if nothing has been hit.
    pub primitive: [i32; RAYS],
    pub instance: [i32; RAYS],
}

impl Found {
    /// Above every number of a triangle, so that a first hit at the very end of the interval wins the tie.
    pub const NONE: i32 = i32::MAX;

    pub fn new() -> Self {
        let none = [Self::NONE; RAYS];
        Found { t: [0.0; RAYS], u: [0; RAYS], v: [0; RAYS], primitive: none, instance: none }
    }

    /// Forgets the hits of a group and sets its end.
    #[inline(always)]
    pub fn reset<L: Lanes>(&mut self, lanes: L, at: usize, t_max: L::F) {
        let at = first_ray::<L>(at);
        let (zero, none) = (lanes.splat_int(0), lanes.splat_int(Self::NONE));
        lanes.store(&mut self.t[at..], t_max);
        lanes.store_int(&mut self.u[at..], zero);
        lanes.store_int(&mut self.v[at..], zero);
        lanes.store_int(&mut self.primitive[at..], none);
        lanes.store_int(&mut self.instance[at..], none);
    }
}
