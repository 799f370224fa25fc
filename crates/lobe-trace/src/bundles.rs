//! Eight rays of one octant tested as one; large packets of 64 rays test inner nodes in this way.

use lobe_lane::{Block as Pattern, Floats, Ints, Lanes, MAX_LANES, Mask};

use crate::block::{Block, Found, RAYS, Row, first_ray, group_bits, mask_of};
use crate::hull::Edges;
use crate::mesh::LIMIT;
use crate::slab::least_lane;

/// The number of rays of a bundle.
const RAYS_EACH: usize = 8;

/// The number of bundles of a block.
const BUNDLES: usize = RAYS / RAYS_EACH;

/// One float per bundle; the rest is padding for the widest lanes.
type Line = [f32; MAX_LANES];

/// The hulls of the bundles of a block; see [`Edges`].
pub(crate) struct Bundles {
    slow: [Line; 3],
    near: [Line; 3],
    fast: [Line; 3],
    far: [Line; 3],
    /// No ray of any bundle begins before it.
    t_min: f32,
    /// The t at which the last ray of each bundle currently ends.
    end: Line,
    /// The largest distance between rays of a bundle at `t`, along the axis on which they are farthest apart: `spread +
    /// t fan`.
    spread: Line,
    fan: Line,
    /// The rays of all bundles.
    live: u64,
}

impl Bundles {
    /// The rays of `live`, all of one octant.
    #[inline(always)]
    pub fn around<L: Lanes>(lanes: L, rays: &Block, found: &Found, octant: usize, live: u64) -> Self {
        let row = [0.0; MAX_LANES];
        let mut bundles = Bundles {
            slow: [row; 3],
            near: [row; 3],
            fast: [row; 3],
            far: [row; 3],
            t_min: 0.0,
            end: [f32::NEG_INFINITY; MAX_LANES],
            spread: row,
            fan: row,
            live,
        };
        let mut bits = [0; MAX_LANES];
        let mut bundle = 0;
        while bundle < BUNDLES {
            bits[bundle] = (live >> (bundle * RAYS_EACH)) as i32 & ((1 << RAYS_EACH) - 1);
            bundle += 1;
        }
        let (mut t_min, mut pad) = (lanes.splat(f32::INFINITY), lanes.splat(0.0));
        let mut at = 0;
        while at < RAYS {
            t_min = t_min.min(lanes.load(&rays.t_min[at..]));
            pad = pad.max(lanes.load(&rays.pad[at..]));
            at += L::LANES;
        }
        bundles.t_min = least_lane(lanes, t_min.max(lanes.splat(0.0)));
        let pad = lanes.splat(-least_lane(lanes, -pad));
        bundles.shorten(lanes, found, live);
        let mut first = 0;
        while first < BUNDLES {
            let bits = lanes.load_int(&bits[first..]);
            let end = lanes.load(&bundles.end[first..]);
            let ending = end.le(lanes.splat(LIMIT)) & end.gt(lanes.splat(0.0));
            let (mut spread, mut fan) = (lanes.splat(0.0), lanes.splat(f32::NEG_INFINITY));
            let mut axis = 0;
            while axis < 3 {
                let [low, high] = extremes(lanes, &rays.origin[axis], first, bits);
                let [least, greatest] = extremes(lanes, &rays.inverse[axis], first, bits);
                let mut inverses = [greatest, least];
                if ending.any() {
                    // Between where rays begin and where all have ended, their greatest coordinate is never above the
                    // line from the greatest at one end to the greatest at the other, and likewise for the least.
                    let ends = extremes(lanes, &end_points(lanes, rays, axis, &bundles.end), first, bits);
                    let lower = (end / (ends[0] - low)).max(least).min(greatest);
                    let upper = (end / (ends[1] - high)).max(least).min(greatest);
                    inverses = [lanes.select(ending, lower, greatest), lanes.select(ending, upper, least)];
                }
                // These are NaN for a bundle without rays, which is never tested.
                let edges = Edges::<L>::new(octant >> axis & 1 != 0, [low, high], inverses, pad);
                let one = lanes.splat(1.0);
                spread = spread.max(high - low);
                fan = fan.max(one / inverses[1] - one / inverses[0]);
                lanes.store(&mut bundles.slow[axis][first..], edges.slow);
                lanes.store(&mut bundles.near[axis][first..], edges.near);
                lanes.store(&mut bundles.fast[axis][first..], edges.fast);
                lanes.store(&mut bundles.far[axis][first..], edges.far);
                axis += 1;
            }
            lanes.store(&mut bundles.spread[first..], spread);
            lanes.store(&mut bundles.fan[first..], fan);
            first += L::LANES;
        }
        bundles
    }

    /// One bit for each bundle that has rays.
    #[inline(always)]
    pub fn all(&self) -> u32 {
        let mut all = 0;
        let mut bundle = 0;
        while bundle < BUNDLES {
            all |= u32::from(self.live >> (bundle * RAYS_EACH) & ((1 << RAYS_EACH) - 1) != 0) << bundle;
            bundle += 1;
        }
        all
    }

    /// The rays of bundles.
    #[inline(always)]
    pub fn rays(&self, bundles: u32) -> u64 {
        // Bit `b` goes to byte `b`, and from there to all bits of the byte.
        let spread = (bundles as u64 * 0x0101_0101_0101_0101) & 0x8040_2010_0804_0201;
        let high = (spread + 0x7f7f_7f7f_7f7f_7f7f) >> 7 & 0x0101_0101_0101_0101;
        (high * 0xff) & self.live
    }

    /// The bundles that contain any of these rays.
    #[inline(always)]
    pub fn of_rays(&self, rays: u64) -> u32 {
        let low = 0x7f7f_7f7f_7f7f_7f7f;
        let high = (((rays & low) + low) | rays) & !low;
        ((high >> 7).wrapping_mul(0x0102_0408_1020_4080) >> 56) as u32
    }

    /// The bundle of a ray.
    #[inline(always)]
    pub fn of(ray: usize) -> usize {
        (ray / RAYS_EACH) & (BUNDLES - 1)
    }

    /// One box per lane: the t before which no ray of the bundle is inside the box, and the t after which none is
    /// inside or still searching.
    #[inline(always)]
    pub fn interval<L: Lanes>(&self, lanes: L, bundle: usize, near: [L::F; 3], far: [L::F; 3]) -> [L::F; 2] {
        let bundle = bundle & (BUNDLES - 1);
        let mut enter = lanes.splat(self.t_min);
        let mut leave = lanes.splat(self.end[bundle]);
        let mut axis = 0;
        while axis < 3 {
            let [slow, fast] = [lanes.splat(self.slow[axis][bundle]), lanes.splat(self.fast[axis][bundle])];
            enter = enter.max(lanes.mul_add(near[axis], slow, lanes.splat(self.near[axis][bundle])));
            leave = leave.min(lanes.mul_add(far[axis], fast, lanes.splat(self.far[axis][bundle])));
            axis += 1;
        }
        [enter, leave]
    }

    /// The largest distance between rays of a bundle at `t`.
    #[inline(always)]
    pub fn width<L: Lanes>(&self, lanes: L, bundle: usize, t: L::F) -> L::F {
        let bundle = bundle & (BUNDLES - 1);
        lanes.mul_add(t, lanes.splat(self.fan[bundle]), lanes.splat(self.spread[bundle]))
    }

    /// The bundles of `bundles` with rays that search as far as `t`.
    #[inline(always)]
    pub fn looking<L: Lanes>(&self, lanes: L, bundles: u32, t: f32) -> u32 {
        let mut bits = 0;
        let mut first = 0;
        while first < BUNDLES {
            bits |= lanes.splat(t).le(lanes.load(&self.end[first..])).bits() << first;
            first += L::LANES;
        }
        bits & bundles
    }

    /// Updates the ends of the bundles of some rays.
    #[inline(always)]
    pub fn shorten<L: Lanes>(&mut self, lanes: L, found: &Found, some: u64) {
        let mut left = some;
        while left != 0 {
            let bundle = Self::of(left.trailing_zeros() as usize);
            let all = ((1 << RAYS_EACH) - 1) << (bundle * RAYS_EACH);
            left &= !all;
            let rays = self.live & all;
            let mut most = lanes.splat(f32::NEG_INFINITY);
            let mut at = bundle * RAYS_EACH;
            while at < (bundle + 1) * RAYS_EACH {
                let group = first_ray::<L>(at);
                let there = mask_of(lanes, group_bits::<L>(rays, group));
                most = most.max(lanes.select(there, lanes.load(&found.t[group..]), lanes.splat(f32::NEG_INFINITY)));
                at += L::LANES;
            }
            self.end[bundle] = -least_lane(lanes, -most);
        }
    }
}

/// The least and the greatest number of the bundles from `first` on, one bundle per lane, over the rays whose bits are
/// set.
#[inline(always)]
fn extremes<L: Lanes>(lanes: L, row: &Row, first: usize, bits: L::I) -> [L::F; 2] {
    let (most, least) = (lanes.splat(f32::INFINITY), lanes.splat(f32::NEG_INFINITY));
    let base = (lanes.iota() + lanes.splat_int(first as i32)) * lanes.splat_int(RAYS_EACH as i32);
    let columns = lanes.gather_quads(&Pattern::new(row, [0, 4]), base);
    let (mut low, mut high) = (most, least);
    let mut ray = 0;
    while ray < RAYS_EACH {
        let bit = lanes.splat_int(1 << ray);
        let there = (bits & bit).eq(bit);
        let x = columns[ray / 4][ray % 4];
        low = low.min(lanes.select(there, x, most));
        high = high.max(lanes.select(there, x, least));
        ray += 1;
    }
    [low, high]
}

/// The positions of rays along an axis when the last ray of their bundle ends.
#[inline(always)]
fn end_points<L: Lanes>(lanes: L, rays: &Block, axis: usize, ends: &Line) -> Row {
    let mut points = [0.0; RAYS];
    let mut at = 0;
    while at < RAYS {
        // Many lanes hold rays of several bundles.
        let end = if L::LANES <= RAYS_EACH {
            lanes.splat(ends[at / RAYS_EACH])
        } else {
            lanes.gather(ends, (lanes.iota() + lanes.splat_int(at as i32)).shr::<{ RAYS_EACH.ilog2() as i32 }>())
        };
        let [origin, direction] = [lanes.load(&rays.origin[axis][at..]), lanes.load(&rays.direction[axis][at..])];
        lanes.store(&mut points[at..], lanes.mul_add(direction, end, origin));
        at += L::LANES;
    }
    points
}
