//! Red, green, blue and white of colour spaces other than sRGB.

use crate::rgb::product;
use crate::{WHITE, XYZ_TO_RGB};

/// The chromaticities (x, y) of an RGB space: those of its red, green and blue, and of its white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primaries {
    /// The chromaticity of red.
    pub red: [f64; 2],
    /// The chromaticity of green.
    pub green: [f64; 2],
    /// The chromaticity of blue.
    pub blue: [f64; 2],
    /// The chromaticity of equal red, green and blue.
    pub white: [f64; 2],
}

/// Chromaticities in files have three or four digits.
const SAME: f64 = 6e-4;
/// The cone responses in which white is adapted (Lam's matrix, known as Bradford's).
const CONES: [[f64; 3]; 3] = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

impl Primaries {
    /// The primaries of sRGB and of Rec. ITU-R BT.709, with the white of D65.
    pub const SRGB: Primaries =
        Primaries { red: [0.64, 0.33], green: [0.3, 0.6], blue: [0.15, 0.06], white: [0.3127, 0.329] };

    /// `true` if these are the primaries of sRGB, to the precision of files.
    pub fn is_srgb(&self) -> bool {
        let all = |p: &Primaries| [p.red, p.green, p.blue, p.white];
        all(self).as_flattened().iter().zip(all(&Primaries::SRGB).as_flattened()).all(|(a, b)| (a - b).abs() <= SAME)
    }

    /// The matrix from linear RGB of these primaries to linear sRGB. White stays white: it is adapted to D65. `None` if
    /// the primaries do not span a colour space.
    pub fn to_srgb(&self) -> Option<[[f64; 3]; 3]> {
        let xyz = |[x, y]: [f64; 2]| [x, y, 1.0 - x - y];
        let [red, green, blue, white] = [self.red, self.green, self.blue, self.white].map(xyz);
        if self.white[1].is_nan() || self.white[1] <= 0.0 {
            return None;
        }
        let white = white.map(|c| c / self.white[1]);
        let columns = [0, 1, 2].map(|row| [red[row], green[row], blue[row]]);
        let shares = product(&inverse(&columns)?, white);
        let to_xyz = columns.map(|row| [0, 1, 2].map(|k| row[k] * shares[k]));
        let (from, to) = (product(&CONES, white), product(&CONES, WHITE));
        let scaled = [0, 1, 2].map(|k| CONES[k].map(|c| c * to[k] / from[k]));
        let adapted = times(&inverse(&CONES)?, &times(&scaled, &to_xyz));
        let matrix = times(&XYZ_TO_RGB, &adapted);
        matrix.as_flattened().iter().all(|c| c.is_finite()).then_some(matrix)
    }
}

fn times(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    a.map(|row| [0, 1, 2].map(|column| (0..3).map(|k| row[k] * b[k][column]).sum()))
}

fn inverse(m: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    // Cofactors, with cyclic indices.
    let cofactor = |i: usize, j: usize| {
        let at = |di: usize, dj: usize| m[(i + di) % 3][(j + dj) % 3];
        at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    (determinant.abs() > 1e-9).then(|| [0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactor(j, i) / determinant)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::xyz_to_rgb;

    fn close(a: [f64; 3], b: [f64; 3], within: f64) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < within)
    }

    #[test]
    fn srgb_is_itself_and_white_stays_white() {
        let same = Primaries::SRGB.to_srgb().expect("a matrix");
        for k in 0..3 {
            assert!(close(same[k], [0, 1, 2].map(|j| f64::from(u8::from(j == k))), 1e-3), "{same:?}");
        }
        let p3 = Primaries { red: [0.68, 0.32], green: [0.265, 0.69], blue: [0.15, 0.06], white: [0.3127, 0.329] };
        let radiance = Primaries { green: [0.29, 0.6], white: [1.0 / 3.0; 2], ..Primaries::SRGB };
        for primaries in [p3, radiance] {
            assert!(!primaries.is_srgb());
            let white = product(&primaries.to_srgb().expect("a matrix"), [1.0; 3]);
            assert!(close(white, [1.0; 3], 1e-9), "{white:?}");
        }
        // The matrix that is published for Display P3.
        let matrix = p3.to_srgb().expect("a matrix");
        assert!(close(matrix[0], [1.2249, -0.2247, 0.0], 2e-3), "{matrix:?}");
        assert!(Primaries { red: [0.6401, 0.33], ..Primaries::SRGB }.is_srgb());
    }

    #[test]
    fn xyz_is_a_valid_space_and_a_line_is_not() {
        let d65 = [0.3127, 0.329];
        let xyz = Primaries { red: [1.0, 0.0], green: [0.0, 1.0], blue: [0.0, 0.0], white: d65 };
        // Equal numbers are white there, so X and Z are relative to those of white.
        let found = product(&xyz.to_srgb().expect("a matrix"), [0.2, 0.3, 0.4]);
        let expected = xyz_to_rgb([0.2 * WHITE[0], 0.3, 0.4 * WHITE[2]]);
        assert!(close(found, expected, 2e-3), "{found:?} {expected:?}");
        assert_eq!(Primaries { blue: [0.47, 0.465], ..Primaries::SRGB }.to_srgb(), None);
        assert_eq!(Primaries { white: [0.3, 0.0], ..Primaries::SRGB }.to_srgb(), None);
    }
}
