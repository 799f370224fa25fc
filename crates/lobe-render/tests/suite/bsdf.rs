//! Any function of pairs of directions as a material of pictures.

use lobe::formats::{Document, Part};
use lobe::table::mirror;
use lobe::{Channels, Data, Material, Options, Scatter};
use lobe_model::Model;
use lobe_render::shader::{Backend, BsdfShader, Evaluated, Lobes, Sampled, Scratch, Shader};
use lobe_render::{Rgb, TransportMode};

use super::common::CLOTH;

type Vec3 = [f32; 3];

/// Asserts for known directions in both modes that samples have the weights and densities of the pairs.
fn assert_samples_agree(name: &str, shader: &BsdfShader, value: &dyn Fn([Vec3; 2]) -> [f32; 3]) {
    const SIDE: usize = 12;
    let n = SIDE * SIDE;
    let at = |i: usize| (i as f32 + 0.5) / SIDE as f32;
    let u: Vec<[f32; 2]> = (0..n).map(|i| [at(i % SIDE), at(i / SIDE)]).collect();
    for mode in [TransportMode::Radiance, TransportMode::Importance] {
        let known = vec![[0.48, 0.36, 0.8]; n];
        let (mut wi, mut weight, mut drawn) = (vec![[0.0; 3]; n], vec![[0.0; 3]; n], vec![0.0; n]);
        let out = Sampled { wi: &mut wi, weight: &mut weight, pdf: &mut drawn };
        shader.sample(mode, &known, &u, out, &mut Scratch::default());
        let (mut f, mut pdf) = (vec![[0.0; 3]; n], vec![0.0; n]);
        shader.eval(mode, &wi, &known, Evaluated { f: &mut f, pdf: &mut pdf }, &mut Scratch::default());
        let (mut apart, mut lit) = (0, 0);
        for i in (0..n).filter(|&i| drawn[i] > 0.0) {
            let pair = if mode == TransportMode::Radiance { [wi[i], known[i]] } else { [known[i], wi[i]] };
            let expected = value(pair).map(|f| f * wi[i][2].abs());
            let near = |a: f32, b: f32, tolerance: f32| (a - b).abs() <= tolerance * a.abs().max(b.abs()) + 1e-6;
            for k in 0..3 {
                assert!(near(f[i][k], expected[k], 1e-3), "{name}, {mode:?}: {:?}, not {expected:?}", f[i]);
                apart += usize::from(!near(weight[i][k] * drawn[i], f[i][k], 1e-3));
            }
            apart += usize::from(!near(drawn[i], pdf[i], 1e-2));
            lit += 1;
        }
        // At the edge of a cell, rounding may lead into the other cell.
        assert!(lit > n / 2 && apart <= lit / 50, "{name}, {mode:?}: {apart} apart of {lit}");
    }
}

#[test]
fn samples_for_given_viewers_and_for_given_lights_have_the_weights_of_pairs() {
    let backend = Backend::best();
    let open = || Material::open(CLOTH).unwrap().with_backend(backend);
    let (material, shader) = (open(), BsdfShader::measured(open()).unwrap());
    assert_samples_agree("cloth", &shader, &|[light, viewer]| {
        let mut out = [0.0; 3];
        material.eval(light, viewer, &mut out);
        out
    });
    let gold = lobe_model::Conductor {
        ggx: lobe_model::Ggx { alpha: [0.2, 0.4] },
        eta: [0.143, 0.375, 1.442],
        k: [3.983, 2.386, 1.603],
    };
    assert_samples_agree("gold", &BsdfShader::model(gold, backend).unwrap(), &|[light, viewer]| {
        gold.f(light.map(f64::from), viewer.map(f64::from)).map(|x| x as f32)
    });
}

#[test]
fn only_materials_with_mirrors_have_delta_lobes() {
    let table = Material::open(CLOTH).unwrap();
    assert_eq!(BsdfShader::<Rgb>::measured(table).unwrap().lobes(), Lobes::REFLECTION);
    let document = lobe::formats::open(CLOTH.as_ref()).unwrap().1;
    let mirror = mirror::Data::new(Scatter::Reflection, [vec![0.0], vec![0.0]], Channels::Rgb, vec![0.2; 3]);
    let mut parts = document.parts;
    parts.push(Part::new("", Data::Mirror(mirror.unwrap())));
    let both = Material::from_document(&Document::of_parts(parts), &Options::default()).unwrap();
    assert!(BsdfShader::<Rgb>::measured(both).unwrap().lobes().delta);
}
