//! Sheets of which a part has Mueller matrices.

use lobe::formats::{Document, Part};
use lobe::table::polarised;
use lobe::{Channels, Data, Material, Options, Scatter, Side, specular};

const NM: [f64; 2] = [500.0, 600.0];

fn matrices() -> polarised::Data {
    let knots = [vec![0.0, 1.2], vec![0.0], vec![0.0, 3.1], vec![0.0, 3.1, 6.2]];
    let element = |k: usize| if k.is_multiple_of(16) { 0.5 } else { 0.02 * ((k * 7) % 11) as f32 - 0.1 };
    let values = (0..2 * 2 * 3 * 2 * 16).map(element).collect();
    polarised::Data::new(knots, NM.to_vec(), values).expect("matrices")
}

fn plain(scatter: Scatter) -> specular::Data {
    let knots = [vec![0.0], vec![0.0], vec![0.0, 3.1], vec![0.0]];
    let values = vec![0.1, 0.3, 0.1, 0.3];
    specular::Data::new(scatter, knots, Channels::Spectral(NM.to_vec()), values).expect("a table")
}

fn sheet(polarised_side: Side) -> Material {
    let other = if polarised_side == Side::Front { Side::Back } else { Side::Front };
    let parts = vec![
        Part { side: Some(polarised_side), ..Part::new("", Data::Polarised(matrices())) },
        Part { side: Some(other), ..Part::new("", Data::Specular(plain(Scatter::Reflection))) },
        Part { side: Some(Side::Front), ..Part::new("", Data::Specular(plain(Scatter::Transmission))) },
    ];
    Material::from_document(&Document::of_parts(parts), &Options::default()).expect("a sheet")
}

fn batch(material: &Material, wi: [f32; 3], wo: [f32; 3]) -> Vec<f32> {
    let mut out = vec![f32::NAN; 16 * NM.len()];
    assert!(material.mueller_batch(&[wi], &[wo], &mut out));
    out
}

const WI: [f32; 3] = [0.48, 0.36, 0.8];
const WO: [f32; 3] = [-0.6, 0.0, 0.8];

fn below([x, y, z]: [f32; 3]) -> [f32; 3] {
    [x, y, -z]
}

#[test]
fn sheets_pass_on_the_matrices_of_their_parts() {
    let alone = Material::from_document(&Document::new(matrices()), &Options::default()).expect("a material");
    let sheet = sheet(Side::Front);
    assert!(sheet.is_polarised());
    assert_eq!(batch(&sheet, WI, WO), batch(&alone, WI, WO));
    assert_eq!(sheet.mueller(WI, WO, 540.0), alone.mueller(WI, WO, 540.0));
    // Reflection at the back, and transmission, depolarise.
    for (wi, wo) in [(below(WI), below(WO)), (WI, below(WO)), (below(WI), WO)] {
        let mut expected = vec![0.0; 32];
        (expected[0], expected[16]) = (0.1, 0.3);
        let found = batch(&sheet, wi, wo);
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-6), "{wi:?} {wo:?}: {found:?}");
        let matrix = sheet.mueller(wi, wo, 550.0).expect("a matrix");
        assert!((matrix[0][0] - 0.2).abs() < 1e-6 && matrix[1] == [0.0; 4], "{matrix:?}");
    }
}

#[test]
fn matrices_of_the_back_are_mirrored() {
    let (front, back) = (sheet(Side::Front), sheet(Side::Back));
    let (found, up) = (batch(&back, below(WI), below(WO)), batch(&front, WI, WO));
    // Energy, and how it depends on circular light, follow from the frames alone.
    for (matrix, up) in found.chunks_exact(16).zip(up.chunks_exact(16)) {
        assert_eq!(matrix[0], up[0]);
        assert!(
            (matrix[3] + up[3]).abs() < 1e-6
                && (matrix[12] + up[12]).abs() < 1e-6
                && (matrix[15] - up[15]).abs() < 1e-6
        );
        let linear = |m: &[f32]| m[4].hypot(m[8]);
        assert!((linear(matrix) - linear(up)).abs() < 1e-6);
    }
    let exact = back.mueller(below(WI), below(WO), 600.0).expect("a matrix");
    for (a, b) in exact.as_flattened().iter().zip(&found[16..]) {
        assert!((a - f64::from(*b)).abs() < 1e-5, "{exact:?}, not {found:?}");
    }
}
