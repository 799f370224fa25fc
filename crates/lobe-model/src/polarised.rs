//! Rough surfaces that polarise light.

use std::f64::consts::PI;

use lobe_table::mueller::{Matrix, plane_normal};
use lobe_table::specular::coords::angles_to_directions;
use lobe_table::{GridError, polarised};

use crate::fresnel::{Elements, fresnel};
use crate::goniometer::lift;
use crate::microfacet::Ggx;
use crate::vec3::{Vec3, cross, dot};

/// GGX microfacets, each a mirror with Fresnel's equations: a metal, or the reflection of a dielectric.
#[derive(Clone, Debug, PartialEq)]
pub struct RoughMirrors {
    /// The facets.
    pub ggx: Ggx,
    /// The complex refractive index `[n, k]` at each wavelength.
    pub index: Vec<[f64; 2]>,
}

impl RoughMirrors {
    /// The Mueller matrix at a wavelength in 1/sr, without the cosine, for Stokes vectors with the x axis
    /// [`plane_normal`](lobe_table::mueller::plane_normal). 0 below the surface.
    pub fn in_plane(&self, wi: [f64; 3], wo: [f64; 3], wavelength: usize) -> Matrix {
        let mirrors = self.ggx.mirrors(wi, wo);
        if mirrors <= 0.0 {
            return [[0.0; 4]; 4];
        }
        // The cosine of the angle to the half vector.
        let cos = (0.5 * (1.0 + dot(wi, wo))).clamp(0.0, 1.0).sqrt();
        let [n, k] = self.index[wavelength];
        fresnel(cos, n, k).0.matrix().map(|row| row.map(|element| mirrors * element))
    }

    /// The matrices at knots of sigma, psi, theta and phi, in radians; those below the surface continue those just
    /// above it, as in [`goniometer::lift`](crate::goniometer::lift). `step` is called after each direction of the
    /// light.
    ///
    /// # Errors
    /// If the knots or the wavelengths, in nm, do not form a grid, or the numbers of wavelengths and indices differ.
    pub fn measure(
        &self,
        knots: [Vec<f64>; 4],
        wavelengths: Vec<f64>,
        step: impl FnMut(),
    ) -> Result<polarised::Data, GridError> {
        measured(knots, wavelengths, self.index.len(), |wi, wo, k| self.in_plane(wi, wo, k), step)
    }
}

/// A rough dielectric surface on a base that scatters evenly and depolarises: plastic, lacquer, pressed powder.
///
/// The surface mirrors as [`RoughMirrors`] do; light that passes it reaches the base, and leaves through the surface
/// again, each time partially polarised by Fresnel's equations for a smooth surface. Baek et al., *Simultaneous
/// acquisition of polarimetric SVBRDF and normals*, ACM Transactions on Graphics 37(6), 2018, section 4. Its values for
/// unpolarised light are those of [`Coated`](crate::Coated) with a [`Lambert`](crate::Lambert) base.
#[derive(Clone, Debug, PartialEq)]
pub struct RoughCoat {
    /// The surface, without absorption.
    pub mirrors: RoughMirrors,
    /// The share of light that the base reflects at each wavelength.
    pub albedo: Vec<f64>,
}

impl RoughCoat {
    /// Like [`RoughMirrors::in_plane`].
    pub fn in_plane(&self, wi: [f64; 3], wo: [f64; 3], wavelength: usize) -> Matrix {
        let mut matrix = self.mirrors.in_plane(wi, wo, wavelength);
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return matrix;
        }
        let [eta, _] = self.mirrors.index[wavelength];
        let [entering, leaving] = [wi, wo].map(|w| fresnel(w[2], eta, 0.0).1);
        let base = base_under(wi, wo, entering, leaving);
        for (out, base) in matrix.as_flattened_mut().iter_mut().zip(base.as_flattened()) {
            *out += self.albedo[wavelength] * base;
        }
        matrix
    }

    /// Like [`RoughMirrors::measure`].
    ///
    /// # Errors
    /// The same as for [`RoughMirrors::measure`].
    pub fn measure(
        &self,
        knots: [Vec<f64>; 4],
        wavelengths: Vec<f64>,
        step: impl FnMut(),
    ) -> Result<polarised::Data, GridError> {
        measured(knots, wavelengths, self.albedo.len(), |wi, wo, k| self.in_plane(wi, wo, k), step)
    }
}

/// The Mueller matrix in 1/sr of a white base that scatters evenly and depolarises, under a smooth surface that passes
/// these elements of light that comes from `wi` and of light that leaves along `wo`. The x axis of Stokes vectors is
/// [`plane_normal`].
pub fn base_under(wi: [f64; 3], wo: [f64; 3], entering: Elements, leaving: Elements) -> Matrix {
    let axis = plane_normal(wi, wo);
    let seen = |forward: Vec3, Elements { a, b, .. }: Elements| {
        // Across the plane of incidence, which is undefined along the normal, where b is 0.
        let across = cross([0.0, 0.0, 1.0], forward);
        let (cos, sin) = (dot(axis, across), dot(forward, cross(axis, across)));
        let size = cos * cos + sin * sin;
        match size > 0.0 {
            true => [a, b * (cos * cos - sin * sin) / size, b * 2.0 * cos * sin / size],
            false => [a, 0.0, 0.0],
        }
    };
    let (row, column) = (seen(wi.map(|x| -x), entering), seen(wo, leaving));
    let mut matrix = [[0.0; 4]; 4];
    for (out, left) in matrix.iter_mut().zip(column) {
        out.iter_mut().zip(row).for_each(|(out, entered)| *out = left * entered / PI);
    }
    matrix
}

/// A table of `count` wavelengths; `step` is called after each direction of the light.
fn measured(
    knots: [Vec<f64>; 4],
    wavelengths: Vec<f64>,
    count: usize,
    in_plane: impl Fn(Vec3, Vec3, usize) -> Matrix,
    mut step: impl FnMut(),
) -> Result<polarised::Data, GridError> {
    let mut values = Vec::new();
    for sigma in &knots[0] {
        for psi in &knots[1] {
            for theta in &knots[2] {
                for phi in &knots[3] {
                    let (wi, wo) = angles_to_directions([*sigma, *psi, *theta, *phi], |sigma| sigma);
                    let [wi, wo] = [wi, wo].map(lift);
                    for wavelength in 0..count {
                        let matrix = in_plane(wi, wo, wavelength);
                        values.extend(matrix.as_flattened().iter().map(|element| *element as f32));
                    }
                }
            }
            step();
        }
    }
    polarised::Data::new(knots, wavelengths, values)
}

#[cfg(test)]
mod tests {
    use lobe_table::Edges;

    use super::*;
    use crate::vec3::spherical;
    use crate::{Coated, Conductor, Lambert, Model};

    #[test]
    fn unpolarised_values_are_those_of_a_metal_and_tables_have_its_matrices() {
        let ggx = Ggx { alpha: [0.3, 0.3] };
        let gold = RoughMirrors { ggx, index: vec![[0.143, 3.983], [0.375, 2.386], [1.442, 1.603]] };
        let model = Conductor { ggx, eta: [0.143, 0.375, 1.442], k: [3.983, 2.386, 1.603] };
        let (wi, wo) = ([0.48, 0.36, 0.8], [-0.6, 0.0, 0.8]);
        for (channel, expected) in model.f(wi, wo).into_iter().enumerate() {
            let matrix = gold.in_plane(wi, wo, channel);
            assert!((matrix[0][0] / expected - 1.0).abs() < 1e-12);
            // One facet: a pure state stays pure.
            let [a, b, c, s] = [matrix[0][0], matrix[0][1], matrix[2][2], matrix[2][3]];
            assert!((a * a - b * b - c * c - s * s).abs() < 1e-12 * a * a);
        }
        let even = |n: usize, most: f64| (0..n).map(|k| most * k as f64 / (n - 1) as f64).collect::<Vec<f64>>();
        let knots = [even(20, 1.5), vec![0.0], even(60, std::f64::consts::PI), even(25, std::f64::consts::TAU)];
        let table = gold.measure(knots, vec![450.0, 550.0, 650.0], || {}).expect("a table");
        let (found, expected) =
            (table.in_plane(&Edges::default(), wi, wo, 550.0).expect("above"), gold.in_plane(wi, wo, 1));
        for (a, b) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((a - b).abs() < 0.03 * expected[0][0], "{found:?}, not {expected:?}");
        }
    }

    #[test]
    fn coats_polarise_what_leaves_the_base() {
        let ggx = Ggx { alpha: [0.2, 0.2] };
        let coat = RoughCoat { mirrors: RoughMirrors { ggx, index: vec![[1.5, 0.0]] }, albedo: vec![0.6] };
        let model = Coated { base: Lambert { albedo: [0.6; 3] }, ggx, eta: 1.5 };
        for (wi, wo) in [
            (spherical(0.4, 0.3), spherical(1.1, 2.0)),
            (spherical(0.0, 0.0), spherical(1.3, 4.0)),
            (spherical(1.2, 1.0), spherical(0.2, 1.0)),
        ] {
            let matrix = coat.in_plane(wi, wo, 0);
            assert!((matrix[0][0] / model.f(wi, wo)[0] - 1.0).abs() < 1e-12);
            // Light from one side is light to the other, with the sign of S2 as seen from there.
            let back = coat.in_plane(wo, wi, 0);
            for i in 0..4 {
                for j in 0..4 {
                    let sign = if (i == 2) != (j == 2) { -1.0 } else { 1.0 };
                    assert!((matrix[i][j] - sign * back[j][i]).abs() < 1e-12, "{i} {j}: {matrix:?} {back:?}");
                }
            }
        }
        // Far from the mirror direction only the base is seen: what leaves it at a steep angle is polarised within its
        // plane, by (ts - tp) / (ts + tp).
        let (wi, wo) = (spherical(0.3, 0.5), spherical(1.3, 2.6));
        let smooth =
            RoughCoat { mirrors: RoughMirrors { ggx: Ggx { alpha: [0.02, 0.02] }, index: vec![[1.5, 0.0]] }, ..coat };
        let matrix = smooth.in_plane(wi, wo, 0);
        let passed = fresnel(wo[2], 1.5, 0.0).1;
        let degree = matrix[1][0].hypot(matrix[2][0]) / matrix[0][0];
        assert!((degree + passed.b / passed.a).abs() < 1e-3 && degree > 0.1, "{degree}, not {}", -passed.b / passed.a);
        // If the viewer is in the plane of incidence, it is along that plane.
        let (wi, wo) = (spherical(0.3, 0.5), spherical(1.3, 0.5));
        let matrix = smooth.in_plane(wi, wo, 0);
        assert!(matrix[1][0] < 0.0 && matrix[2][0].abs() < 1e-12, "{matrix:?}");
    }
}
