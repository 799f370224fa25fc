use super::*;
use crate::direction::{dot, spherical};

fn material(value: impl Fn(usize) -> f32) -> Data {
    let knots = [vec![-3.1, 0.5, 3.1], vec![0.0, 0.8, 1.5], vec![0.0, 1.5], vec![500.0, 600.0]];
    Data::new(knots, (0..3 * 3 * 2 * 2 * 16).map(value).collect()).expect("a valid table")
}

fn near(a: Matrix, b: Matrix) -> bool {
    a.as_flattened().iter().zip(b.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-12)
}

#[test]
fn the_plane_matrix_is_invariant_under_rotation_of_both() {
    let material = material(|i| ((i * 37) % 101) as f32 / 101.0);
    let pair = |turn: f64| (spherical(0.4, 0.3 + turn), spherical(1.1, 2.0 + turn));
    let (wi, wo) = pair(0.0);
    let (wi2, wo2) = pair(1.7);
    let matrix = material.in_plane(wi, wo, 530.0).expect("above the surface");
    assert!(near(matrix, material.in_plane(wi2, wo2, 530.0).expect("above the surface")));
    // Rotations of the Stokes frames do not change the intensity and the circular elements.
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
fn unmeasured_matrices_are_dark() {
    let (wi, wo) = (spherical(0.4, 0.3), spherical(1.1, 2.0));
    let gaps = material(|i| if i % 16 == 0 { f32::NAN } else { 1.0 });
    assert_eq!(gaps.eval(wi, wo, 550.0), [[0.0; 4]; 4]);
    let negative = material(|_| -1.0);
    let matrix = negative.in_plane(wi, wo, 550.0).expect("above the surface");
    assert!(matrix[0][0] == 0.0 && (matrix[0][1] + 1.0).abs() < 1e-12, "only the intensity is clamped");
    assert_eq!(negative.in_plane(wi, [0.6, 0.0, -0.8], 550.0), None);
}

#[test]
fn errors_name_the_wrong_part() {
    let new = |phi_d: Vec<f32>, n| Data::new([phi_d, vec![0.0], vec![0.0], vec![500.0]], vec![0.0; n]);
    assert_eq!(new(vec![0.0, 1.0], 32).map(|m| m.values().len()), Ok(32));
    assert_eq!(new(vec![0.0, 1.0], 16).expect_err("too few").part, "M");
    assert_eq!(new(vec![1.0, 0.0], 32).expect_err("descending").part, "phi_d");
    assert_eq!(new(vec![], 0).expect_err("empty").part, "phi_d");
}
