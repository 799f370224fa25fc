//! One query at a time, with SIMD inside the query.
//!
//! The arithmetic is that of the passes, operation by operation, so the results are the same bits; only its arrangement
//! differs. There is no other query to hide latency behind: two angles share a register, a cell is found by comparing
//! with eight knots at once, and texels are loaded whole.

use std::f32::consts::TAU;

use lobe_lane::{Block, Floats, Kernel, Lanes};

use crate::Scatter;
use crate::axis::{Axis, Bounds, Search};
use crate::layout::{Corners, PHI, PSI, SIGMA, THETA};
use crate::passes::frame::{FARTHEST, POLE, Refracted, Zenith};
use crate::table::Table;

/// One query.
pub(crate) struct Single<'a> {
    pub(crate) table: &'a Table,
    pub(crate) wi: [f32; 3],
    pub(crate) wo: [f32; 3],
    pub(crate) out: &'a mut [f32],
}

impl Kernel for Single<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Single { table, wi, wo, out } = self;
        let (angles, above) = angles(lanes, table, wi, wo);
        let strides = table.layout.strides();
        let find = |index: usize| {
            let (cell, fraction, contained) = table.axes[index].cell_one(lanes, angles[index]);
            (cell.wrapping_mul(strides[index] as u32), fraction, contained)
        };
        let (at_sigma, sigma, in_sigma) = find(SIGMA);
        let (at_theta, theta, in_theta) = find(THETA);
        let (at_phi, phi, in_phi) = find(PHI);
        let (at_psi, psi, in_psi) = if table.is_anisotropic() { find(PSI) } else { (0, 0.0, true) };
        let base = at_sigma.wrapping_add(at_psi).wrapping_add(at_theta).wrapping_add(at_phi);
        let valid = above & in_sigma & in_psi & in_theta & in_phi;
        let (at, floor) = (base as usize, table.floor());
        match table.layout.corners() {
            Corners::RgbIso(block) => rgb(lanes, &block, at, (weights([sigma, theta], valid), phi), floor, out),
            Corners::RgbAniso(block) => rgb(lanes, &block, at, (weights([sigma, psi, theta], valid), phi), floor, out),
            Corners::MonoIso(block) => mono(lanes, &block, at, weights::<3, 8>([sigma, theta, phi], valid), floor, out),
            Corners::MonoAniso(block) => {
                mono(lanes, &block, at, weights::<4, 16>([sigma, psi, theta, phi], valid), floor, out);
            }
            Corners::WideIso(block) => wide(lanes, &block, at, weights([sigma, theta, phi], valid), floor, out),
            Corners::WideAniso(block) => wide(lanes, &block, at, weights([sigma, psi, theta, phi], valid), floor, out),
        }
    }
}

/// Sigma, psi, theta and phi in radians, and whether both directions are finite and above the horizon: the first two
/// passes for one query.
#[inline(always)]
fn angles<L: Lanes>(lanes: L, table: &Table, wi: [f32; 3], wo: [f32; 3]) -> ([f32; 4], bool) {
    let fma = |a, b, c| lanes.scalar_mul_add(a, b, c);
    let ([ix, iy, mut iz], [ox, oy, mut oz]) = (wi, wo);
    if table.scatter() == Scatter::Transmission {
        (iz, oz) = (iz.abs(), oz.abs());
    }
    let sin2 = fma(ix, ix, iy * iy);
    let sin = sin2.sqrt();
    let scale = if POLE < sin2 { 1.0 / sin } else { 0.0 };
    let (cos_psi, sin_psi) = (if POLE < sin2 { ix * scale } else { 1.0 }, iy * scale);
    let ([ax, ay, cos_zenith], sin_zenith) = match &table.refraction {
        None => ([ix, iy, iz], sin),
        Some(offset) => {
            let [wi, psi] = [[ix, iy, iz], [cos_psi, sin_psi, 0.0]].map(|v| v.map(|x| lanes.splat(x)));
            let (opposite, sin) = Refracted(offset).opposite(lanes, wi, lanes.splat(sin), [psi[0], psi[1]]);
            (opposite.map(|x| lanes.extract(x, 0)), lanes.extract(sin, 0))
        }
    };
    let (dx, dy, dz) = (ox + ax, oy + ay, oz - cos_zenith);
    let toward = fma(cos_psi, dx, sin_psi * dy);
    let y = fma(cos_psi, dy, -(sin_psi * dx));
    let x = fma(cos_zenith, toward, sin_zenith * dz);
    let distance2 = fma(dx, dx, fma(dy, dy, dz * dz));
    let valid = 0.0 < iz && 0.0 < oz && distance2 + sin2 < FARTHEST;

    let across2 = fma(x, x, y * y);
    let one = lanes.splat(1.0);
    let [sigma, theta] = two(lanes, [[iz, sin2], [1.0 - 0.5 * distance2, across2]], |[cos, sin2]| {
        lobe_math::acos_from(lanes, cos, sin2 / (one + cos.abs()))
    });
    if table.is_anisotropic() {
        let arguments = [[sin_psi, cos_psi, 1.0], [y, x, across2.sqrt()]];
        let [psi, phi] = two(lanes, arguments, |[y, x, length]| lobe_math::azimuth_from(lanes, y, x, length));
        ([sigma, psi, theta, phi], valid)
    } else {
        let phi = lobe_math::azimuth(lanes, lanes.splat(y), lanes.splat(x));
        ([sigma, 0.0, theta, lanes.extract(phi, 0)], valid)
    }
}

/// A function of `N` floats at two points, in one register where it has room for both.
#[inline(always)]
fn two<L: Lanes, const N: usize>(lanes: L, points: [[f32; N]; 2], f: impl Fn([L::F; N]) -> L::F) -> [f32; 2] {
    let [a, b] = points;
    if L::LANES == 1 {
        return [a, b].map(|point| lanes.extract(f(point.map(|x| lanes.splat(x))), 0));
    }
    let mut packed = [lanes.splat(0.0); N];
    let mut k = 0;
    while k < N {
        packed[k] = lanes.first_two(a[k], b[k]);
        k += 1;
    }
    let values = f(packed);
    [lanes.extract(values, 0), lanes.extract(values, 1)]
}

impl Axis {
    /// The cell of one angle and how far into it, and whether the table has a value there.
    #[inline(always)]
    fn cell_one<L: Lanes>(&self, lanes: L, x: f32) -> (u32, f32, bool) {
        let Bounds { turn_below, clamp: [low, high], inside } = self.bounds;
        let contained = inside[0] <= x && x <= inside[1];
        let x = x + if x < turn_below { TAU } else { 0.0 };
        // Written out as lanes compare, so that NaN goes the same way.
        let x = if x > low { x } else { low };
        let x = if x < high { x } else { high };
        let (cell, fraction) = self.find_one(lanes, x);
        (cell, fraction, contained)
    }

    /// As [`Find::find`](crate::search::Find), for one angle.
    #[inline(always)]
    fn find_one<L: Lanes>(&self, lanes: L, x: f32) -> (u32, f32) {
        let cell = match self.search() {
            Search::Registers(registers) => {
                let octs = |from: usize| lanes.oct_load(&registers.sorted[from..][..8]);
                let mut count = lanes.oct_count_le(octs(0), x);
                if registers.levels > 3 {
                    count += lanes.oct_count_le(octs(8), x);
                    if registers.levels > 4 {
                        count += lanes.oct_count_le(octs(16), x) + lanes.oct_count_le(octs(24), x);
                    }
                }
                count
            }
            Search::Constant => return (0, 0.0),
            Search::Uniform { cells_per_radian } => {
                let position = (x - self.first()) * cells_per_radian;
                let cell = (position as i32).min(self.cells().len() as i32 - 1).max(0);
                return (cell as u32, position - cell as f32);
            }
            Search::Guide { buckets_per_radian, buckets, steps } => {
                let bucket = ((x - self.first()) * buckets_per_radian) as i32;
                let [start, knot] = buckets[bucket.min(buckets.len() as i32 - 1).max(0) as usize];
                let inner = &self.knots()[1..self.knots().len() - 1];
                let mut cell = start as usize + (knot <= x) as usize;
                for _ in 1..*steps {
                    cell += inner.get(cell).is_some_and(|&knot| knot <= x) as usize;
                }
                cell as u32
            }
        };
        let [first, inverse] = self.cells()[cell as usize];
        (cell, (x - first) * inverse)
    }
}

/// The weight of each corner over the axes whose fractions are given, the last axis fastest; 0 where not `valid`.
#[inline(always)]
fn weights<const AXES: usize, const CORNERS: usize>(fractions: [f32; AXES], valid: bool) -> [f32; CORNERS] {
    let mut products = [1.0; CORNERS];
    for (axis, upper) in fractions.into_iter().enumerate() {
        for corner in (0..1 << axis).rev() {
            let product = products[corner];
            products[2 * corner] = product * (1.0 - upper);
            products[2 * corner + 1] = product * upper;
        }
    }
    if valid { products } else { [0.0; CORNERS] }
}

#[inline(always)]
fn rgb<L: Lanes, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CORNERS, 8>,
    base: usize,
    (weights, phi): ([f32; CORNERS], f32),
    floor: f32,
    out: &mut [f32],
) {
    let [low, high] = lanes.oct_halves(blend(lanes, block, base, weights));
    let texel = lanes.quad_mul_add(lanes.quad_splat(phi), high - low, low);
    let mut four = [0.0; 4];
    lanes.quad_store(&mut four, lanes.quad_max(texel, lanes.quad_splat(floor)));
    let [r, g, b, _] = four;
    match out {
        [red, green, blue] => (*red, *green, *blue) = (r, g, b),
        _ => out.copy_from_slice(&[r, g]),
    }
}

#[inline(always)]
fn wide<L: Lanes, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CORNERS, 8>,
    base: usize,
    weights: [f32; CORNERS],
    floor: f32,
    out: &mut [f32],
) {
    for (chunk, target) in out.chunks_mut(8).enumerate() {
        let sum = lanes.oct_max(blend(lanes, block, base + 8 * chunk, weights), lanes.oct_splat(floor));
        let mut whole = [0.0; 8];
        lanes.oct_store(&mut whole, sum);
        target.copy_from_slice(&whole[..target.len()]);
    }
}

/// The weighted sum of the corners.
#[inline(always)]
fn blend<L: Lanes, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CORNERS, 8>,
    base: usize,
    weights: [f32; CORNERS],
) -> L::Oct {
    let corners = lanes.oct_corners(block, base);
    let mut sum = corners[0] * lanes.oct_splat(weights[0]);
    let mut corner = 1;
    while corner < CORNERS {
        sum = lanes.oct_mul_add(corners[corner], lanes.oct_splat(weights[corner]), sum);
        corner += 1;
    }
    sum
}

#[inline(always)]
fn mono<L: Lanes, const CELLS: usize, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CELLS, 4>,
    base: usize,
    weights: [f32; CORNERS],
    floor: f32,
    out: &mut [f32],
) {
    let cells = lanes.quad_corners(block, base);
    let mut sum = 0.0;
    let mut corner = 0;
    while corner < CORNERS {
        let mut four = [0.0; 4];
        lanes.quad_store(&mut four, cells[corner / 4]);
        sum = lanes.scalar_mul_add(four[corner % 4], weights[corner], sum);
        corner += 1;
    }
    out[0] = if sum > floor { sum } else { floor };
}
