//! Polarised, MERL, UTIA and MDL materials against the programs that define their formats.

use lobe_formats::{mbsdf, merl, pbsdf, tensor, utia};
use lobe_table::spherical;
use lobe_table::utia::Decode;
use lobe_testing::files::shared;
use lobe_testing::golden::{Worst, queries, relative, unit};
use lobe_testing::made::{merl_formula, spherical, utia_numbers};
use std::fs;
use std::path::Path;

#[test]
fn mueller_matrices_match_mitsuba() {
    let Some(shared) = shared() else { return };
    let path = shared.join("golden/syn.pbsdf");
    let material = pbsdf::read(&fs::read(&path).expect("file"), &path).expect("a polarised material");
    let queries = queries(&shared.join("golden/syn.pbsdf.mitsuba.txt"));
    assert_eq!(queries.len(), 160);
    let mut worst = Worst::default();
    for (at, (query, answer)) in queries.iter().enumerate() {
        let (viewer, light) = (unit(query, 0), unit(query, 3));
        let matrix = material.eval(light, viewer, query[6]);
        for (value, expected) in matrix.as_flattened().iter().zip(answer) {
            worst.see((value * light[2] - expected).abs(), at);
        }
    }
    println!("syn.pbsdf: {worst:?}");
    assert!(worst.error < 2e-6);
}

#[test]
fn polarised_materials_are_read_back() {
    let Some(shared) = shared() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let copy = folder.path().join("copy.pbsdf");
    for name in ["golden/syn.pbsdf", "data/kaist_pbsdf/spectralon_lowres.pbsdf"] {
        let path = shared.join(name);
        let bytes = fs::read(&path).expect("file");
        assert!(pbsdf::matches(&bytes) && !lobe_formats::rgl::matches(&bytes));
        let material = pbsdf::read(&bytes, &path).expect("a polarised material");
        pbsdf::write(&material, &copy).expect("written");
        assert_eq!(pbsdf::read(&fs::read(&copy).expect("written"), &copy), Ok(material), "{name}");
    }
}

/// A real diffuser, whose file leaves out the angles. The data confirm that they are uniform: the ends of `phi_d`
/// agree, and at the last `theta_d` and `theta_h` no light is left.
#[test]
fn the_real_diffuser_depolarises() {
    let Some(shared) = shared() else { return };
    let path = shared.join("data/kaist_pbsdf/spectralon_lowres.pbsdf");
    let material = pbsdf::read(&fs::read(&path).expect("file"), &path).expect("a polarised material");
    let [phi_d, theta_d, theta_h, nm] = material.knots();
    assert_eq!((phi_d.len(), theta_d.len(), theta_h.len()), (22, 9, 9));
    assert_eq!(nm, &[450.0, 500.0, 550.0, 600.0, 650.0]);
    assert_eq!((phi_d[0], theta_d[8]), (-std::f32::consts::PI, std::f32::consts::FRAC_PI_2));
    let texel = |p: usize, d: usize, h: usize| material.values()[(((p * 9 + d) * 9 + h) * 5 + 2) * 16];
    assert!((0..5).all(|h| relative(f64::from(texel(0, 1, h)), f64::from(texel(21, 1, h)), 0.0) < 0.01));
    assert!((0..9).all(|i| texel(4, 8, i) == 0.0 && texel(4, i, 8) == 0.0));
    let matrix = material.eval(spherical([0.3, 0.0]), spherical([0.6, 2.0]), 550.0);
    assert!((0.15..0.25).contains(&matrix[0][0]), "{matrix:?}");
    assert!(matrix.as_flattened()[1..].iter().all(|m| m.abs() < 0.15 * matrix[0][0]), "{matrix:?}");
}

/// Every bin holds its own indices, as the first line of the golden file says.
#[test]
fn merl_bins_match_the_reader_of_the_database() {
    let Some(shared) = shared() else { return };
    let bytes = merl_formula();
    assert_eq!(bytes.len(), 34_992_012);
    assert!(merl::matches(&bytes));
    let material = merl::read(&bytes, Path::new("formula.binary")).expect("a MERL material");
    let queries = queries(&shared.join("golden/merl_formula.txt"));
    assert_eq!(queries.len(), 400);
    for (at, (query, answer)) in queries.iter().enumerate() {
        let (wi, wo) = (spherical([query[0], query[1]]), spherical([query[2], query[3]]));
        assert_eq!(material.eval_nearest(wi, wo).as_slice(), answer, "query {at}");
    }
    let again = merl::read(&merl::to_bytes(&material).expect("bytes"), Path::new("again.binary"));
    assert!(again == Ok(material), "what is written is read back");
}

#[test]
fn utia_values_match_the_reader_of_the_database() {
    let Some(shared) = shared() else { return };
    let bytes = utia_numbers();
    let material = utia::read(&bytes, Path::new("lcg.bin")).expect("a UTIA material");
    assert!(utia::to_bytes(&material) == bytes, "what is written is what was read");
    let queries = queries(&shared.join("golden/utia_lcg.txt"));
    assert_eq!(queries.len(), 200);
    let mut worst = Worst::default();
    for (at, (query, answer)) in queries.iter().enumerate() {
        let values = material.eval_angles([query[0], query[1]], [query[2], query[3]], Decode::Raw);
        values.iter().zip(answer).for_each(|(a, b)| worst.see(relative(*a, *b, 0.0), at));
    }
    println!("utia: {worst:?}");
    // Twelve digits are printed: half a unit of the last is at most 5e-12 of the number.
    assert!(worst.error < 5e-12);
}

/// The number of zenith angles, of azimuths, and of channels.
fn resolution(grid: &spherical::Data) -> [usize; 3] {
    [grid.knots()[0].len(), grid.knots()[3].len(), grid.channels().count()]
}

#[test]
fn mbsdf_files_have_the_blocks_that_they_name() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/mdl_mbsdf");
    let read = |name: &str| {
        let path = folder.join(name);
        mbsdf::read(&fs::read(&path).expect("file"), &path)
    };
    let sides = |name: &str| {
        let sides = read(name).expect("an MBSDF");
        let again = mbsdf::read(&mbsdf::to_bytes(&sides).expect("bytes"), Path::new("again.mbsdf"));
        assert_eq!(again.as_ref(), Ok(&sides), "{name}: what is written is read back");
        [sides.reflection, sides.transmission].map(|side| side.map(|s| (resolution(&s), s.values().to_vec())))
    };
    let ramp = |n: u8| (0..n).map(f32::from).collect::<Vec<_>>();
    let (twelve, sixteen) = (Some(([2, 3, 1], ramp(12))), Some(([2, 4, 1], ramp(16))));
    assert_eq!(sides("test_scalar_theta_2_phi_3.mbsdf"), [twelve.clone(), None]);
    assert_eq!(sides("test_rgb_theta_2_phi_3.mbsdf"), [Some(([2, 3, 3], ramp(36))), None]);
    assert_eq!(sides("test_transmission_scalar_theta_2_phi_4.mbsdf"), [None, sixteen.clone()]);
    let both = "test_reflection_scalar_theta_2_phi_3_transmission_scalar_theta_2_phi_4.mbsdf";
    assert_eq!(sides(both), [twelve, sixteen]);
    for (name, found) in
        [("test_none.mbsdf", "the end of the file"), ("test_file_format_error.mbsdf", "file format err")]
    {
        let error = read(name).expect_err("a broken file").to_string();
        println!("{error}");
        assert!(error.contains(name) && error.contains(found), "{error}");
    }
}

/// Three real paints: they are brightest in the mirror direction, and do not depend on the azimuth at the pole.
#[test]
fn mbsdf_paints_are_brightest_in_the_mirror_direction() {
    let Some(shared) = shared() else { return };
    for name in ["carpaint_blue", "carpaint_red", "example_modules"] {
        let path = shared.join("data/mdl_mbsdf").join(format!("{name}.mbsdf"));
        let sides = mbsdf::read(&fs::read(&path).expect("file"), &path).expect("an MBSDF");
        let reflection = sides.reflection.as_ref().expect("reflection");
        assert_eq!(resolution(reflection), [45, 90, 3]);
        let wi = spherical([0.7, 0.4]);
        let at = |theta: f64, phi: f64| reflection.eval(wi, spherical([theta, 0.4 + phi]))[1];
        assert!(at(0.7, std::f64::consts::PI) > 20.0 * at(0.7, 0.0).abs(), "{name}");
        assert!((at(0.7, 2.0) - at(0.7, -2.0)).abs() < 1e-6, "{name}: mirror images");
        assert!((at(0.0, 1.0) - at(0.0, 3.0)).abs() < 1e-6, "{name}: the pole has one value");
        assert_eq!(reflection.eval(wi, spherical([2.4, 0.0])), [0.0; 3], "{name}: no transmission");
        assert!(sides.transmission.is_none(), "{name}");
    }
}

#[test]
fn unknown_fields_are_kept() {
    let Some(shared) = shared() else { return };
    let path = shared.join("data/rgl_bsdf/paper_white_rgb.bsdf");
    let bytes = fs::read(&path).expect("file");
    let file = tensor::read(&bytes, &path).expect("a tensor file");
    let version = file.get("version").expect("a field that the material does not need");
    assert_eq!((version.dtype, version.shape.as_slice()), (tensor::DType::U32, [2].as_slice()));
    let again = file.to_bytes().expect("bytes");
    let again = tensor::read(&again, &path).expect("a tensor file");
    assert_eq!(again.fields.len(), file.fields.len());
    for (a, b) in again.fields.iter().zip(&file.fields) {
        assert_eq!((&a.name, a.dtype, &a.shape, &a.data), (&b.name, b.dtype, &b.shape, &b.data));
    }
}
