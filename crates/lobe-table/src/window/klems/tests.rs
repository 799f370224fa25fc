use super::*;

#[test]
fn standard_bases_cover_the_hemisphere() {
    for (basis, patches) in [(AngleBasis::full(), 145), (AngleBasis::half(), 77), (AngleBasis::quarter(), 41)] {
        assert_eq!(basis.patches(), patches);
        assert_eq!(AngleBasis::new(basis.name(), basis.rings().to_vec()), Ok(basis.clone()));
        let total: f64 = (0..patches).map(|patch| basis.projected_solid_angle(patch)).sum();
        assert!((total - std::f64::consts::PI).abs() < 1e-12, "{} covers {total}", basis.name());
    }
}

#[test]
fn patches_are_counted_from_a_sector_centred_on_x() {
    let basis = AngleBasis::full();
    let at = |theta: f64, phi: f64| {
        let ((s, c), (sp, cp)) = (theta.to_radians().sin_cos(), phi.to_radians().sin_cos());
        basis.patch([s * cp, s * sp, c])
    };
    assert_eq!(at(0.0, 0.0), Some(0));
    assert_eq!(at(10.0, 0.0), Some(1));
    assert_eq!(at(10.0, 22.0), Some(1));
    assert_eq!(at(10.0, -22.0), Some(1));
    assert_eq!(at(10.0, 23.0), Some(2));
    assert_eq!(at(20.0, 90.0), Some(9 + 4));
    assert_eq!(basis.patch([1.0, 0.0, 0.0]), Some(133));
}

#[test]
fn light_straight_through_has_equal_indices() {
    let basis = AngleBasis::quarter();
    let n = basis.patches();
    let values = (0..n * n).map(|at| if at / n == at % n { 1.0 } else { 0.0 }).collect();
    let matrix = KlemsMatrix::new(basis.clone(), basis, values).expect("a square matrix");
    let (s, c) = 0.7_f64.sin_cos();
    assert_eq!(matrix.eval([s * 0.6, s * 0.8, c], [-s * 0.6, -s * 0.8, -c]), 1.0);
    assert_eq!(matrix.eval([s * 0.6, s * 0.8, c], [s * 0.6, s * 0.8, -c]), 0.0);
}

#[test]
fn bad_rings_are_refused() {
    let ring = |lower, upper, patches| Ring { lower, upper, patches };
    let new = |rings| AngleBasis::new("bad", rings);
    assert_eq!(new(vec![]), Err(KlemsError::NoRings));
    assert!(matches!(new(vec![ring(1.0, 90.0, 1)]), Err(KlemsError::Bounds { index: 0, .. })));
    assert!(matches!(new(vec![ring(0.0, 5.0, 1), ring(6.0, 90.0, 1)]), Err(KlemsError::Bounds { index: 1, .. })));
    assert!(matches!(new(vec![ring(0.0, f64::NAN, 1)]), Err(KlemsError::Bounds { .. })));
    assert!(matches!(new(vec![ring(0.0, 91.0, 1)]), Err(KlemsError::Bounds { .. })));
    assert!(matches!(new(vec![ring(0.0, 90.0, 0)]), Err(KlemsError::Patches { .. })));
    assert!(matches!(new(vec![ring(0.0, 90.0, u32::MAX)]), Err(KlemsError::Patches { .. })));
}
