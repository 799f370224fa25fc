//! Baselines for the lanes: the same evaluation, one query at a time.
//!
//! Both baselines use the specular coordinates of the library and give its values up to rounding. Each is code as a
//! programmer of its time would write it: [`libm`] today, [`x87`] in 2005. [`interpn`] is a library that interpolates.

pub mod interpn;
pub mod libm;
#[cfg(target_arch = "x86_64")]
pub mod x87;

use lobe::specular;

/// A table of RGB texels, one node after the other, as a scalar program stores it.
#[derive(Clone, Debug)]
pub struct ScalarTable {
    /// Knots of sigma, psi, theta and phi in radians.
    pub knots: [Vec<f32>; 4],
    /// `[sigma][psi][theta][phi]`.
    pub texels: Vec<[f32; 3]>,
}

impl ScalarTable {
    /// Makes it from samples of three channels whose phi and psi close the circle.
    ///
    /// # Panics
    /// If there are not three channels.
    pub fn new(samples: &specular::Data) -> Self {
        assert_eq!(samples.channels().count(), 3, "the baselines are written for RGB");
        let (texels, _) = samples.values().as_chunks::<3>();
        ScalarTable {
            knots: samples.knots().each_ref().map(|k| k.iter().map(|&x| x as f32).collect()),
            texels: texels.to_vec(),
        }
    }

    /// The 8 or 16 corners of a cell, weighted and summed.
    #[inline(always)]
    fn interpolate(&self, cell: [usize; 4], fraction: [f32; 4]) -> [f32; 3] {
        let anisotropic = self.knots[1].len() > 1;
        let n = [1, 2, 3].map(|axis| self.knots[axis].len());
        let mut sum = [0.0; 3];
        for corner in 0..if anisotropic { 16 } else { 8 } {
            let mut weight = 1.0;
            let mut node = cell;
            // phi, theta, sigma, and psi last, so that an isotropic table has three bits.
            for (bit, axis) in [3, 2, 0, 1].into_iter().enumerate().take(if anisotropic { 4 } else { 3 }) {
                let upper = corner >> bit & 1;
                node[axis] += upper;
                weight *= if upper == 1 { fraction[axis] } else { 1.0 - fraction[axis] };
            }
            let texel = self.texels[((node[0] * n[0] + node[1]) * n[1] + node[2]) * n[2] + node[3]];
            for k in 0..3 {
                sum[k] += weight * texel[k];
            }
        }
        sum
    }
}
