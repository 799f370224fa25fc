//! One query at a time, with SIMD inside the query.
//!
//! The arithmetic is that of the passes, operation by operation, so the results are the same bits; only its arrangement
//! differs. There is no other query to hide latency behind: the four angles share a register, a cell is found by comparing
//! with eight knots at once, and texels are loaded whole.

use std::f32::consts::TAU;

use lobe_lane::{Block, Kernel, Lanes, MAX_LANES};

use crate::Scatter;
use crate::grid::axis::{Axis, Bounds, Search};
use crate::grid::layout::{Corners, PHI, PSI, SIGMA, THETA, Texels};
use crate::grid::texel::Stored;
use crate::passes::angles::TINY;
use crate::passes::frame::{FARTHEST, POLE, Refracted, Zenith};
use crate::specular::Table;

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
        let located = Located { at: base as usize, fractions: [sigma, psi, theta, phi], valid };
        match table.layout.texels() {
            Texels::Single(corners) => located.read(lanes, table, corners, out),
            Texels::Half(corners) => located.read(lanes, table, corners, out),
        }
    }
}

/// Where in a table a query lies.
struct Located {
    at: usize,
    fractions: [f32; 4],
    valid: bool,
}

impl Located {
    #[inline(always)]
    fn read<L: Lanes, T: Stored>(self, lanes: L, table: &Table, corners: Corners<'_, T>, out: &mut [f32]) {
        let Located { at, fractions: [sigma, psi, theta, phi], valid } = self;
        let (floor, share) = (table.floor(), (valid, table.layout.scale()));
        match corners {
            Corners::RgbIso(block) => rgb(lanes, &block, at, (weights([sigma, theta], share), phi), floor, out),
            Corners::RgbAniso(block) => rgb(lanes, &block, at, (weights([sigma, psi, theta], share), phi), floor, out),
            Corners::MonoIso(block) => {
                mono(lanes, &block, at, weights::<3, 8>([sigma, theta, phi], share), floor, out);
            }
            Corners::MonoAniso(block) => {
                mono(lanes, &block, at, weights::<4, 16>([sigma, psi, theta, phi], share), floor, out);
            }
            Corners::WideIso(block) => wide(lanes, &block, at, weights([sigma, theta, phi], share), floor, out),
            Corners::WideAniso(block) => {
                wide(lanes, &block, at, weights([sigma, psi, theta, phi], share), floor, out);
            }
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
    let (tilted, reach) = (POLE < sin, 1.0 + iz);
    let shared = 1.0 / (if tilted { sin } else { POLE } * reach);
    let scale = if tilted { reach * shared } else { 0.0 };
    let (cos_psi, sin_psi) = (if tilted { ix * scale } else { 1.0 }, iy * scale);
    let half_sigma = sin2 * shared;
    let ([ax, ay, cos_zenith], sin_zenith) = match &table.refraction {
        None => ([ix, iy, iz], sin),
        Some(offset) => {
            let (wi, psi) = (lanes.splat_xyz([ix, iy, iz]), [lanes.splat(cos_psi), lanes.splat(sin_psi)]);
            let (opposite, sin) = Refracted(offset).opposite(lanes, wi, lanes.splat(sin), psi);
            (lanes.extract_xyz(opposite, 0), lanes.extract(sin, 0))
        }
    };
    let (dx, dy, dz) = (ox + ax, oy + ay, oz - cos_zenith);
    let toward = fma(cos_psi, dx, sin_psi * dy);
    let y = fma(cos_psi, dy, -(sin_psi * dx));
    let x = fma(cos_zenith, toward, sin_zenith * dz);
    let distance2 = fma(dx, dx, fma(dy, dy, dz * dz));
    let valid = 0.0 < iz && 0.0 < oz && distance2 + fma(iz, iz, sin2) < FARTHEST;

    let along = 1.0 - 0.5 * distance2;
    let across = fma(x, x, y * y).sqrt();
    let (reach, span) = (1.0 + along.abs(), across + x.abs());
    let span = if TINY > span { TINY } else { span };
    let shared = 1.0 / (reach * span);
    let half_theta = across * span * shared;
    let half_phi = y * reach * shared;
    let half_psi = if table.is_anisotropic() { sin_psi / (1.0 + cos_psi.abs()) } else { 0.0 };

    // One polynomial for all four: where a polar angle's tangent is not negative, it is an azimuth like another. Sigma is
    // never beyond pi/2.
    let halves = [half_sigma, half_psi, half_theta, half_phi];
    (azimuths(lanes, halves, [1.0, cos_psi, along, x]), valid)
}

/// As [`lobe_math::azimuth_from`], of four angles.
#[inline(always)]
fn azimuths<L: Lanes>(lanes: L, t: [f32; 4], x: [f32; 4]) -> [f32; 4] {
    let mut angles = [0.0; MAX_LANES];
    if L::LANES < 4 {
        let mut k = 0;
        while k < 4 {
            let angle = lobe_math::azimuth_from(lanes, lanes.splat(t[k]), lanes.splat(x[k]));
            angles[k] = lanes.extract(angle, 0);
            k += 1;
        }
    } else {
        let packed = lobe_math::azimuth_from(lanes, lanes.first_four(t), lanes.first_four(x));
        lanes.store(&mut angles, packed);
    }
    [angles[0], angles[1], angles[2], angles[3]]
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

    /// As [`Find::find`](crate::grid::search::Find), for one angle.
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

/// The weight of each corner over the axes whose fractions are given, the last axis fastest. They add up to `scale`,
/// or to 0 where not `valid`.
#[inline(always)]
fn weights<const AXES: usize, const CORNERS: usize>(
    fractions: [f32; AXES],
    (valid, scale): (bool, f32),
) -> [f32; CORNERS] {
    let mut products = [scale; CORNERS];
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
fn rgb<L: Lanes, T: Stored, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CORNERS, 8, T>,
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
fn wide<L: Lanes, T: Stored, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CORNERS, 8, T>,
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
fn blend<L: Lanes, T: Stored, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CORNERS, 8, T>,
    base: usize,
    weights: [f32; CORNERS],
) -> L::Oct {
    let corners = T::octs(lanes, block, base);
    let mut sum = corners[0] * lanes.oct_splat(weights[0]);
    let mut corner = 1;
    while corner < CORNERS {
        sum = lanes.oct_mul_add(corners[corner], lanes.oct_splat(weights[corner]), sum);
        corner += 1;
    }
    sum
}

#[inline(always)]
fn mono<L: Lanes, T: Stored, const CELLS: usize, const CORNERS: usize>(
    lanes: L,
    block: &Block<'_, CELLS, 4, T>,
    base: usize,
    weights: [f32; CORNERS],
    floor: f32,
    out: &mut [f32],
) {
    let cells = T::quads(lanes, block, base);
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
