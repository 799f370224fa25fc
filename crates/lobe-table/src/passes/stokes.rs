//! Conversion of Mueller matrices from a table to the Stokes frames of the directions.
//!
//! The matrices of a table are for Stokes vectors with the x axis along the normal of the plane of the two directions.
//! In the result, each x axis is a function of its direction alone. The two changes of axes mix the second and third
//! row, and the second and third column. If the block that these share is written as four combinations that a rotation
//! maps to each other in pairs, a change of both axes is a plane rotation of six pairs of numbers: one multiplication
//! and one multiply-add for each half of the matrix.

use lobe_lane::{Floats, Ints, Lanes};

use super::block::Column;
use super::pairs::Pairs;
use super::unit::unit;

/// The elements of a matrix.
const ELEMENTS: usize = 16;

/// Stored as the first element where nothing was measured. However small its weight in a blend, the result is far below
/// 0.
const UNMEASURED: f32 = f32::MIN;

/// A matrix, `[row][column]`, in the order of a table: rotated pairs are eight apart. If an element is NaN, the matrix
/// is unmeasured.
pub(crate) fn stored(matrix: &[f32; ELEMENTS]) -> [f32; ELEMENTS] {
    let [m00, m01, m02, m03, m10, m11, m12, m13, m20, m21, m22, m23, m30, m31, m32, m33] = *matrix;
    if matrix.iter().any(|element| element.is_nan()) {
        let mut none = [0.0; ELEMENTS];
        none[FIRST] = UNMEASURED;
        return none;
    }
    // Halved first, so that nothing overflows.
    let half = |a: f32, b: f32| 0.5 * a + 0.5 * b;
    let [p, q, r, t] = [half(m11, m22), half(m12, -m21), half(m11, -m22), half(m12, m21)];
    [m10, m13, m01, m31, p, r, m00, m03, m20, m23, m02, m32, q, t, m30, m33]
}

/// The position of the first element.
const FIRST: usize = 6;

/// A bound that the first element of any blend of measured matrices exceeds.
pub(crate) fn least(matrices: &[[f32; ELEMENTS]]) -> f32 {
    let first = matrices.iter().map(|matrix| matrix[0]).filter(|first| !first.is_nan());
    -2.0 * first.fold(1.0f32, |most, first| most.max(first.abs())).min(1e37)
}

/// Cosines and sines of twice the angles from the normal of the plane to the x axes of the directions, for a block of
/// queries: of the outgoing direction, the incoming one, their difference and their sum.
pub(crate) struct Stokes {
    cos: [Column; 4],
    sin: [Column; 4],
}

/// The positions of the columns of [`Stokes`].
const OUT: usize = 0;
const IN: usize = 1;
const DIFFERENCE: usize = 2;
const SUM: usize = 3;

/// Directions with a smaller squared sine of the angle between them span no plane.
const PLANE2: f32 = 1e-24;

impl Stokes {
    pub(crate) const ZERO: Self = Stokes { cos: [Column::<f32>::ZERO; 4], sin: [Column::<f32>::ZERO; 4] };

    /// Fills the angles of queries `0..n`, which are 0 unless the query is `valid`. `n` is a multiple of the lanes.
    #[inline(always)]
    pub(crate) fn run<L: Lanes>(&mut self, lanes: L, n: usize, Pairs { wi, wo }: Pairs<'_>, valid: &Column<i32>) {
        let (zero, one) = (lanes.splat_int(0), lanes.splat(1.0));
        let mut query = 0;
        while query < n {
            let (unit_wi, wi) = units(lanes, wi.load(lanes, query));
            let (unit_wo, wo) = units(lanes, wo.load(lanes, query));
            // The difference is exact if the directions are close to each other; their product would not be.
            let [dx, dy, dz] = [wo[0] - wi[0], wo[1] - wi[1], wo[2] - wi[2]];
            let normal = [
                lanes.mul_add(wi[1], dz, -(wi[2] * dy)),
                lanes.mul_add(wi[2], dx, -(wi[0] * dz)),
                lanes.mul_add(wi[0], dy, -(wi[1] * dx)),
            ];
            let [x, y, z] = normal;
            let length2 = lanes.mul_add(x, x, lanes.mul_add(y, y, z * z));
            let plane = lanes.splat(PLANE2).lt(length2) & valid.load(lanes, query).lt(zero);
            let (co, so) = doubled(lanes, unit_wo, normal, plane, one);
            let (ci, minus_si) = doubled(lanes, unit_wi, normal, plane, one);
            // Incoming light travels toward the surface, so its azimuths turn the other way.
            let si = -minus_si;
            self.cos[OUT].store(lanes, query, co);
            self.sin[OUT].store(lanes, query, so);
            self.cos[IN].store(lanes, query, ci);
            self.sin[IN].store(lanes, query, si);
            self.cos[DIFFERENCE].store(lanes, query, lanes.mul_add(co, ci, so * si));
            self.sin[DIFFERENCE].store(lanes, query, lanes.mul_add(so, ci, -(co * si)));
            self.cos[SUM].store(lanes, query, lanes.mul_add(co, ci, -(so * si)));
            self.sin[SUM].store(lanes, query, lanes.mul_add(so, ci, co * si));
            query += L::LANES;
        }
    }

    /// Converts the matrices of the first queries of a block, in the order of [`stored`], to the frames of the
    /// directions, and puts their elements in order: `out[query][matrix][row][column]`. Matrices with a first element
    /// below `least` become 0.
    #[inline(always)]
    pub(crate) fn refer<L: Lanes>(&self, lanes: L, matrices: usize, least: f32, out: &mut [f32]) {
        let mut query = 0;
        while query * matrices * ELEMENTS < out.len() {
            let texel = &mut out[query * matrices * ELEMENTS..][..matrices * ELEMENTS];
            let (co, so) = (self.cos[OUT].one(query), self.sin[OUT].one(query));
            let (ci, si) = (self.cos[IN].one(query), self.sin[IN].one(query));
            let (cd, sd) = (self.cos[DIFFERENCE].one(query), self.sin[DIFFERENCE].one(query));
            let (cs, ss) = (self.cos[SUM].one(query), self.sin[SUM].one(query));
            let cos = lanes.oct_load(&[co, co, ci, ci, cd, cs, 1.0, 1.0]);
            let sin = lanes.oct_load(&[so, so, si, si, -sd, ss, 0.0, 0.0]);
            let back = lanes.oct_load(&[-so, -so, -si, -si, sd, -ss, 0.0, 0.0]);
            let mut at = 0;
            while at < texel.len() {
                let matrix = &mut texel[at..][..ELEMENTS];
                let (x, y) = (lanes.oct_load(&matrix[..8]), lanes.oct_load(&matrix[8..]));
                let (mut a, mut b) = ([0.0; 8], [0.0; 8]);
                lanes.oct_store(&mut a, lanes.oct_mul_add(x, cos, y * sin));
                lanes.oct_store(&mut b, lanes.oct_mul_add(y, cos, x * back));
                let [m10, m13, m01, m31, p, r, m00, m03] = a;
                let [m20, m23, m02, m32, q, t, m30, m33] = b;
                let first = if m00 > 0.0 { m00 } else { 0.0 };
                let rows = [first, m01, m02, m03, m10, p + r, t + q, m13, m20, t - q, p - r, m23, m30, m31, m32, m33];
                if m00 > least {
                    matrix.copy_from_slice(&rows);
                } else {
                    matrix.copy_from_slice(&[0.0; ELEMENTS]);
                }
                at += ELEMENTS;
            }
            query += 1;
        }
    }
}

/// The unit vector along a direction; a direction of about unit length is returned unchanged, so that nothing is
/// rounded.
#[inline(always)]
fn units<L: Lanes>(lanes: L, [x, y, z]: [L::F; 3]) -> ([L::F; 3], [L::F; 3]) {
    let length2 = lanes.mul_add(x, x, lanes.mul_add(y, y, z * z));
    let near = lanes.splat(0.5).lt(length2) & length2.lt(lanes.splat(2.0));
    let ([ux, uy, uz], _) = unit(lanes, [x, y, z]);
    ([ux, uy, uz], [lanes.select(near, x, ux), lanes.select(near, y, uy), lanes.select(near, z, uz)])
}

/// Cosine and sine of twice the angle from a normal of the direction `w` to the x axis of its frame (Duff et al. 2017).
#[inline(always)]
fn doubled<L: Lanes>(lanes: L, w: [L::F; 3], normal: [L::F; 3], plane: L::M, one: L::F) -> (L::F, L::F) {
    let [x, y, z] = w;
    let tilt = normal[2] / (one + z);
    let along = lanes.mul_add(-x, tilt, normal[0]);
    let across = lanes.mul_add(y, tilt, -normal[1]);
    let (along2, across2) = (along * along, across * across);
    let scale = one / (along2 + across2);
    let product = along * across;
    (lanes.select(plane, (along2 - across2) * scale, one), ((product + product) * scale).masked(plane))
}
