//! The requirements on the parts of a material, and the symmetries of a reduced one.

use super::*;
use crate::Channels;

fn ramp(part: &'static str, shape: [usize; 3], seed: usize) -> Images {
    let texels = (0..shape.iter().product()).map(|i| 0.1 + ((i * 13 + seed) % 17) as f32 / 17.0).collect();
    Images::new(part, shape, texels).expect("valid images")
}

/// A material with these azimuths, three zenith angles and two wavelengths.
fn parts(phi_i: Vec<f32>) -> Parts {
    let incident = phi_i.len() * 3;
    Parts {
        description: "ramps".into(),
        phi_i,
        theta_i: vec![0.0, 0.7, 1.5],
        ndf: ramp("ndf", [1, 4, 5], 0),
        sigma: ramp("sigma", [1, 3, 4], 1),
        vndf: ramp("vndf", [incident, 5, 4], 2),
        luminance: ramp("luminance", [incident, 4, 4], 3),
        channels: Channels::Spectral(vec![500.0, 600.0]),
        spectra: ramp("spectra", [incident * 2, 4, 4], 4),
        jacobian: true,
        valid: None,
    }
}

const PI_F32: f32 = std::f32::consts::PI;

#[test]
fn reduction_follows_the_span_of_the_azimuths() {
    let reduction = |phi_i: &[f32]| Data::new(parts(phi_i.to_vec())).map(|rgl| rgl.reduction());
    assert_eq!(reduction(&[0.0]), Ok(1));
    assert_eq!(reduction(&[-PI_F32, PI_F32]), Ok(1));
    assert_eq!(reduction(&[-PI_F32, 0.0, PI_F32]), Ok(1));
    assert_eq!(reduction(&[-PI_F32, -1.0, 0.0]), Ok(2));
    assert_eq!(reduction(&[-PI_F32, -2.0, -PI_F32 / 2.0]), Ok(4));
    assert_eq!(reduction(&[0.0, 1.0, 2.0]).expect_err("a third of a turn").part, "phi_i");
}

/// All signs of x and y are mapped to the stored quarter.
#[test]
fn a_quarter_stands_for_all_mirror_images() {
    let rgl = Data::new(parts(vec![-PI_F32, -2.0, -PI_F32 / 2.0])).expect("a valid material");
    let reference = Reference::new(&rgl);
    let (wi, wo) = ([-0.48, -0.6, 0.64], [0.36, -0.48, 0.8]);
    let values = |wi, wo| {
        let mut values = [0.0; 2];
        reference.eval_cos(wi, wo, &mut values);
        (values, reference.pdf(wi, wo))
    };
    let stored = values(wi, wo);
    assert!(stored.0[0] > 0.0 && stored.1 > 0.0);
    let drawn = reference.sample(wi, [0.2, 0.9], UniformOrder::Pbrt).expect("a sample above the surface");
    for [x, y] in [[1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
        let mirror = |d: [f64; 3]| [d[0] * x, d[1] * y, d[2]];
        assert_eq!(values(mirror(wi), mirror(wo)), stored);
        let mirrored = reference.sample(mirror(wi), [0.2, 0.9], UniformOrder::Pbrt).expect("the same sample");
        assert_eq!(mirror(mirrored.wo), drawn.wo);
    }
}

#[test]
fn nothing_scatters_below_the_surface() {
    let rgl = Data::new(parts(vec![0.0])).expect("a valid material");
    let reference = Reference::new(&rgl);
    let (up, down) = ([0.6, 0.0, 0.8], [0.6, 0.0, -0.8]);
    for (wi, wo) in [(up, down), (down, up), ([1.0, 0.0, 0.0], up)] {
        let mut values = [9.0; 2];
        reference.eval(wi, wo, &mut values);
        assert_eq!((values, reference.pdf(wi, wo)), ([0.0; 2], 0.0));
    }
    assert_eq!(reference.sample(down, [0.5, 0.5], UniformOrder::Pbrt), None);
    assert_eq!(reference.eval_cos_at(up, down, 550.0), Some(0.0));
}

#[test]
fn negative_values_stay_unless_they_are_clamped() {
    let mut negative = parts(vec![0.0]);
    let size = negative.spectra.size();
    negative.spectra = Images::new("spectra", [6, size[0], size[1]], vec![-1.0; 96]).expect("valid images");
    let rgl = Data::new(negative).expect("a valid material");
    let (wi, wo) = ([0.6, 0.0, 0.8], [-0.6, 0.0, 0.8]);
    let mut values = [0.0; 2];
    Reference::new(&rgl).eval(wi, wo, &mut values);
    assert!(values[0] < 0.0 && values[1] < 0.0);
    Reference::new(&rgl).clamp_negative(true).eval(wi, wo, &mut values);
    assert_eq!(values, [0.0; 2]);
}

#[test]
fn errors_name_the_wrong_part() {
    let refused = |change: fn(&mut Parts)| {
        let mut changed = parts(vec![0.0]);
        change(&mut changed);
        Data::new(changed).expect_err("parts that do not fit").part
    };
    assert_eq!(refused(|p| p.phi_i = vec![]), "phi_i");
    assert_eq!(refused(|p| p.phi_i = vec![0.0, 0.0]), "phi_i");
    assert_eq!(refused(|p| p.theta_i = vec![0.0, f32::NAN, 1.0]), "theta_i");
    assert_eq!(refused(|p| p.theta_i = vec![0.0, 0.7, 90.0]), "theta_i");
    assert_eq!(refused(|p| p.ndf = ramp("ndf", [2, 4, 5], 0)), "ndf");
    assert_eq!(refused(|p| p.sigma = ramp("sigma", [2, 4, 5], 0)), "sigma");
    assert_eq!(refused(|p| p.vndf = ramp("vndf", [2, 4, 5], 0)), "vndf");
    assert_eq!(refused(|p| p.luminance = ramp("luminance", [4, 4, 5], 0)), "luminance");
    assert_eq!(refused(|p| p.spectra = ramp("spectra", [3, 4, 5], 0)), "spectra");
    assert_eq!(refused(|p| p.channels = Channels::Rgb), "rgb");
    assert_eq!(refused(|p| p.channels = Channels::Mono), "channels");
    assert_eq!(refused(|p| p.channels = Channels::Spectral(vec![600.0, 500.0])), "wavelengths");
    assert_eq!(refused(|p| p.sigma = Images::new("sigma", [1, 2, 2], vec![0.0; 4]).expect("valid")), "sigma");
    let images = |shape, n| Images::new("test", shape, vec![1.0; n]).expect_err("no images").part;
    assert_eq!(images([0, 2, 2], 0), "test");
    assert_eq!(images([1, 1, 2], 2), "test");
    assert_eq!(images([1, 2, 2], 5), "test");
    assert_eq!(images([usize::MAX, 2, 2], 4), "test");
    assert!(Images::new("test", [1, 2, 2], vec![1.0, 2.0, f32::INFINITY, 3.0]).is_err());
}
