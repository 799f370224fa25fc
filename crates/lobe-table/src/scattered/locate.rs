//! From places in the plane to the samples with weights there, in SIMD lanes.
//!
//! [Squares](super::cells) lead to a [region](super::regions) that is the right one or close to it, and a walk
//! continues from there: as long as a place is behind a side of its region, the region on the other side is next. In a
//! Delaunay triangulation, such a walk has no cycles, and a side counts only if a place is farther behind it than
//! rounding could put it.

use lobe_lane::{Block, Floats, Ints, Kernel, Lanes, Mask};
use lobe_memory::Storage;

use super::cells::{self, DIVIDED, PARTS, REACH, SQUARES};
use super::mesh::Mesh;
use super::regions::{Region, regions};
use crate::passes::block::{Column, registers};

/// Floats per region: for each side, the coefficients of `x`, `y` and 1, and the bits of the next region; then the
/// factors that turn the first two into weights, and 1 if the region is too narrow for single precision.
const REGION: usize = 16;
/// Floats of a region's corners; the last is not used.
const CORNERS: usize = 4;
/// The distance behind a side at which a place still counts as inside, in radians: more than rounding may cause.
const SLACK: f32 = 1e-6;
/// The number of steps after which a walk is left to double precision.
const STEPS: usize = 48;

/// Several meshes, laid out for lookup in lanes.
#[derive(Clone, Debug)]
pub(super) struct Meshes {
    /// The bits of regions, or of the positions of the parts of a divided square.
    squares: Storage<f32>,
    regions: Storage<f32>,
    corners: Storage<f32>,
}

/// Collects the meshes.
#[derive(Default)]
pub(super) struct Builder {
    squares: Vec<u32>,
    regions: Vec<f32>,
    corners: Vec<f32>,
}

impl Builder {
    /// Adds a mesh; `place` gives the number under which each of its points is known. Returns the start of its squares;
    /// `None` if lanes cannot look it up.
    pub(super) fn add(&mut self, mesh: &Mesh, place: impl Fn(usize) -> usize) -> Option<i32> {
        let regions = regions(mesh)?;
        let first = self.regions.len() / REGION;
        // Positions among floats must fit into the indices of lanes.
        i32::try_from((first + regions.len()).checked_mul(REGION)?).ok()?;
        let root = cells::lay_out(&regions, first, &mut self.squares)?;
        for Region { inside, next, corners, scale, is_narrow } in &regions {
            for ([x, y, one], next) in inside.iter().zip(next) {
                self.regions.extend([*x as f32, *y as f32, *one as f32, index_bits(first + next)?]);
            }
            self.regions.extend([scale[0] as f32, scale[1] as f32, f32::from(u8::from(*is_narrow)), 0.0]);
            for corner in corners {
                self.corners.push(index_bits(place(*corner))?);
            }
            self.corners.push(0.0);
        }
        i32::try_from(root).ok()
    }

    pub(super) fn finish(self) -> Meshes {
        let squares: Vec<f32> = self.squares.into_iter().map(f32::from_bits).collect();
        Meshes {
            squares: Storage::copied(&squares),
            regions: Storage::copied(&self.regions),
            corners: Storage::copied(&self.corners),
        }
    }
}

/// An index as the bits of a float that is not NaN, because a processor need not preserve the bits of a NaN.
pub(super) fn index_bits(index: usize) -> Option<f32> {
    (index < f32::INFINITY.to_bits() as usize).then(|| f32::from_bits(index as u32))
}

impl Meshes {
    pub(super) fn bytes(&self) -> usize {
        self.squares.bytes() + self.regions.bytes() + self.corners.bytes()
    }
}

/// The places of queries, and the results there.
pub(super) struct Located {
    /// The places, and the mesh of each, given by the start of its squares.
    pub(super) at: [Column; 2],
    pub(super) mesh: Column<i32>,
    /// The numbers of the three points with weights, and the weights, which add up to 1.
    pub(super) corners: [Column<i32>; 3],
    pub(super) weights: [Column; 3],
    /// -1 if double precision is needed; earlier values are kept.
    pub(super) is_hard: Column<i32>,
    region: Column<i32>,
}

impl Located {
    pub(super) const ZERO: Self = Located {
        at: [Column::<f32>::ZERO; 2],
        mesh: Column::<i32>::ZERO,
        corners: [Column::<i32>::ZERO; 3],
        weights: [Column::<f32>::ZERO; 3],
        is_hard: Column::<i32>::ZERO,
        region: Column::<i32>::ZERO,
    };
}

/// Looks up the places of queries `0..n`; compiled once for lights and viewers.
pub(super) struct Locate<'a> {
    pub(super) meshes: &'a Meshes,
    pub(super) n: usize,
    pub(super) located: &'a mut Located,
}

impl Kernel for Locate<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Locate { meshes, n, located } = self;
        let n = registers(lanes, n);
        start(lanes, n, meshes, located);
        walk(lanes, n, meshes, located);
    }
}

/// The region to start from.
#[inline(always)]
fn start<L: Lanes>(lanes: L, n: usize, meshes: &Meshes, Located { at: [x, y], mesh, region, .. }: &mut Located) {
    let squares = meshes.squares.as_slice();
    let (zero, scale) = (lanes.splat(0.0), lanes.splat((SQUARES as f64 / (2.0 * REACH)) as f32));
    let (middle, last) = (lanes.splat(SQUARES as f32 / 2.0), lanes.splat(SQUARES as f32 * (1.0 - f32::EPSILON)));
    let (parts, last_part) = (lanes.splat(PARTS as f32), lanes.splat_int(PARTS as i32 - 1));
    let divided = lanes.splat_int(DIVIDED as i32);
    let mut query = 0;
    while query < n {
        let mut u = lanes.mul_add(x.load(lanes, query), scale, middle).max(zero).min(last);
        let mut v = lanes.mul_add(y.load(lanes, query), scale, middle).max(zero).min(last);
        let (column, row) = (u.to_int(), v.to_int());
        (u, v) = (u - column.to_float(), v - row.to_float());
        let index = mesh.load(lanes, query) + row * lanes.splat_int(SQUARES as i32) + column;
        let mut entry = lanes.gather(squares, index).bits();
        loop {
            let is_whole = entry.lt(divided);
            if is_whole.all() {
                break;
            }
            (u, v) = (u * parts, v * parts);
            let (column, row) = (u.to_int().min(last_part), v.to_int().min(last_part));
            (u, v) = (u - column.to_float(), v - row.to_float());
            let index = entry - divided + row * lanes.splat_int(PARTS as i32) + column;
            entry = lanes.select_int(is_whole, entry, lanes.gather(squares, index).bits());
        }
        region.store(lanes, query, entry);
        query += L::LANES;
    }
}

/// Walks from there to the region of each place, and finds the weights of its corners.
#[inline(always)]
fn walk<L: Lanes>(lanes: L, n: usize, meshes: &Meshes, located: &mut Located) {
    let Located { at: [x, y], corners, weights, is_hard, region: regions, .. } = located;
    let sides = Block::<3, 4>::new(meshes.regions.as_slice(), [0, 4, 8]);
    let scales = Block::<1, 4>::new(meshes.regions.as_slice(), [12]);
    let ends = Block::<1, 4>::new(meshes.corners.as_slice(), [0]);
    let (zero, one, slack) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(-SLACK));
    let mut query = 0;
    while query < n {
        let (x, y) = (x.load(lanes, query), y.load(lanes, query));
        let mut region = regions.load(lanes, query);
        let mut inside = [zero; 3];
        let mut step = 0;
        let is_walking = loop {
            let sides = lanes.gather_quads(&sides, region.shl::<4>());
            let mut side = 0;
            while side < 3 {
                let [a, b, c, _] = sides[side];
                inside[side] = lanes.mul_add(a, x, lanes.mul_add(b, y, c));
                side += 1;
            }
            // Continues through the side that the place is farthest behind.
            let [first, second, third] = inside;
            let least = first.min(second).min(third);
            let next = lanes.select(second.le(least), sides[1][3], sides[2][3]);
            let next = lanes.select(first.le(least), sides[0][3], next).bits();
            let goes = least.lt(slack) & !next.eq(region);
            if !goes.any() || step == STEPS {
                break goes;
            }
            region = lanes.select_int(goes, next, region);
            step += 1;
        };
        let [[first, second, is_narrow, _]] = lanes.gather_quads(&scales, region.shl::<4>());
        let hard = is_walking | zero.lt(is_narrow);
        let none = is_hard.load(lanes, query);
        is_hard.store(lanes, query, lanes.select_int(hard, lanes.splat_int(-1), none));
        let [[a, b, c, _]] = lanes.gather_quads(&ends, region.shl::<2>());
        corners[0].store(lanes, query, a.bits());
        corners[1].store(lanes, query, b.bits());
        corners[2].store(lanes, query, c.bits());
        let second_corner = (inside[0] * first).max(zero).min(one);
        let rest = one - second_corner;
        let third_corner = (inside[1] * second).max(zero).min(rest);
        weights[0].store(lanes, query, rest - third_corner);
        weights[1].store(lanes, query, second_corner);
        weights[2].store(lanes, query, third_corner);
        query += L::LANES;
    }
}

const _: () = assert!(REGION == 1 << 4 && CORNERS == 1 << 2);
