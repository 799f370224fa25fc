//! Checks if a surface can have given Mueller matrices.
//!
//! A matrix is possible if it is a mixture of Jones matrices, that is, if Cloude's coherency matrix has no negative
//! eigenvalue: S. R. Cloude, "Group theory and polarisation algebra", Optik 75, 1986. Outgoing light is then never more
//! than fully polarised.

use lobe_formats::{Document, Part};
use lobe_table::Data;
use nalgebra::{Complex, Matrix2, Matrix4, Vector4};

use super::finding::{Finding, Status, part_name, percent};

/// The most matrices that are examined, evenly chosen.
const MOST: usize = 20_000;
/// A negative eigenvalue of this share of their sum is noise or rounding.
const NOISE: f64 = 0.01;
/// The same for a degree of polarisation above 1.
const ROUNDING: f64 = 1e-4;

pub(super) fn check(document: &Document) -> Vec<Finding> {
    document.parts.iter().filter_map(|part| of_part(document, part)).collect()
}

fn of_part(document: &Document, part: &Part) -> Option<Finding> {
    let values = match &part.data {
        Data::Mueller(data) => data.values(),
        Data::Polarised(data) => data.values(),
        _ => return None,
    };
    let (matrices, _) = values.as_chunks::<16>();
    let step = matrices.len().div_ceil(MOST).max(1);
    let (mut looked_at, mut impossible, mut least, mut degree) = (0_usize, 0_usize, 0.0_f64, 0.0_f64);
    for matrix in matrices.iter().step_by(step) {
        // Dark matrices have no polarisation, and NaN is unmeasured.
        if !(matrix[0] > 0.0 && matrix.iter().all(|element| element.is_finite())) {
            continue;
        }
        looked_at += 1;
        let relative = matrix.map(|element| f64::from(element) / f64::from(matrix[0]));
        let lowest = eigenvalues(&relative).min();
        // For fully polarised light in either state, and for unpolarised light.
        let size = |elements: [usize; 3]| elements.iter().map(|k| relative[*k].powi(2)).sum::<f64>().sqrt();
        let polarised = size([1, 2, 3]).max(size([4, 8, 12]));
        impossible += usize::from(lowest < -NOISE);
        (least, degree) = (least.min(lowest), degree.max(polarised));
    }
    if looked_at == 0 {
        return None;
    }
    let share = impossible as f64 / looked_at as f64;
    let bad = impossible > 0 || degree > 1.0 + ROUNDING;
    let text = if bad {
        format!(
            "{} of {looked_at} Mueller matrices cannot be those of a surface: Cloude's eigenvalues reach {:.3} of \
             their sum, and unpolarised or fully polarised light may become {:.1} % polarised",
            percent(share),
            least,
            100.0 * degree
        )
    } else {
        format!(
            "{looked_at} Mueller matrices are realisable: Cloude's eigenvalues are at least {least:.1e} of their sum"
        )
    };
    let status = if bad { Status::Warn } else { Status::Pass };
    let finding = Finding::new("realisable", &part_name(document, part), status, text);
    Some(finding.number("share", share).number("least", least).number("degree", degree))
}

/// The eigenvalues of Cloude's coherency matrix of a matrix with the first element 1. Their sum is 1.
fn eigenvalues(m: &[f64; 16]) -> Vector4<f64> {
    let [zero, one, i] = [Complex::ZERO, Complex::ONE, Complex::I];
    // Pauli's matrices, in the order of Stokes components.
    let pauli = [
        Matrix2::new(one, zero, zero, one),
        Matrix2::new(one, zero, zero, -one),
        Matrix2::new(zero, one, one, zero),
        Matrix2::new(zero, -i, i, zero),
    ];
    let mut coherency = Matrix4::zeros();
    for (row, a) in pauli.iter().enumerate() {
        for (column, b) in pauli.iter().enumerate() {
            coherency += a.kronecker(&b.conjugate()) * Complex::from(0.25 * m[4 * row + column]);
        }
    }
    coherency.symmetric_eigenvalues()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagonal(d: [f64; 4]) -> [f64; 16] {
        std::array::from_fn(|k| if k % 5 == 0 { d[k / 5] } else { 0.0 })
    }

    #[test]
    fn eigenvalues_decide_what_is_possible() {
        for (matrix, expected) in [
            // The identity, a mirror, a depolariser, a polariser.
            (diagonal([1.0; 4]), [0.0, 0.0, 0.0, 1.0]),
            (diagonal([1.0, 1.0, -1.0, -1.0]), [0.0, 0.0, 0.0, 1.0]),
            (diagonal([1.0, 0.0, 0.0, 0.0]), [0.25; 4]),
            (std::array::from_fn(|k| if [0, 1, 4, 5].contains(&k) { 1.0 } else { 0.0 }), [0.0, 0.0, 0.0, 1.0]),
            // Reversing only circular light is impossible.
            (diagonal([1.0, 1.0, 1.0, -1.0]), [-0.5, 0.5, 0.5, 0.5]),
        ] {
            let mut found = eigenvalues(&matrix);
            found.as_mut_slice().sort_by(f64::total_cmp);
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}, not {expected:?}");
        }
    }

    #[test]
    fn files_are_judged_by_their_matrices() {
        let file = |matrix: [f64; 16]| {
            let knots = [vec![0.0], vec![0.0], vec![0.0], vec![0.0]];
            let values = matrix.map(|x| x as f32).to_vec();
            let data = lobe_table::polarised::Data::new(knots, vec![550.0], values).expect("a matrix");
            check(&Document::new(data))
        };
        let sound = file(diagonal([0.3, 0.2, 0.1, 0.1]));
        assert_eq!((sound.len(), sound[0].status), (1, Status::Pass), "{}", sound[0].text);
        let impossible = file(diagonal([0.3, 0.3, 0.3, -0.3]));
        assert_eq!(impossible[0].status, Status::Warn);
        assert!(impossible[0].text.contains("cannot be those of a surface"), "{}", impossible[0].text);
        let mut too_much = diagonal([0.3, 0.0, 0.0, 0.0]);
        too_much[4] = 0.6;
        assert_eq!(file(too_much)[0].status, Status::Warn);
    }
}
