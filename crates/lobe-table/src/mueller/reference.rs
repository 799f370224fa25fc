//! The evaluation of [`Data`] one query at a time in `f64`: the reference for the lanes.

use std::f64::consts::PI;

use super::data::{Data, ELEMENTS, Matrix};
use crate::direction::{Vector, cross, dot, half_difference, normalize, phi, rotate_z};
use crate::grid::neighbours::{Neighbours, corners};
use crate::grid::weights::SUM;
use crate::passes::half_vector;

impl Data {
    /// The Mueller matrix in 1/sr, without the cosine, for light that comes from `wi` and leaves along `wo`.
    ///
    /// It maps Stokes vectors with the x axis [`stokes_basis`]`(-wi)` to Stokes vectors with the x axis
    /// [`stokes_basis`]`(wo)`. Zero if a direction is not above the surface or nothing was measured.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3], nm: f64) -> Matrix {
        self.in_plane(wi, wo, nm).map_or([[0.0; 4]; 4], |matrix| in_frames(matrix, wi, wo))
    }

    /// The stored matrix, linear in all four axes and constant beyond them, for Stokes vectors with the x axis
    /// [`plane_normal`]. `None` if a direction is not above the surface or nothing was measured.
    pub fn in_plane(&self, wi: [f64; 3], wo: [f64; 3], nm: f64) -> Option<Matrix> {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return None;
        }
        let [phi_d, theta_d, theta_h] = coordinates(wi, wo);
        let at = [phi_d, theta_d, theta_h, nm];
        let cell: [Neighbours; 4] = std::array::from_fn(|axis| Neighbours::held(&self.knots[axis], at[axis]));
        let mut matrix = [[0.0; 4]; 4];
        // A corner without weight in the blend need not be measured.
        corners(&cell, |node, weight| {
            let at = node.iter().zip(&self.knots).fold(0, |at, (node, knots)| at * knots.len() + node);
            let texel = &self.values[at * ELEMENTS..][..ELEMENTS];
            for (element, value) in matrix.as_flattened_mut().iter_mut().zip(texel) {
                *element += weight * f64::from(*value);
            }
        });
        if matrix[0][0].is_nan() {
            return None;
        }
        matrix[0][0] = matrix[0][0].max(0.0);
        Some(matrix)
    }

    /// The largest error of a value in the lanes of a [`Table`](crate::mueller::Table), relative to the largest first
    /// element of a matrix, if all surrounding matrices were measured.
    pub fn bound(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        let at = coordinates(wi, wo);
        let errors = rounding(at);
        // The two ends of `phi_d` have separate values.
        if PI - at[0].abs() <= errors[0] {
            return 1.0;
        }
        let steepest = |axis: usize| {
            let widths = self.knots[axis].windows(2).map(|ends| f64::from(ends[1]) - f64::from(ends[0]));
            widths.fold(0.0_f64, |steepest, width| steepest.max(1.0 / width))
        };
        (0..3).map(|axis| errors[axis] * steepest(axis)).sum::<f64>() + SUM
    }
}

/// The largest rotation, in radians, of the Stokes frames of [`Matrices`](crate::mueller::Matrices) relative to those
/// of the reference. The normal of the plane is poorly determined if the directions hardly span it.
pub fn turned(wi: [f64; 3], wo: [f64; 3]) -> f64 {
    let normal = cross(wi, wo);
    1e-6 + 2.5e-7 / dot(normal, normal).sqrt()
}

/// Converts a matrix for Stokes vectors with the x axis [`plane_normal`] to one for the x axes [`stokes_basis`]`(-wi)`
/// and [`stokes_basis`]`(wo)`.
pub(crate) fn in_frames(matrix: Matrix, wi: Vector, wo: Vector) -> Matrix {
    let propagation = wi.map(|x| -x);
    let (target_in, target_out) = (stokes_basis(propagation), stokes_basis(wo));
    let normal = plane_normal(wi, wo);
    let (rotate_in, rotate_out) = (rotator(propagation, normal, target_in), rotator(wo, normal, target_out));
    multiply(multiply(rotate_out, matrix), transpose(rotate_in))
}

/// `phi_d` in `(-pi, pi]`, `theta_d` and `theta_h`, with the viewer turned to azimuth 0 as in figure 3 of Baek et al.:
/// if the half vector is the normal, so that its azimuth is undefined, the result still follows a rotation of both.
pub fn coordinates(wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
    let turn = phi(wo);
    let (theta_h, theta_d, phi_d) = half_difference(rotate_z(wi, -turn), rotate_z(wo, -turn));
    [phi_d, theta_d, theta_h]
}

/// The largest error, in radians, of the [`coordinates`] of a pair in the lanes of a [`Table`](crate::mueller::Table).
pub fn rounding([_, theta_d, theta_h]: [f64; 3]) -> [f64; 3] {
    let [theta_h, theta_d, phi_d] = half_vector::rounding(theta_h, theta_d);
    [phi_d, theta_d, theta_h]
}

/// The x axis of the Stokes frames that the table uses, the same before and after the reflection: the normal of the
/// plane of the two directions. If they span no plane, it is [`stokes_basis`]`(-wi)`.
pub fn plane_normal(wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
    let normal = cross(wi, wo);
    if dot(normal, normal) < 1e-24 {
        return stokes_basis(wi.map(|x| -x));
    }
    normalize(normal)
}

/// The x axis that Stokes vectors of light along `direction` refer to: the first tangent of Duff et al., "Building an
/// Orthonormal Basis, Revisited", JCGT 6(1), 2017.
pub fn stokes_basis(direction: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = direction;
    let sign = 1.0f64.copysign(z);
    let a = -1.0 / (sign + z);
    [1.0 + sign * x * x * a, sign * x * y * a, -sign * x]
}

/// The Mueller matrix that refers Stokes vectors of light along `forward` to another x axis.
fn rotator(forward: Vector, current: Vector, target: Vector) -> Matrix {
    let angle = dot(forward, cross(current, target)).atan2(dot(current, target));
    let (sin, cos) = (2.0 * angle).sin_cos();
    [[1.0, 0.0, 0.0, 0.0], [0.0, cos, sin, 0.0], [0.0, -sin, cos, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

fn multiply(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

fn transpose(a: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}
