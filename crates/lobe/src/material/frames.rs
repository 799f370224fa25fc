//! Directions mirrored at the surface, and Mueller matrices of pairs of them.

use lobe_table::mueller::{Matrix, stokes_basis};

/// The matrix for light from `wi` to `wo`, from the matrix for both directions with the other side up. In the frames of
/// [`stokes_basis`] both times.
pub(super) fn unflipped(matrix: Matrix, wi: [f32; 3], wo: [f32; 3]) -> Matrix {
    // In a mirror, the sense of diagonal and of circular light is reversed.
    let mut mirrored = matrix;
    for (row, elements) in mirrored.iter_mut().enumerate() {
        for (column, element) in elements.iter_mut().enumerate() {
            if (row < 2) != (column < 2) {
                *element = -*element;
            }
        }
    }
    let (toward, away) = (wi.map(|c| -f64::from(c)), wo.map(f64::from));
    let [cos, sin] = turn(away);
    let mut out = mirrored;
    for column in 0..4 {
        let (a, b) = (mirrored[1][column], mirrored[2][column]);
        (out[1][column], out[2][column]) = (cos * a + sin * b, cos * b - sin * a);
    }
    let [cos, sin] = turn(toward);
    for row in &mut out {
        (row[1], row[2]) = (cos * row[1] + sin * row[2], cos * row[2] - sin * row[1]);
    }
    out
}

/// Cosine and sine of twice the angle from the x axis of a mirrored direction, mirrored back, to that of the direction.
fn turn(direction: [f64; 3]) -> [f64; 2] {
    let [x, y, z] = stokes_basis([direction[0], direction[1], -direction[2]]);
    let (from, to) = ([x, y, -z], stokes_basis(direction));
    let cross =
        [from[1] * to[2] - from[2] * to[1], from[2] * to[0] - from[0] * to[2], from[0] * to[1] - from[1] * to[0]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (cos, sin) = (dot(from, to), dot(direction, cross));
    let size = cos * cos + sin * sin;
    if size > 0.0 { [(cos * cos - sin * sin) / size, 2.0 * cos * sin / size] } else { [1.0, 0.0] }
}

/// A depolariser.
pub(super) fn depolariser(value: f64) -> Matrix {
    let mut matrix = [[0.0; 4]; 4];
    matrix[0][0] = value;
    matrix
}

/// The value at a wavelength, linear between channels, and constant beyond the first and the last.
pub(super) fn at_wavelength(wavelengths: &[f64], values: &[f32], nm: f64) -> f64 {
    let upper = wavelengths.partition_point(|other| *other < nm);
    let (a, b) = (upper.saturating_sub(1), upper.min(wavelengths.len().saturating_sub(1)));
    let width = wavelengths[b] - wavelengths[a];
    let t = if width > 0.0 { ((nm - wavelengths[a]) / width).clamp(0.0, 1.0) } else { 0.0 };
    f64::from(values[a]) + t * (f64::from(values[b]) - f64::from(values[a]))
}

/// The same direction with the other side up.
pub(crate) fn flipped([x, y, z]: [f32; 3]) -> [f32; 3] {
    [x, y, -z]
}

/// Both directions with the other side up, if the light comes from below.
pub(super) fn upright(wi: [f32; 3], wo: [f32; 3]) -> ([f32; 3], [f32; 3], bool) {
    if wi[2] < 0.0 { (flipped(wi), flipped(wo), true) } else { (wi, wo, false) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An ideal linear polariser with its axis along a direction across `d`, as a matrix in the frames of light that
    /// keeps travelling along `d`.
    fn polariser(d: [f64; 3], axis: [f64; 3]) -> Matrix {
        let x = stokes_basis(d);
        let y = [d[1] * x[2] - d[2] * x[1], d[2] * x[0] - d[0] * x[2], d[0] * x[1] - d[1] * x[0]];
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (c, s) = (dot(axis, x), dot(axis, y));
        let (c, s) = (c * c - s * s, 2.0 * c * s);
        [[1.0, c, s, 0.0], [c, c * c, c * s, 0.0], [s, c * s, s * s, 0.0], [0.0; 4]].map(|row| row.map(|x| 0.5 * x))
    }

    #[test]
    fn a_mirrored_polariser_has_a_mirrored_axis() {
        // Straight on: light from -d to d.
        let (d, axis) = ([0.48, 0.6, 0.64], [0.8, 0.0, -0.6]);
        let (up, up_axis) = ([d[0], d[1], -d[2]], [axis[0], axis[1], -axis[2]]);
        let found = unflipped(polariser(up, up_axis), d.map(|c| -(c as f32)), d.map(|c| c as f32));
        let expected = polariser(d, axis);
        for (a, b) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((a - b).abs() < 1e-6, "{found:?}, not {expected:?}");
        }
    }
}
