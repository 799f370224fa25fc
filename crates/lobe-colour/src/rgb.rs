//! Linear sRGB (IEC 61966-2-1, the primaries of Rec. ITU-R BT.709) and CIE XYZ, both relative to a perfect white with Y
//! = 1.

/// XYZ of D65 with Y = 1: the XYZ of a perfect white.
pub const WHITE: [f64; 3] = [0.950_422_674_061_359_2, 1.0, 1.088_610_368_912_593];

/// From linear sRGB to CIE XYZ: rows X, Y, Z; columns R, G, B. Computed from the chromaticities of the primaries, for
/// [`WHITE`].
pub const RGB_TO_XYZ: [[f64; 3]; 3] = [
    [0.412_429_756_955_405_46, 0.357_588_173_287_925_5, 0.180_404_743_818_028_18],
    [0.212_652_884_503_467_25, 0.715_183_313_476_236_1, 0.072_163_802_020_296_57],
    [0.019_335_704_346_203_56, 0.119_199_766_806_520_1, 0.950_074_897_759_869_4],
];

/// From CIE XYZ to linear sRGB: rows R, G, B; columns X, Y, Z. The inverse of [`RGB_TO_XYZ`].
pub const XYZ_TO_RGB: [[f64; 3]; 3] = [
    [3.240_624_232_349_702_5, -1.537_196_894_538_141, -0.498_585_967_486_116],
    [-0.969_183_162_334_070_1, 1.875_905_120_430_789_5, 0.041_547_034_330_732_424],
    [0.055_644_723_393_725_77, -0.204_073_035_388_015_8, 1.057_483_064_149_628_4],
];

/// The luminance of linear red, green and blue in Rec. ITU-R BT.709, item 3.2: the middle row of [`RGB_TO_XYZ`] to four
/// places.
pub const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Converts linear sRGB to CIE XYZ.
pub fn rgb_to_xyz(rgb: [f64; 3]) -> [f64; 3] {
    product(&RGB_TO_XYZ, rgb)
}

/// Converts XYZ to linear sRGB, which has negative components for colours outside the triangle of the primaries.
pub fn xyz_to_rgb(xyz: [f64; 3]) -> [f64; 3] {
    product(&XYZ_TO_RGB, xyz)
}

pub(crate) fn product(matrix: &[[f64; 3]; 3], vector: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matrices_are_inverse_and_white_is_white() {
        for rgb in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, -0.3, 4.0]] {
            let there_and_back = xyz_to_rgb(rgb_to_xyz(rgb));
            assert!((0..3).all(|k| (there_and_back[k] - rgb[k]).abs() < 1e-12), "{there_and_back:?}");
        }
        let white = rgb_to_xyz([1.0; 3]);
        assert!((0..3).all(|k| (white[k] - WHITE[k]).abs() < 1e-12), "{white:?}");
    }

    /// IEC 61966-2-1 gives four places; those of Y are the weights of luminance.
    #[test]
    fn the_matrices_agree_with_the_standard() {
        let standard = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
        for (row, expected) in XYZ_TO_RGB.iter().zip(standard) {
            assert!(row.iter().zip(expected).all(|(x, expected)| (x - expected).abs() < 5e-4), "{row:?}");
        }
        assert!((0..3).all(|k| (RGB_TO_XYZ[1][k] - f64::from(LUMINANCE[k])).abs() < 1e-4));
    }
}
