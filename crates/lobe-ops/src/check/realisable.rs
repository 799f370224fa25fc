//! Whether a surface can have given Mueller matrices.
//!
//! A matrix is possible if it is a mixture of Jones matrices, that is, if Cloude's coherency matrix has no negative
//! eigenvalue: S. R. Cloude, "Group theory and polarisation algebra", Optik 75, 1986. Outgoing light is then never more
//! than fully polarised.

use lobe_formats::{Document, Part};
use lobe_table::Data;

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
        let lowest = eigenvalues(&relative).into_iter().fold(f64::INFINITY, f64::min);
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
fn eigenvalues(m: &[f64; 16]) -> [f64; 4] {
    // `[row][column]` of the real and the imaginary part of each of Pauli's matrices, in the order of Stokes components.
    const PAULI: [[[[f64; 2]; 2]; 2]; 4] = [
        [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [1.0, 0.0]]],
        [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [-1.0, 0.0]]],
        [[[0.0, 0.0], [1.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]]],
        [[[0.0, 0.0], [0.0, -1.0]], [[0.0, 1.0], [0.0, 0.0]]],
    ];
    let (mut re, mut im) = ([[0.0; 4]; 4], [[0.0; 4]; 4]);
    for (i, a) in PAULI.iter().enumerate() {
        for (j, b) in PAULI.iter().enumerate() {
            let weight = 0.25 * m[4 * i + j];
            for row in 0..4 {
                for column in 0..4 {
                    let [x, y] = a[row / 2][column / 2];
                    // The other factor is conjugated.
                    let [u, v] = [b[row % 2][column % 2][0], -b[row % 2][column % 2][1]];
                    re[row][column] += weight * (x * u - y * v);
                    im[row][column] += weight * (x * v + y * u);
                }
            }
        }
    }
    // A Hermitian matrix as a symmetric one of twice the size, which has every eigenvalue twice.
    let mut symmetric = [[0.0; 8]; 8];
    for row in 0..4 {
        for column in 0..4 {
            symmetric[row][column] = re[row][column];
            symmetric[row + 4][column + 4] = re[row][column];
            symmetric[row][column + 4] = -im[row][column];
            symmetric[row + 4][column] = im[row][column];
        }
    }
    let mut all = jacobi(symmetric);
    all.sort_by(f64::total_cmp);
    [all[0], all[2], all[4], all[6]]
}

/// The eigenvalues of a symmetric matrix, by rotations of pairs (Jacobi).
fn jacobi<const N: usize>(mut a: [[f64; N]; N]) -> [f64; N] {
    for _ in 0..30 {
        let off: f64 = (0..N).flat_map(|p| (0..p).map(move |q| (p, q))).map(|(p, q)| a[p][q] * a[p][q]).sum();
        if off < 1e-24 {
            break;
        }
        for p in 0..N {
            for q in 0..p {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let t = if theta == 0.0 { 1.0 } else { t };
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for row in &mut a {
                    let (x, y) = (row[p], row[q]);
                    (row[p], row[q]) = (c * x - s * y, s * x + c * y);
                }
                let (x, y) = (a[p], a[q]);
                a[p] = std::array::from_fn(|k| c * x[k] - s * y[k]);
                a[q] = std::array::from_fn(|k| s * x[k] + c * y[k]);
            }
        }
    }
    std::array::from_fn(|k| a[k][k])
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
            let found = eigenvalues(&matrix);
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
