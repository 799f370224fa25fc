//! Materials with two sides: the choice of the lobe, mirrors, and unmeasured sides.

use std::sync::Arc;

use lobe::formats::{Document, Part};
use lobe::table::mirror;
use lobe::{Bsdf, Channels, Data, Given, Material, Options, Sampled, Sampler, SamplerOptions, Scatter, Side, specular};

use super::materials::sampler;
use super::{direction, numbers};

fn constant(scatter: Scatter, value: f32) -> specular::Data {
    let knots = [vec![0.0], vec![0.0], vec![0.0], vec![0.0]];
    specular::Data::new(scatter, knots, Channels::Mono, vec![value]).unwrap()
}

/// A sheet that reflects 0.3 on the front and 0.1 on the back, mirrors 0.2 on the front, and transmits 0.25, measured
/// from the front.
fn sheet() -> Material {
    let flat = |share: f64, scatter| Data::Specular(constant(scatter, (share / std::f64::consts::PI) as f32));
    let mirror = mirror::Data::new(Scatter::Reflection, [vec![0.0], vec![0.0]], Channels::Mono, vec![0.2]).unwrap();
    let part = |side, data| Part { side: Some(side), ..Part::new("", data) };
    let parts = vec![
        part(Side::Front, flat(0.3, Scatter::Reflection)),
        part(Side::Back, flat(0.1, Scatter::Reflection)),
        part(Side::Front, flat(0.25, Scatter::Transmission)),
        part(Side::Front, Data::Mirror(mirror)),
    ];
    Material::from_document(&Document::of_parts(parts), &Options::default()).unwrap()
}

#[test]
fn lobes_are_drawn_in_proportion_to_brightness() {
    let sampler = sampler(sheet());
    assert!(sampler.samples_mirrors());
    let count = 200_000;
    for (z, expected) in [(1.0, [0.3, 0.25, 0.2]), (-1.0, [0.1, 0.25, 0.0])] {
        let [x, y, cos] = direction(40.0, 20.0);
        let known = vec![[x, y, z * cos]; count];
        let (mut directions, mut pdfs) = (vec![[0.0; 3]; count], vec![0.0; count]);
        let mut weights = vec![0.0; count];
        let out = Sampled { directions: &mut directions, weights: &mut weights, pdfs: &mut pdfs };
        sampler.sample_batch(Given::Light, &known, &numbers(1, count), out);
        let total: f64 = expected.iter().sum();
        let (mut drawn, mut light, mut apart) = ([0.0; 3], [0.0; 3], 0);
        for query in 0..count {
            let way = match (pdfs[query] == f32::INFINITY, directions[query][2] * z > 0.0) {
                (true, _) => 2,
                (false, true) => 0,
                (false, false) => 1,
            };
            if way == 2 {
                assert_eq!(directions[query], [-x, -y, z * cos], "mirrored at the normal");
            } else {
                let pdf = sampler.pdf(Given::Light, known[query], directions[query]);
                apart += usize::from((pdf / pdfs[query] - 1.0).abs() > 1e-2);
            }
            drawn[way] += 1.0 / count as f64;
            light[way] += f64::from(weights[query]) / count as f64;
        }
        // At the edge of a cell, rounding may lead to the neighbouring one.
        assert!(apart < count / 1000, "{apart} of {count} densities are not reproduced");
        for way in 0..3 {
            let (drawn, light, expected) = (drawn[way], light[way], expected[way]);
            assert!((drawn - expected / total).abs() < 0.006, "{drawn} of all draws for {expected} in {total}");
            assert!((light - expected).abs() < 0.01 * total, "{light} of the light, not {expected}");
        }
    }
}

#[test]
fn lobes_share_the_evaluations_that_are_allowed() {
    let built = |evaluations| {
        let options = SamplerOptions { evaluations, ..SamplerOptions::default() };
        Sampler::new(Arc::new(sheet()), &options).unwrap()
    };
    assert!(!built(None).is_limited());
    // Four lobes of a third of a million pairs each.
    assert!(built(Some(1_000_000)).is_limited() && !built(Some(10_000_000)).is_limited());
}

#[test]
fn transmission_measured_in_one_direction_applies_to_both() {
    let material = sheet();
    let ([x, y, z], wo) = (direction(30.0, 10.0), direction(50.0, 200.0));
    let (mut there, mut back) = ([f32::NAN], [f32::NAN]);
    material.eval([x, y, z], [wo[0], wo[1], -wo[2]], &mut there);
    material.eval([wo[0], wo[1], -wo[2]], [x, y, z], &mut back);
    assert!(there[0] > 0.07 && there == back, "{there:?} {back:?}");
}

#[test]
#[cfg_attr(target_os = "wasi", ignore = "WASI has no folder for temporary files")]
fn sheets_open_from_the_files_of_their_sides() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    lobe::formats::ddr::write(&constant(Scatter::Reflection, 0.1), &path("front.ddr")).unwrap();
    lobe::formats::ddr::write(&constant(Scatter::Transmission, 0.05), &path("through.ddt")).unwrap();
    lobe::formats::ddr::write(&constant(Scatter::Reflection, 0.02), &path("back.ddr")).unwrap();
    let options = Options::default();
    let sheet = Material::open_sheet(&[path("front.ddr"), path("through.ddt")], &[path("back.ddr")], &options).unwrap();
    let (up, down) = ([0.6, 0.0, 0.8], [0.0, 0.6, -0.8]);
    let value = |wi, wo| {
        let mut out = [f32::NAN];
        sheet.eval(wi, wo, &mut out);
        out[0]
    };
    assert_eq!([value(up, up), value(down, down), value(up, down), value(down, up)], [0.1, 0.02, 0.05, 0.05]);
    let none: [&std::path::Path; 0] = [];
    assert!(Material::open_sheet(&none, &none, &options).unwrap_err().to_string().contains("no files"));
}
