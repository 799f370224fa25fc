//! Polarised reflection: a 4 x 4 Mueller matrix for every pair of directions and wavelength.
//!
//! Baek et al., "Image-Based Acquisition and Modeling of Polarimetric Reflectance", ACM TOG 39(4), 2020. The material is
//! isotropic; matrices are tabulated over the coordinates of Rusinkiewicz, in Stokes frames that follow the plane of
//! the two directions.

use crate::direction::{Vector, cross, dot, half_difference, normalize, phi, rotate_z};
use crate::invalid::{Invalid, ascending, count};
use crate::knots::cell;

/// A 4 x 4 matrix, `[row][column]`, that turns a Stokes vector of the incoming light into one of the outgoing light.
pub type Matrix = [[f64; 4]; 4];

/// The elements of a matrix.
const ELEMENTS: usize = 16;

/// Tabulated Mueller matrices.
#[derive(Clone, Debug, PartialEq)]
pub struct Mueller {
    knots: [Vec<f32>; 4],
    values: Vec<f32>,
}

/// The axes of a [`Mueller`] table, with the names that the file format gives them.
pub const AXES: [&str; 4] = ["phi_d", "theta_d", "theta_h", "wvls"];

impl Mueller {
    /// Checks the knots of `phi_d`, `theta_d`, `theta_h`, in radians, and the wavelengths in nm, all ascending, and that
    /// there is a matrix for each combination: `[phi_d][theta_d][theta_h][wavelength][row][column]`.
    ///
    /// A matrix whose first element is NaN was not measured.
    ///
    /// # Errors
    /// [`Invalid`] names the axis, or `M` for the matrices.
    pub fn new(knots: [Vec<f32>; 4], values: Vec<f32>) -> Result<Self, Invalid> {
        for (name, axis) in AXES.into_iter().zip(&knots) {
            ascending(name, axis)?;
        }
        let [p, d, h, w] = [0, 1, 2, 3].map(|axis: usize| knots[axis].len());
        count("M", values.len(), &[p, d, h, w, 4, 4])?;
        match values.iter().position(|v| v.is_infinite()) {
            Some(at) => Err(Invalid::new("M", format!("{} at index {at}", values[at]), "finite numbers, or NaN")),
            None => Ok(Mueller { knots, values }),
        }
    }

    /// The knots of `phi_d`, `theta_d`, `theta_h` in radians, and the wavelengths in nm.
    pub fn knots(&self) -> &[Vec<f32>; 4] {
        &self.knots
    }

    /// All elements in 1/sr, without the cosine: `[phi_d][theta_d][theta_h][wavelength][row][column]`.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The Mueller matrix in 1/sr, without the cosine, for light that comes from `wi` and leaves along `wo`.
    ///
    /// It maps Stokes vectors with the x axis [`stokes_basis`]`(-wi)` to such with the x axis [`stokes_basis`]`(wo)`.
    /// Zero where a direction is not above the surface or nothing was measured.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3], nm: f64) -> Matrix {
        let Some(matrix) = self.in_plane(wi, wo, nm) else { return [[0.0; 4]; 4] };
        let propagation = wi.map(|x| -x);
        let (target_in, target_out) = (stokes_basis(propagation), stokes_basis(wo));
        let normal = plane_normal(wi, wo);
        let (rotate_in, rotate_out) = (rotator(propagation, normal, target_in), rotator(wo, normal, target_out));
        multiply(multiply(rotate_out, matrix), transpose(rotate_in))
    }

    /// The stored matrix, linear in all four axes and constant beyond them, for Stokes vectors with the x axis [`plane_normal`].
    /// `None` where a direction is not above the surface or nothing was measured.
    pub fn in_plane(&self, wi: [f64; 3], wo: [f64; 3], nm: f64) -> Option<Matrix> {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return None;
        }
        let (phi_d, theta_d, theta_h) = difference(wi, wo);
        let mut matrix = [[0.0; 4]; 4];
        let cells = [phi_d, theta_d, theta_h, nm];
        let cells: [(usize, f64); 4] = std::array::from_fn(|axis| cell(&self.knots[axis], cells[axis]));
        for corner in 0..16 {
            let (mut at, mut weight) = (0, 1.0);
            for (axis, (index, t)) in cells.into_iter().enumerate() {
                let upper = corner >> axis & 1;
                at = at * self.knots[axis].len() + index + upper;
                weight *= if upper == 1 { t } else { 1.0 - t };
            }
            // A corner without a part in the blend may lie outside the table, or not be measured.
            if weight > 0.0 {
                let texel = &self.values[at * ELEMENTS..][..ELEMENTS];
                for (element, value) in matrix.as_flattened_mut().iter_mut().zip(texel) {
                    *element += weight * f64::from(*value);
                }
            }
        }
        if matrix[0][0].is_nan() {
            return None;
        }
        matrix[0][0] = matrix[0][0].max(0.0);
        Some(matrix)
    }
}

/// `phi_d` in `(-pi, pi]`, `theta_d` and `theta_h`, with the viewer turned to azimuth 0 as in figure 3 of Baek et al.:
/// where the half vector is the normal, and its azimuth open, the result then still follows a rotation of both.
fn difference(wi: Vector, wo: Vector) -> (f64, f64, f64) {
    let turn = phi(wo);
    let (theta_h, theta_d, phi_d) = half_difference(rotate_z(wi, -turn), rotate_z(wo, -turn));
    (phi_d, theta_d, theta_h)
}

/// The x axis of the Stokes frames that the table uses, the same before and after the reflection: the normal of the
/// plane of the two directions. Where they span no plane it is [`stokes_basis`]`(-wi)`.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::spherical;

    fn material(value: impl Fn(usize) -> f32) -> Mueller {
        let knots = [vec![-3.1, 0.5, 3.1], vec![0.0, 0.8, 1.5], vec![0.0, 1.5], vec![500.0, 600.0]];
        Mueller::new(knots, (0..3 * 3 * 2 * 2 * 16).map(value).collect()).expect("a valid table")
    }

    fn near(a: Matrix, b: Matrix) -> bool {
        a.as_flattened().iter().zip(b.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn the_plane_matrix_does_not_see_a_rotation_of_both() {
        let material = material(|i| ((i * 37) % 101) as f32 / 101.0);
        let pair = |turn: f64| (spherical(0.4, 0.3 + turn), spherical(1.1, 2.0 + turn));
        let (wi, wo) = pair(0.0);
        let (wi2, wo2) = pair(1.7);
        let matrix = material.in_plane(wi, wo, 530.0).expect("above the surface");
        assert!(near(matrix, material.in_plane(wi2, wo2, 530.0).expect("above the surface")));
        // Rotations of the Stokes frames leave the intensity and the circular elements alone.
        let rotated = material.eval(wi, wo, 530.0);
        for (i, j) in [(0, 0), (0, 3), (3, 0), (3, 3)] {
            assert!((rotated[i][j] - matrix[i][j]).abs() < 1e-12);
        }
        assert!(!near(rotated, matrix));
    }

    #[test]
    fn retroreflection_has_the_value_of_its_neighbours() {
        let material = material(|i| ((i * 37) % 101) as f32 / 101.0);
        let wi = spherical(0.7, 1.0);
        let (exact, close) = (material.eval(wi, wi, 550.0), material.eval(wi, spherical(0.7 + 1e-9, 1.0), 550.0));
        assert!(exact[0][0] > 0.0 && exact.as_flattened().iter().all(|m| m.is_finite()));
        let axis = plane_normal(wi, wi);
        assert!(dot(axis, wi).abs() < 1e-12 && (dot(axis, axis) - 1.0).abs() < 1e-12);
        assert!(close.as_flattened().iter().all(|m| m.is_finite()));
    }

    #[test]
    fn what_was_not_measured_is_dark() {
        let (wi, wo) = (spherical(0.4, 0.3), spherical(1.1, 2.0));
        let gaps = material(|i| if i % 16 == 0 { f32::NAN } else { 1.0 });
        assert_eq!(gaps.eval(wi, wo, 550.0), [[0.0; 4]; 4]);
        let negative = material(|_| -1.0);
        let matrix = negative.in_plane(wi, wo, 550.0).expect("above the surface");
        assert!(matrix[0][0] == 0.0 && (matrix[0][1] + 1.0).abs() < 1e-12, "only the intensity is clamped");
        assert_eq!(negative.in_plane(wi, [0.6, 0.0, -0.8], 550.0), None);
    }

    #[test]
    fn tables_that_do_not_fit_are_named() {
        let new = |phi_d: Vec<f32>, n| Mueller::new([phi_d, vec![0.0], vec![0.0], vec![500.0]], vec![0.0; n]);
        assert_eq!(new(vec![0.0, 1.0], 32).map(|m| m.values().len()), Ok(32));
        assert_eq!(new(vec![0.0, 1.0], 16).expect_err("too few").part, "M");
        assert_eq!(new(vec![1.0, 0.0], 32).expect_err("descending").part, "phi_d");
        assert_eq!(new(vec![], 0).expect_err("empty").part, "phi_d");
    }
}
