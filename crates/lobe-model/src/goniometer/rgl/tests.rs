use lobe_table::rgl::{Reference, UniformOrder};

use super::*;
use crate::{Conductor, Ggx, Lambert, Mix, Model, Phong, Rgb as OfModel, albedo, halton};

fn gold(alpha: [f64; 2]) -> Conductor {
    Conductor { ggx: Ggx { alpha }, eta: [0.143, 0.375, 1.442], k: [3.983, 2.386, 1.603] }
}

fn measured(model: &(impl Model + Sync), resolution: Resolution) -> rgl::Data {
    measure(&OfModel(model), resolution, || {}).expect("a material")
}

/// Pairs of directions, half of them spread in proportion to their cosines, half near the mirror direction; none within
/// six degrees of the horizon.
fn pairs() -> impl Iterator<Item = (Vec3, Vec3)> {
    (1..4000).filter_map(|n| {
        let [a, b, c, d] = halton(n);
        let (wi, near) = (spherical(a.sqrt().asin(), TAU * d), spherical(0.3 * b, TAU * c));
        let wo = if n.is_multiple_of(2) { spherical(b.sqrt().asin(), TAU * c) } else { reflect(wi, near) };
        (wi[2] > 0.1 && wo[2] > 0.1).then_some((wi, wo))
    })
}

/// The median of the errors relative to the value, and their 95th percentile.
fn errors(model: &(impl Model + Sync), resolution: Resolution) -> [f64; 2] {
    let reference = Reference::new(&measured(model, resolution));
    let mut errors = Vec::new();
    for (wi, wo) in pairs() {
        let mut got = [0.0; 3];
        reference.eval(wi, wo, &mut got);
        let expected = model.f(wi, wo);
        errors.extend((0..3).map(|c| (got[c] - expected[c]).abs() / expected[c]));
    }
    errors.sort_by(f64::total_cmp);
    [errors[errors.len() / 2], errors[errors.len() * 95 / 100]]
}

#[test]
fn every_texel_is_reproduced() {
    let isotropic = Resolution { theta_i: 5, phi_i: 1, ndf: 32, microfacets: 16, spectra: 9 };
    let anisotropic = Resolution { phi_i: 4, ..isotropic };
    for (model, resolution) in [(gold([0.3, 0.3]), isotropic), (gold([0.2, 0.5]), anisotropic)] {
        let rgl = measured(&model, resolution);
        let (reference, warp) = (Reference::new(&rgl), Warp::new(&rgl.parts().vndf));
        let parts = rgl.parts();
        let (mut seen, mut worst) = (0, 0.0_f64);
        for slice in 0..parts.phi_i.len() * parts.theta_i.len() {
            let (p, t) = (slice / parts.theta_i.len(), slice % parts.theta_i.len());
            let wi = spherical(f64::from(parts.theta_i[t]), f64::from(parts.phi_i[p]));
            let blend = Blend { terms: [(slice, 1.0), (slice, 0.0), (slice, 0.0), (slice, 0.0)] };
            // At the zenith, every azimuth is the first.
            for s in positions(9).filter(|s| t > 0 && s.iter().all(|x| *x > 0.0 && *x < 1.0)) {
                let (u, _) = warp.sample(s, &blend);
                let wo = reflect(wi, spherical(theta(u[0]), phi(u[1])));
                if wo[2] > 0.05 {
                    let mut got = [0.0; 3];
                    reference.eval(wi, wo, &mut got);
                    let expected = model.f(wi, wo);
                    worst = (0..3).fold(worst, |worst, c| worst.max((got[c] - expected[c]).abs() / expected[c]));
                    seen += 1;
                }
            }
        }
        assert!(seen > 100 && worst < 1e-5, "{worst} at {seen} texels");
    }
}

#[test]
fn values_between_texels_are_close() {
    let iso = Resolution { microfacets: 64, ..Resolution::ISOTROPIC };
    let dusty = Mix { a: gold([0.25, 0.25]), b: Lambert { albedo: [0.35, 0.3, 0.28] }, share: 0.2 };
    let matte = Lambert { albedo: [0.5; 3] };
    for (name, [median, most], bounds) in [
        ("gold", errors(&gold([0.25, 0.25]), iso), [2e-4, 5e-3]),
        ("dusty gold", errors(&dusty, iso), [5e-4, 5e-3]),
        ("matte", errors(&matte, iso), [1e-3, 1e-2]),
        ("brushed gold", errors(&gold([0.2, 0.4]), Resolution::ANISOTROPIC), [2e-3, 3e-2]),
    ] {
        println!("{name}: median {median:.1e}, 95 % below {most:.1e}");
        assert!(median < bounds[0] && most < bounds[1], "{name}: median {median:.1e}, 95 % below {most:.1e}");
    }
}

#[test]
fn samples_carry_the_albedo() {
    for model in [gold([0.3, 0.3]), gold([0.2, 0.5])] {
        let isotropic = model.ggx.alpha[0] == model.ggx.alpha[1];
        let resolution =
            if isotropic { Resolution { microfacets: 64, ..Resolution::ISOTROPIC } } else { Resolution::ANISOTROPIC };
        let reference = Reference::new(&measured(&model, resolution));
        for zenith in [0.2, 0.9, 1.3] {
            let wi = spherical(zenith, 0.7);
            let count = 20_000;
            let mut mean = [0.0; 3];
            let mut heaviest = 0.0_f64;
            for n in 1..=count {
                let [a, b, ..] = halton(n);
                if let Some(drawn) = reference.sample(wi, [a, b], UniformOrder::default()) {
                    (0..3).for_each(|c| mean[c] += drawn.weight[c] / f64::from(count));
                    heaviest = heaviest.max(drawn.weight[0]);
                }
            }
            for (got, expected) in mean.into_iter().zip(albedo(&model, wi, 150)) {
                assert!((got - expected).abs() < 0.01, "{got} instead of {expected} at {zenith}");
            }
            assert!(heaviest < 5.0, "a weight of {heaviest} at {zenith}");
        }
    }
}

#[test]
fn surfaces_without_retroreflection_have_facets_too() {
    let coarse = Resolution { theta_i: 4, phi_i: 1, ndf: 16, microfacets: 16, spectra: 8 };
    let black = measured(&Lambert { albedo: [0.0; 3] }, coarse);
    assert!(black.parts().spectra.texels().iter().all(|value| *value == 0.0));
    // A narrow lobe has retroreflection only along the normal, and keeps its peak.
    let narrow = Phong { specular: [1.0; 3], exponent: 400.0 };
    let [median, _] = errors(&Mix { a: narrow, b: Lambert { albedo: [0.1; 3] }, share: 0.5 }, Resolution::ISOTROPIC);
    assert!(median < 5e-3, "{median}");
}

#[test]
fn errors_name_the_wrong_part() {
    let matte = OfModel(Lambert { albedo: [0.5; 3] });
    let refused = |resolution| measure(&matte, resolution, || {}).expect_err("too coarse").part;
    let least = Resolution { theta_i: 2, phi_i: 1, ndf: 2, microfacets: 2, spectra: 2 };
    assert!(measure(&matte, least, || {}).is_ok());
    assert_eq!(refused(Resolution { theta_i: 1, ..least }), "resolution");
    assert_eq!(refused(Resolution { phi_i: 2, ..least }), "resolution");
    assert_eq!(refused(Resolution { spectra: 1, ..least }), "resolution");
}
