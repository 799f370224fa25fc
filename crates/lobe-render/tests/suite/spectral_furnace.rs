//! Furnaces of wavelengths and of polarised light: under an even sky, what loses no light is invisible in every band, and
//! light stays unpolarised.

use lobe_render::scene::{AnyScene, Scene};
use lobe_render::shader::Backend;
use lobe_render::{Stokes16, Transport};

use crate::spectra::{bands16, means, parse, picture, settings};

const SKY: &str = "[[light]]\nkind = \"environment\"\nradiance = 1\nspectrum = \"E\"\n";
const BANDS: usize = 9;

/// A material on a sphere before an even sky; `None` is the sky alone.
fn scene(stokes: bool, material: Option<&str>) -> String {
    let object = material.map(|material| {
        format!(
            "[material.white]\n{material}\n\
             [[object]]\nshape = \"sphere\"\nradius = 0.5\ntranslate = [0.1, 0, 0]\nmaterial = \"white\"\n"
        )
    });
    format!(
        "[camera]\nposition = [0, 0, 2]\ntarget = [0, 0, 0]\n[film]\nwidth = 24\nheight = 24\n\
         [spectrum]\nwavelengths = [400, 430, 460, 490, 530.5, 560, 590, 640, 700]\nstokes = {stokes}\n\
         [integrator]\nsamples = 64\ndepth = 60\n{}{SKY}",
        object.unwrap_or_default()
    )
}

fn stokes16(text: &str) -> Scene<Stokes16> {
    match parse(text, Backend::best()) {
        AnyScene::Stokes16(scene) => scene,
        other => panic!("{other:?}"),
    }
}

fn seen<T: Transport>(scene: &Scene<T>) -> Vec<f64> {
    means(&picture(scene, &settings(scene, 64, Backend::best())))
}

/// Materials that lose nothing, and how far the mean of a picture may be off: the noise of the choice between mirrored
/// and refracted light, which paths of one wavelength each make after dispersion.
const WHITE: [(&str, f64); 7] = [
    ("model = \"lambert\"\nalbedo = 1", 2e-3),
    ("model = \"mirror\"\nreflectance = 1", 1e-5),
    ("model = \"glass\"\neta = 1.5", 4e-3),
    ("model = \"glass\"\nglass = \"BK7\"", 2e-2),
    ("model = \"film\"\neta = 1.33\nthickness = 400", 4e-3),
    ("model = \"glass\"\neta = 1.5\nfilm = { eta = 1.38, thickness = 100 }", 1e-2),
    ("model = \"retarder\"\nangle = 30\nretardance = 70", 1e-5),
];

#[test]
fn white_objects_vanish_in_every_band() {
    let sky = seen(&bands16(&scene(false, None), Backend::best()));
    assert!(sky[..BANDS].iter().all(|band| *band > 0.5) && sky[BANDS..].iter().all(|band| *band == 0.0), "{sky:?}");
    for (material, within) in WHITE {
        let found = seen(&bands16(&scene(false, Some(material)), Backend::best()));
        for (band, sky) in found.iter().zip(&sky).take(BANDS) {
            assert!((band / sky - 1.0).abs() < within, "{material}: {found:?}, not {sky:?}");
        }
    }
}

#[test]
fn light_in_equilibrium_is_not_polarised() {
    let sky = seen(&stokes16(&scene(true, None)));
    for (material, within) in WHITE {
        let found = seen(&stokes16(&scene(true, Some(material))));
        for band in 0..BANDS {
            let [s0, s1, s2, s3] = [0, 16, 32, 48].map(|row| found[row + band] / sky[band]);
            assert!((s0 - 1.0).abs() < within, "{material}, band {band}: {s0}");
            assert!([s1, s2, s3].iter().all(|s| s.abs() < within), "{material}, band {band}: {s1} {s2} {s3}");
        }
    }
}
