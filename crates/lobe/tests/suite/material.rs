//! One interface over all representations: it gives the values of each representation.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use lobe::formats::{Document, Part};
use lobe::table::rgl::{self, Images, Parts, Reference};
use lobe::table::{half_diff, mirror, mueller, spherical};
use lobe::{
    Channels, Data, Given, Lookup, Material, OpenError, Options, SHEET, Sampler, SamplerOptions, Scatter, Side,
    specular,
};

fn sheet(parts: Vec<Part>) -> Document {
    Document { source: vec![("by".into(), "hand".into())], ..Document::of_parts(parts) }
}

fn open(document: Document, options: &Options) -> Result<Material, OpenError> {
    Material::from_document(&document, options)
}

fn material(document: Document) -> Material {
    open(document, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn value(material: &Material, wi: [f32; 3], wo: [f32; 3]) -> Vec<f32> {
    let mut out = vec![f32::NAN; material.channel_count()];
    material.eval(wi, wo, &mut out);
    out
}

fn flat(scatter: Scatter, value: f32, side: Option<Side>) -> Part {
    let knots = [vec![0.0], vec![0.0], vec![0.0], vec![0.0]];
    let grid = spherical::Data::new(scatter, knots, Channels::Mono, vec![value]).expect("a grid");
    Part { side, ..Part::new("", Data::Spherical(grid)) }
}

const UP: [f32; 3] = [0.6, 0.0, 0.8];
const DOWN: [f32; 3] = [0.0, 0.6, -0.8];

#[test]
fn the_sides_choose_the_part_of_a_sheet() {
    // The table answers with both directions above the surface only.
    let knots = [vec![0.0], vec![0.0], vec![0.0], vec![0.0]];
    let table = specular::Data::new(Scatter::Reflection, knots, Channels::Mono, vec![1.0]).expect("a table");
    let mirror = mirror::Data::new(Scatter::Reflection, [vec![0.0], vec![0.0]], Channels::Mono, vec![0.5]);
    let parts = vec![
        Part { side: Some(Side::Front), ..Part::new("", Data::Specular(table)) },
        Part::new("", Data::Mirror(mirror.expect("a mirror"))),
        flat(Scatter::Reflection, 2.0, Some(Side::Back)),
        flat(Scatter::Transmission, 3.0, Some(Side::Front)),
    ];
    let sheet = material(sheet(parts));
    assert_eq!((sheet.kind(), sheet.channel_count(), sheet.wavelengths()), (SHEET, 1, None));
    assert_eq!(sheet.source(), [("by".to_string(), "hand".to_string())]);
    let graze = [1.0, 0.0, 0.0];
    let (wi, wo) = ([UP, DOWN, UP, DOWN, UP, graze], [UP, DOWN, DOWN, UP, graze, UP]);
    let mut values = [f32::NAN; 6];
    sheet.eval_batch(&wi, &wo, &mut values);
    // Transmission measured in one direction applies to the other one too.
    assert_eq!(values, [1.0, 2.0, 3.0, 3.0, 0.0, 0.0]);
}

#[test]
fn sheets_without_one_answer_are_refused() {
    let refused = |parts| {
        let error = open(sheet(parts), &Options::default()).expect_err("no material");
        error.to_string()
    };
    let mirror = mirror::Data::new(Scatter::Reflection, [vec![0.0], vec![0.0]], Channels::Mono, vec![0.5]);
    let mirror = Part::new("", Data::Mirror(mirror.expect("a mirror")));
    assert_eq!(refused(vec![mirror.clone()]), "found mirror reflectance; expected a BRDF or BTDF");
    assert_eq!(refused(vec![mirror.clone(), mirror]), "found mirror reflectances; expected a BRDF or BTDF");
    let knots = [vec![0.0], vec![0.0], vec![0.0], vec![0.0]];
    let rgb = specular::Data::new(Scatter::Transmission, knots, Channels::Rgb, vec![1.0; 3]).expect("a table");
    let parts = vec![flat(Scatter::Reflection, 1.0, None), Part::new("", Data::Specular(rgb))];
    assert!(refused(parts).contains("parts with different channels"));
}

#[test]
fn half_difference_grids_honour_the_requested_lookup() {
    let data = half_diff::Data::new([4, 5, 6], (0..360).map(|i| i as f32).collect()).expect("a grid");
    let wo = [0.0, 0.28, 0.96];
    let wide = |w: [f32; 3]| w.map(f64::from);
    let expected = [
        (Lookup::Nearest, data.eval_nearest(wide(UP), wide(wo))),
        (Lookup::Linear, data.eval_linear(wide(UP), wide(wo))),
    ];
    assert_ne!(expected[0].1, expected[1].1);
    for (lookup, expected) in expected {
        let options = Options { lookup, ..Options::default() };
        let material = open(Document::new(data.clone()), &options).expect("a material");
        assert_eq!((material.kind(), material.channels()), (half_diff::KIND, &Channels::Rgb));
        for (found, expected) in value(&material, UP, wo).into_iter().zip(expected) {
            assert!((f64::from(found) - expected).abs() < 1e-4, "{lookup:?}: {found}, not {expected}");
        }
    }
}

#[test]
fn zero_length_directions_are_dark() {
    let data = half_diff::Data::new([1, 1, 1], vec![1.0; 3]).expect("a grid");
    let material = material(Document::new(data));
    assert_eq!(value(&material, UP, [0.0, 0.0, 2.0]), [1.0; 3], "the length makes no difference");
    for nowhere in [[0.0; 3], [f32::NAN, 0.0, 1.0], [0.0, 0.0, f32::INFINITY]] {
        assert_eq!((value(&material, nowhere, UP), value(&material, UP, nowhere)), (vec![0.0; 3], vec![0.0; 3]));
    }
    assert_eq!(material.mueller(UP, UP, 500.0), None);
    assert!(!material.mueller_batch(&[UP], &[UP], &mut []));
}

#[test]
fn polarised_materials_have_the_value_of_unpolarised_light() {
    let knots = [vec![-3.0, 3.0], vec![0.0, 1.5], vec![0.0, 1.5], vec![500.0, 600.0]];
    let data = mueller::Data::new(knots, (0..256).map(|i| 0.1 + (i % 37) as f32).collect()).expect("matrices");
    let material = material(Document::new(data));
    assert_eq!((material.kind(), material.wavelengths()), (mueller::KIND, Some([500.0, 600.0].as_slice())));
    let wo = [0.0, 0.28, 0.96];
    for (nm, found) in [500.0, 600.0].into_iter().zip(value(&material, UP, wo)) {
        let matrix = material.mueller(UP, wo, nm).expect("a matrix");
        assert!((matrix[0][0] - f64::from(found)).abs() < 1e-5 && found > 0.0, "{found} at {nm} nm: {matrix:?}");
    }
    let (wi, wo) = (vec![UP; 20_000], vec![wo; 20_000]);
    let mut all = vec![f32::NAN; wi.len() * 32];
    assert!(material.is_polarised() && material.mueller_batch(&wi, &wo, &mut all));
    let exact = [500.0, 600.0].map(|nm| material.mueller(UP, wo[0], nm).expect("a matrix"));
    for (found, expected) in all.iter().zip(exact.as_flattened().as_flattened().iter().cycle()) {
        assert!((f64::from(*found) - expected).abs() < 37.0 * 2e-5, "{found}, not {expected}");
    }
    let error = material.try_mueller_batch(&wi, &wo, &mut all[1..]).expect_err("too short");
    assert!(error.to_string().contains("elements of matrices"), "{error}");
}

fn rgl() -> rgl::Data {
    let images = |shape: [usize; 3]| {
        let texels = (0..shape.iter().product()).map(|i| 0.5 + (i % 7) as f32 / 7.0).collect();
        Images::new("made", shape, texels).expect("valid images")
    };
    let parts = Parts {
        description: "made".into(),
        phi_i: vec![0.0],
        theta_i: vec![0.0, 1.5],
        ndf: images([1, 2, 3]),
        sigma: images([1, 2, 2]),
        vndf: images([2, 6, 6]),
        luminance: images([2, 4, 4]),
        channels: Channels::Rgb,
        spectra: images([6, 4, 4]),
        jacobian: true,
        valid: None,
    };
    rgl::Data::new(parts).expect("a material")
}

fn rgl_sampler(data: rgl::Data, indexed_by: Given) -> Sampler {
    let options = Options { indexed_by, ..Options::default() };
    let material = open(Document::new(data), &options).expect("a material");
    Sampler::new(Arc::new(material), &SamplerOptions::default()).expect("a sampler")
}

#[test]
fn rgl_values_are_indexed_as_requested_and_samples_by_the_known_direction() {
    let data = rgl();
    let reference = Reference::new(&data);
    let wide = |w: [f32; 3]| w.map(f64::from);
    for indexed_by in [Given::Light, Given::Viewer] {
        let sampler = rgl_sampler(data.clone(), indexed_by);
        let expected = |wi, wo| {
            let mut values = [0.0; 3];
            let (index, other) = if indexed_by == Given::Light { (wi, wo) } else { (wo, wi) };
            reference.eval(wide(index), wide(other), &mut values);
            values
        };
        let known = [0.0, 0.28, 0.96];
        for (found, expected) in value(sampler.material(), UP, known).into_iter().zip(expected(UP, known)) {
            assert!((f64::from(found) / expected - 1.0).abs() < 1e-6, "{found}, not {expected}");
        }
        for given in [Given::Light, Given::Viewer] {
            let mut drawn = 0;
            for i in 0..100 {
                let uniform = [(i % 10) as f32 / 10.0 + 0.05, (i / 10) as f32 / 10.0 + 0.05];
                let mut weight = [f32::NAN; 3];
                let (other, pdf) = sampler.sample(given, known, uniform, &mut weight);
                if pdf == 0.0 {
                    continue;
                }
                let (wi, wo) = if given == Given::Light { (known, other) } else { (other, known) };
                let density = reference.pdf(wide(known), wide(other));
                for found in [pdf, sampler.pdf(given, wi, wo)] {
                    assert!((f64::from(found) / density - 1.0).abs() < 1e-3, "{other:?}: {found}, not {density}");
                }
                for (weight, value) in weight.into_iter().zip(expected(wi, wo)) {
                    let expected = value * f64::from(other[2]) / f64::from(pdf);
                    assert!((f64::from(weight) / expected - 1.0).abs() < 1e-4, "{other:?}: {weight}, not {expected}");
                }
                drawn += 1;
            }
            assert!(drawn > 50, "{drawn}");
        }
    }
}

#[test]
fn rgl_densities_miss_what_falls_below_the_surface() {
    let sampler = rgl_sampler(rgl(), Given::Light);
    let wo = [0.0, 0.28, 0.96];
    let (n, m) = (200, 400);
    let mut sum = 0.0;
    for i in 0..n {
        let theta = (i as f64 + 0.5) / n as f64 * FRAC_PI_2;
        for j in 0..m {
            let phi = (j as f64 + 0.5) / m as f64 * 2.0 * PI;
            let wi = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()].map(|c| c as f32);
            let pdf = sampler.pdf(Given::Viewer, wi, wo);
            sum += f64::from(pdf) * theta.sin() * FRAC_PI_2 / n as f64 * 2.0 * PI / m as f64;
        }
    }
    assert!((0.5..1.01).contains(&sum), "{sum}");
    let mut weight = [f32::NAN; 3];
    let (_, pdf) = sampler.sample(Given::Viewer, DOWN, [0.5, 0.5], &mut weight);
    assert_eq!((pdf, weight, sampler.pdf(Given::Viewer, UP, DOWN)), (0.0, [0.0; 3], 0.0));
}
