//! Rough surfaces that polarise light.

use lobe_table::mueller::Matrix;
use lobe_table::specular::coords::angles_to_directions;
use lobe_table::{GridError, polarised};

use crate::fresnel::fresnel;
use crate::microfacet::Ggx;
use crate::vec3::dot;

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

    /// The matrices at knots of sigma, psi, theta and phi, in radians. `step` is called after each direction of the
    /// light.
    ///
    /// # Errors
    /// If the knots or the wavelengths, in nm, do not form a grid, or the numbers of wavelengths and indices differ.
    pub fn measure(
        &self,
        knots: [Vec<f64>; 4],
        wavelengths: Vec<f64>,
        mut step: impl FnMut(),
    ) -> Result<polarised::Data, GridError> {
        let mut values = Vec::new();
        for sigma in &knots[0] {
            for psi in &knots[1] {
                for theta in &knots[2] {
                    for phi in &knots[3] {
                        let (wi, wo) = angles_to_directions([*sigma, *psi, *theta, *phi], |sigma| sigma);
                        for wavelength in 0..self.index.len() {
                            let matrix = self.in_plane(wi, wo, wavelength);
                            values.extend(matrix.as_flattened().iter().map(|element| *element as f32));
                        }
                    }
                }
                step();
            }
        }
        polarised::Data::new(knots, wavelengths, values)
    }
}

#[cfg(test)]
mod tests {
    use lobe_table::Edges;

    use super::*;
    use crate::{Conductor, Model};

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
}
