//! RGL materials against the loader of the database and Mitsuba.

use lobe_formats::rgl;
use lobe_table::rgl::{Data, Reference, UniformOrder};
use lobe_testing::files::shared;
use lobe_testing::golden::{Worst, direction, queries, relative, unit};
use std::fs;
use std::path::Path;

fn load(path: &Path) -> Data {
    rgl::read(&fs::read(path).expect("file"), path).expect("an RGL material")
}

/// The queries of an answer, split at the columns `wi wo u0 u1 -> values pdf wo.xyz pdf weights`.
///
/// `floor` is the value below which errors are absolute: the references compute in single precision, which does not
/// resolve very small values at the foot of a steep peak any better. Returns the largest error of the values, of the
/// density and of the sample.
fn powitacq(material: &Data, queries: &[(Vec<f64>, Vec<f64>)], floor: f64) -> [Worst; 3] {
    // The loader of the database returns no negative values.
    let reference = Reference::new(material).clamp_negative(true);
    let channels = material.parts().channels.count();
    let mut worst: [Worst; 3] = Default::default();
    let mut values = vec![0.0; channels];
    for (at, (query, answer)) in queries.iter().enumerate() {
        let (wi, wo) = (unit(query, 0), unit(query, 3));
        reference.eval_cos(wi, wo, &mut values);
        values.iter().zip(answer).for_each(|(a, b)| worst[0].see(relative(*a, *b, floor), at));
        worst[1].see(relative(reference.pdf(wi, wo), answer[channels], floor), at);
        let drawn = &answer[channels + 1..];
        match reference.sample(wi, [query[6], query[7]], UniformOrder::Powitacq) {
            Some(sample) => {
                sample.wo.iter().zip(direction(drawn, 0)).for_each(|(a, b)| worst[2].see((a - b).abs(), at));
                sample.weight.iter().zip(&drawn[4..]).for_each(|(a, b)| worst[2].see(relative(*a, *b, 1e-3), at));
                // Close to the pole of the half vector, the density rises without bound, and with it the effect of the
                // last digit of a single-precision position.
                worst[2].see(relative(sample.pdf, drawn[3], 1e-3) / (1.0 + sample.pdf / 100.0), at);
            }
            None => assert!(drawn.iter().all(|x| *x == 0.0), "query {at}: no sample, but {drawn:?}"),
        }
    }
    worst
}

#[test]
fn synthetic_materials_match_the_loader_of_the_database() {
    let Some(shared) = shared() else { return };
    for name in ["rgl_iso_rgb", "rgl_iso_spec", "rgl_aniso_rgb", "rgl_aniso_spec"] {
        let material = load(&shared.join("golden").join(format!("{name}.bsdf")));
        let queries = queries(&shared.join(format!("golden/{name}.powitacq.txt")));
        assert_eq!(queries.len(), 150);
        let [eval, pdf, sample] = powitacq(&material, &queries, 1e-7);
        println!("{name}: eval {eval:?}, pdf {pdf:?}, sample {sample:?}");
        assert!(eval.error < 1e-5 && pdf.error < 1e-5 && sample.error < 1e-4, "{name}");
    }
}

#[test]
fn real_materials_match_the_loader_of_the_database() {
    let Some(shared) = shared() else { return };
    for name in ["cc_ibiza_sunset", "cc_iris_purple_gem", "colodur_napoli_4f", "paper_white", "vch_golden_yellow"] {
        let material = load(&shared.join("data/rgl_bsdf").join(format!("{name}_rgb.bsdf")));
        let queries = queries(&shared.join(format!("golden/real_{name}_rgb.bsdf.powitacq.txt")));
        assert_eq!(queries.len(), 300);
        let [eval, pdf, sample] = powitacq(&material, &queries, 1e-3);
        println!("{name}: eval {eval:?}, pdf {pdf:?}, sample {sample:?}");
        assert!(eval.error < 1e-4 && pdf.error < 1e-4 && sample.error < 1e-4, "{name}");
    }
}

/// Half the azimuths stored, and no microfacet factor; both with interpolated wavelengths.
#[test]
fn reduced_and_unweighted_materials_match_mitsuba() {
    let Some(shared) = shared() else { return };
    for (name, reduction, jacobian) in [("rgl_aniso_spec_r2", 2, true), ("rgl_iso_spec_nojac", 1, false)] {
        let material = load(&shared.join("golden").join(format!("{name}.bsdf")));
        assert_eq!((material.reduction(), material.parts().jacobian), (reduction, jacobian));
        let reference = Reference::new(&material);
        let queries = queries(&shared.join(format!("golden/{name}.mitsuba.txt")));
        assert_eq!(queries.len(), 100);
        let (mut eval, mut pdf) = (Worst::default(), Worst::default());
        let mut stored = [0.0; 7];
        for (at, (query, answer)) in queries.iter().enumerate() {
            let (wi, wo) = (unit(query, 0), unit(query, 3));
            reference.eval_cos(wi, wo, &mut stored);
            stored.iter().zip(answer).for_each(|(a, b)| eval.see(relative(*a, *b, 1e-7), at));
            for (nm, expected) in [425.0, 475.0, 525.0, 620.0].into_iter().zip(&answer[7..]) {
                let value = reference.eval_cos_at(wi, wo, nm).expect("a spectral material");
                eval.see(relative(value, *expected, 1e-7), at);
            }
            // Beyond the stored wavelengths, the value is constant.
            assert_eq!(reference.eval_cos_at(wi, wo, 380.0), Some(stored[0]));
            assert_eq!(reference.eval_cos_at(wi, wo, 800.0), Some(stored[6]));
            pdf.see(relative(reference.pdf(wi, wo), answer[11], 1e-7), at);
        }
        println!("{name}: eval {eval:?}, pdf {pdf:?}");
        assert!(eval.error < 1e-5 && pdf.error < 1e-5, "{name}");
    }
}

#[test]
fn real_materials_match_mitsuba_without_the_cosine() {
    let Some(shared) = shared() else { return };
    let text = fs::read_to_string(shared.join("golden/real_rgl.mitsuba.json")).expect("golden file");
    let golden: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let mut worst = Worst::default();
    let mut seen = 0;
    for (name, material) in golden.as_object().expect("materials by name") {
        let path = shared.join("data").join(name);
        if !path.exists() {
            println!("SKIPPED: no {}", path.display());
            continue;
        }
        let rgl = load(&path);
        let reference = Reference::new(&rgl);
        for (at, eval) in material["evals"].as_array().expect("evals").iter().enumerate() {
            let number = |i: usize| eval[i].as_f64().expect("degrees").to_radians();
            let (theta_i, theta_o, phi) = (number(0), number(1), number(2));
            let wi = [theta_i.sin(), 0.0, theta_i.cos()];
            let wo = [theta_o.sin() * phi.cos(), theta_o.sin() * phi.sin(), theta_o.cos()];
            let mut f = [0.0; 3];
            reference.eval(wi, wo, &mut f);
            for (value, expected) in f.iter().zip(eval[3].as_array().expect("RGB")) {
                let expected = expected.as_f64().expect("a value");
                worst.see(relative(*value, expected, 1e-2), at);
                seen += 1;
            }
        }
    }
    println!("{seen} values: {worst:?}");
    assert!(seen >= 5 * 9 * 3 && worst.error < 1e-4);
}

/// Samples of the reference must agree with its evaluation to the digits of `f64`, for both orders of the uniforms.
#[test]
fn samples_have_the_density_and_the_value_of_their_direction() {
    let Some(shared) = shared() else { return };
    for name in ["golden/rgl_aniso_rgb.bsdf", "golden/rgl_aniso_spec_r2.bsdf", "data/rgl_bsdf/paper_white_rgb.bsdf"] {
        let material = load(&shared.join(name));
        let reference = Reference::new(&material);
        let mut value = vec![0.0; material.parts().channels.count()];
        let mut drawn = 0;
        for n in 0..200 {
            // An additive sequence fills both the square of uniforms and the hemisphere of directions.
            let at = |step: f64| (0.5 + f64::from(n) * step).fract();
            let uniform = [at(0.754877666), at(0.569840291)];
            let (theta, phi) = (1.4 * at(0.618033989), std::f64::consts::TAU * at(0.414213562));
            let wi = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
            let sample = reference.sample(wi, uniform, UniformOrder::Powitacq);
            let swapped = reference.sample(wi, [uniform[1], uniform[0]], UniformOrder::Pbrt);
            assert_eq!(sample, swapped);
            let Some(sample) = sample else { continue };
            drawn += 1;
            let pdf = reference.pdf(wi, sample.wo);
            assert!(relative(pdf, sample.pdf, 0.0) < 1e-9, "{name} {n}: {pdf} and {}", sample.pdf);
            reference.eval_cos(wi, sample.wo, &mut value);
            for (value, weight) in value.iter().zip(&sample.weight) {
                assert!(relative(value / pdf, *weight, 1e-6) < 1e-9, "{name} {n}: {} and {weight}", value / pdf);
            }
        }
        assert!(drawn > 100, "{name}: {drawn} of 200 samples are above the surface");
    }
}

#[test]
fn written_files_are_read_back() {
    let Some(shared) = shared() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["golden/rgl_iso_spec_nojac.bsdf", "golden/rgl_aniso_rgb.bsdf", "data/rgl_bsdf/paper_white_rgb.bsdf"] {
        let material = load(&shared.join(name));
        let path = folder.path().join("copy.bsdf");
        rgl::write(&material, &path).expect("written");
        assert_eq!(load(&path), material, "{name}");
        assert!(rgl::matches(&fs::read(&path).expect("written")));
        // The fields of the container, each where the format requires it.
        let bytes = fs::read(&path).expect("written");
        let fields = lobe_formats::tensor::read(&bytes, &path).expect("a tensor file").fields;
        assert!(fields.iter().any(|field| field.name == "vndf" && field.shape.len() == 4));
    }
    let names: Vec<_> = fs::read_dir(folder.path()).expect("folder").collect();
    assert_eq!(names.len(), 1, "no temporary file stays");
}
