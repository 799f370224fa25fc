//! Mueller matrices of the pairs of directions that figures show.

use lobe::{Scatter, Side};
use rayon::prelude::*;

use crate::evaluate::Progress;
use crate::geometry::{cross, dot, in_plane, incident, normalise};
use crate::in_plane::angles;
use crate::quantity::Quantity;
use crate::subject::Subject;
use crate::view::View;

/// A Mueller matrix in 1/sr, `[row][column]`.
pub(crate) type Matrix = [[f32; 4]; 4];

/// The matrices in the plane of incidence for one incidence.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curve {
    /// The polar angle of the light in radians.
    pub(crate) sigma: f64,
    /// The viewing angle in radians, ascending, as in [`in_plane`].
    pub(crate) theta: Vec<f64>,
    /// The x axis of all Stokes frames is the normal of the plane of incidence.
    pub(crate) matrices: Vec<Matrix>,
    /// Whether each matrix is measured rather than extrapolated.
    pub(crate) is_measured: Vec<bool>,
}

/// What unpolarised light becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Linear {
    /// The degree of linear polarisation, from 0 to 1.
    pub(crate) degree: f32,
    /// The angle of polarisation from the x axis of the Stokes frame, in radians from 0 to pi, counterclockwise as seen
    /// by someone whom the light reaches.
    pub(crate) angle: f32,
}

impl Linear {
    /// `None` if no light arrives.
    pub(crate) fn of(matrix: &Matrix) -> Option<Self> {
        let [s0, s1, s2] = [matrix[0][0], matrix[1][0], matrix[2][0]];
        let degree = s1.hypot(s2) / s0;
        let angle = 0.5 * s2.atan2(s1);
        let angle = if angle < 0.0 { angle + std::f32::consts::PI } else { angle };
        (s0 > 0.0 && degree.is_finite()).then_some(Linear { degree: degree.min(1.0), angle })
    }
}

/// The scatter of polarised light from a side; reflection, if there are both.
pub(crate) fn scatter(subject: &Subject, side: Side) -> Option<Scatter> {
    subject.scatters(side).first().copied().filter(|_| subject.material().is_polarised())
}

/// The matrices of each incidence at the viewing angles of curves.
pub(crate) fn curves(subject: &Subject, view: &View, sigmas: &[f64], progress: &dyn Progress) -> Vec<Curve> {
    let Some(scatter) = scatter(subject, view.side) else { return Vec::new() };
    let of = |sigma: f64| angles(subject, view, scatter, sigma).theta;
    let plan: Vec<(f64, Vec<f64>)> = sigmas.iter().map(|&sigma| (sigma, of(sigma))).collect();
    progress.begin("matrices", plan.iter().map(|(_, theta)| theta.len() as u64).sum());
    let mut all = Vec::new();
    for (sigma, theta) in plan {
        let wi = incident(view.side, sigma, view.psi);
        let outgoing: Vec<[f64; 3]> =
            theta.iter().map(|&theta| in_plane(view.side, scatter, theta, view.psi)).collect();
        let matrices = matrices(subject, &view.quantity, view.psi, wi, &outgoing, progress);
        let is_covered = subject.coverage(view.side, scatter, sigma, view.psi);
        let is_measured = outgoing.into_iter().map(is_covered).collect();
        all.push(Curve { sigma, theta, matrices, is_measured });
    }
    all
}

/// The number of pairs per task.
const TASK: usize = 512;

/// The matrices of a quantity for light from `wi` at the azimuth `psi`, for Stokes vectors with the x axis
/// [`axis`].
pub(crate) fn matrices(
    subject: &Subject,
    quantity: &Quantity,
    psi: f64,
    wi: [f64; 3],
    outgoing: &[[f64; 3]],
    progress: &dyn Progress,
) -> Vec<Matrix> {
    let material = subject.material();
    let count = material.channel_count();
    let narrow = |d: [f64; 3]| d.map(|c| c as f32);
    let task = |outgoing: &[[f64; 3]]| {
        let incoming = vec![narrow(wi); outgoing.len()];
        let viewers: Vec<[f32; 3]> = outgoing.iter().map(|wo| narrow(*wo)).collect();
        let mut values = vec![0.0; 16 * count * outgoing.len()];
        material.mueller_batch(&incoming, &viewers, &mut values);
        let mut texel = vec![0.0; count];
        let mut of_pair = |(values, wo): (&[f32], &[f64; 3])| {
            let mut matrix = [[0.0; 4]; 4];
            for (at, element) in matrix.as_flattened_mut().iter_mut().enumerate() {
                texel.iter_mut().zip(values.chunks_exact(16)).for_each(|(value, matrix)| *value = matrix[at]);
                *element = quantity.reduce(&texel);
            }
            in_frames(matrix, wi, *wo, axis(wi, *wo, psi))
        };
        let found: Vec<Matrix> = values.chunks_exact(16 * count).zip(outgoing).map(&mut of_pair).collect();
        progress.advance(outgoing.len() as u64);
        found
    };
    outgoing.par_chunks(TASK).flat_map_iter(task).collect()
}

/// The x axis of Stokes frames: the normal of the plane of the two directions, or of the plane of incidence if they span
/// none.
pub(crate) fn axis(wi: [f64; 3], wo: [f64; 3], psi: f64) -> [f64; 3] {
    let normal = cross(wi, wo);
    if dot(normal, normal) > 1e-10 { normalise(normal) } else { [-psi.sin(), psi.cos(), 0.0] }
}

/// Converts a matrix for the frames of [`lobe::Material::mueller`] to one for the x axis given, before and after.
fn in_frames(matrix: Matrix, wi: [f64; 3], wo: [f64; 3], axis: [f64; 3]) -> Matrix {
    let toward = wi.map(|c| -c);
    let basis = lobe::table::mueller::stokes_basis;
    // Cosine and sine of twice the angle from the basis to the axis.
    let doubled = |forward: [f64; 3]| {
        let from = basis(forward);
        let angle = dot(forward, cross(from, axis)).atan2(dot(from, axis));
        let (sin, cos) = (2.0 * angle).sin_cos();
        [cos as f32, sin as f32]
    };
    let mut out = matrix;
    let [cos, sin] = doubled(wo);
    for column in 0..4 {
        let (a, b) = (matrix[1][column], matrix[2][column]);
        (out[1][column], out[2][column]) = (cos * a + sin * b, cos * b - sin * a);
    }
    let [cos, sin] = doubled(toward);
    for row in &mut out {
        (row[1], row[2]) = (cos * row[1] + sin * row[2], cos * row[2] - sin * row[1]);
    }
    out
}

#[cfg(test)]
mod tests {
    use lobe::table::mueller::{plane_normal, stokes_basis};

    use super::*;

    /// The reference is the rotation of `lobe-table` in the opposite direction: a matrix that is known in the frames of
    /// the plane comes back.
    #[test]
    fn frames_are_those_of_the_plane() {
        let knots = [vec![0.0, 1.5], vec![0.0], vec![0.0, 3.1], vec![0.0]];
        let matrix: Vec<f32> = (0..16).map(|k| 0.3 + ((k * 7) % 5) as f32 * 0.1).collect();
        let values = (0..4).flat_map(|_| matrix.clone()).collect();
        let data = lobe::table::polarised::Data::new(knots, vec![550.0], values).expect("matrices");
        let edges = lobe::Edges::default();
        for (wi, wo) in [([0.48, 0.36, 0.8], [-0.6, 0.0, 0.8]), ([0.0, 0.0, 1.0], [0.0, -0.6, 0.8])] {
            let turned = data.eval(&edges, wi, wo, 550.0).map(|row| row.map(|x| x as f32));
            let back = in_frames(turned, wi, wo, axis(wi, wo, 0.0));
            assert!(dot(axis(wi, wo, 0.0), plane_normal(wi, wo)) > 1.0 - 1e-9);
            for (a, b) in back.as_flattened().iter().zip(&matrix) {
                assert!((a - b).abs() < 1e-5, "{back:?}, not {matrix:?}");
            }
        }
        assert!(dot(stokes_basis([0.0, 0.6, 0.8]), [0.0, 0.6, 0.8]).abs() < 1e-12);
    }

    #[test]
    fn linear_polarisation_is_that_of_unpolarised_light() {
        let mut matrix = [[0.0; 4]; 4];
        assert_eq!(Linear::of(&matrix), None);
        (matrix[0][0], matrix[1][0]) = (0.5, -0.25);
        let found = Linear::of(&matrix).expect("light");
        assert!((found.degree - 0.5).abs() < 1e-6 && (found.angle - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
        (matrix[1][0], matrix[2][0]) = (0.0, -0.1);
        let found = Linear::of(&matrix).expect("light");
        assert!((found.angle.to_degrees() - 135.0).abs() < 1e-3, "{found:?}");
    }
}
