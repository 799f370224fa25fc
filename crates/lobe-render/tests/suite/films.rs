//! Thin films in scenes.

use lobe_render::scene::AnyScene;
use lobe_render::shader::Backend;

use crate::spectra::{bands16, mean_colour, means, parse, picture, refused, settings};

/// A sheet that faces the camera, before a white sky, with what follows `[material.sheet]`.
fn before_sky(head: &str, material: &str) -> String {
    format!(
        "[camera]\nposition = [0, 0, 4]\ntarget = [0, 0, 0]\nfield_of_view = 1\n[film]\nwidth = 4\nheight = 4\n{head}\
        [integrator]\nsamples = 64\ndepth = 3\n[material.sheet]\n{material}\n\
        [[object]]\nshape = \"plane\"\nsize = 4\nrotate = [90, 0, 0]\nmaterial = \"sheet\"\n\
        [[light]]\nkind = \"environment\"\nradiance = 1\nspectrum = \"E\"\n"
    )
}

/// The light that a metal mirrors, at 16 wavelengths, relative to that of the sky.
fn mirrored(material: &str) -> Vec<f64> {
    let scene = bands16(&before_sky("[spectrum]\nbands = 16\n", material), Backend::best());
    means(&picture(&scene, &settings(&scene, 64, Backend::best())))
}

/// The light of the sky alone.
fn sky() -> Vec<f64> {
    let text = before_sky("[spectrum]\nbands = 16\n", "model = \"film\"\neta = 1.5\nthickness = 100");
    // Behind the camera.
    let scene =
        bands16(&text.replace("rotate = [90, 0, 0]", "rotate = [90, 0, 0]\ntranslate = [0, 0, 9]"), Backend::best());
    means(&picture(&scene, &settings(&scene, 64, Backend::best())))
}

#[test]
fn a_film_on_silver_takes_away_the_wavelengths_that_interfere() {
    let bare = mirrored("model = \"mirror\"\nmetal = \"silver\"");
    let thick = mirrored("model = \"mirror\"\nmetal = \"silver\"\nfilm = { eta = 2.4, thickness = 400 }");
    // A film of index 1 takes nothing from the light of the sky.
    let (sky, clear) = (sky(), mirrored("model = \"film\"\neta = 1\nthickness = 10"));
    assert!(clear.iter().zip(&sky).all(|(a, b)| (a / b - 1.0).abs() < 1e-4), "{clear:?}, not {sky:?}");
    assert!(thick.iter().zip(&sky).all(|(a, b)| *a <= b * (1.0 + 1e-4)), "{thick:?}");
    let ratios: Vec<f64> = thick.iter().zip(&bare).map(|(a, b)| a / b).collect();
    let [least, most] = [f64::min, f64::max].map(|fold| ratios.iter().copied().reduce(fold).unwrap());
    assert!(least < 0.98 && most - least > 0.03, "{ratios:?}");
    let none = mirrored("model = \"mirror\"\nmetal = \"silver\"\nfilm = { eta = 1, thickness = 400 }");
    for (none, bare) in none.iter().zip(&bare) {
        assert!((none / bare - 1.0).abs() < 1e-3, "{none}, not {bare}");
    }
}

#[test]
fn free_films_and_films_on_glass_neither_make_nor_lose_light() {
    let sky = sky();
    for material in [
        "model = \"film\"\neta = 1.33\nthickness = 350",
        "model = \"film\"\nglass = \"N-SF66\"\nthickness = 900",
        "model = \"glass\"\neta = 1.5\nfilm = { eta = 1.38, thickness = 100 }",
    ] {
        // The sky is white in all directions, on both sides; glass has only one surface, into which light is refracted.
        let inside = if material.contains("glass\"\neta") { 1.5 * 1.5 } else { 1.0 };
        let scene = bands16(&before_sky("[spectrum]\nbands = 16\n", material), Backend::best());
        let film = picture(&scene, &settings(&scene, 64, Backend::best()));
        let shares: Vec<f64> = means(&film).iter().zip(&sky).map(|(band, sky)| band / sky).collect();
        for share in &shares {
            // What passes into the glass is radiance of the denser medium. Reflection is chosen for all bands at once.
            assert!(*share < 1.03 && *share > 0.9 / inside, "{material}: {share}");
            assert!(inside > 1.0 || (share - 1.0).abs() < 0.03, "{material}: {share}");
        }
        // The mean of all bands has no noise.
        let mean = shares.iter().sum::<f64>() / 16.0;
        assert!(inside > 1.0 || (mean - 1.0).abs() < 1e-3, "{material}: {mean}");
    }
}

#[test]
fn rough_films_have_the_colours_of_their_spectra() {
    let material = "model = \"conductor\"\nmetal = \"titanium\"\nalpha = 0.3\nfilm = { eta = 2.4, thickness = 60 }";
    let white = |text: String| text.replace("spectrum = \"E\"", "");
    let AnyScene::Rgb(plain) = parse(&white(before_sky("", material)), Backend::best()) else { panic!("not a colour") };
    let expected = mean_colour(&plain, &picture(&plain, &settings(&plain, 64, Backend::best())));
    let spectral = bands16(&white(before_sky("[spectrum]\nbands = 16\n", material)), Backend::best());
    let found = mean_colour(&spectral, &picture(&spectral, &settings(&spectral, 64, Backend::best())));
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < 0.03, "{found}, not {expected}");
    }
    let bare = "model = \"conductor\"\nmetal = \"titanium\"\nalpha = 0.3";
    let AnyScene::Rgb(bare) = parse(&white(before_sky("", bare)), Backend::best()) else { panic!("not a colour") };
    let bare = mean_colour(&bare, &picture(&bare, &settings(&bare, 64, Backend::best())));
    let [red, _, blue] = [0, 1, 2].map(|k| expected[k] / bare[k]);
    assert!((red - blue).abs() > 0.05, "a film has a colour: {expected:?}, {bare:?}");
}

#[test]
fn films_on_plastic_colour_it_and_make_no_light() {
    let plastic = |film: &str| mirrored(&format!("model = \"plastic\"\nalbedo = 1\nalpha = 0.3\n{film}"));
    let (bare, coated) = (plastic(""), plastic("film = { eta = 2.2, thickness = 200 }"));
    let sky = sky();
    assert!(coated.iter().zip(&sky).all(|(a, b)| *a < b * 1.01 && *a > 0.5 * b), "{coated:?}");
    let ratios: Vec<f64> = coated.iter().zip(&bare).map(|(a, b)| a / b).collect();
    let [least, most] = [f64::min, f64::max].map(|fold| ratios.iter().copied().reduce(fold).unwrap());
    assert!(most - least > 0.05, "{ratios:?}");
    // A film of the index of the coat is not there.
    let same = plastic("film = { eta = 1.5, thickness = 300 }");
    for (same, bare) in same.iter().zip(&bare) {
        assert!((same / bare - 1.0).abs() < 0.02, "{same}, not {bare}");
    }
}

#[test]
fn mistakes_in_films_are_named() {
    for (material, expected) in [
        ("model = \"film\"\neta = 1.33", "thickness"),
        ("model = \"film\"\neta = 1.33\nthickness = 9000", "from 1 to 5000"),
        ("model = \"glass\"\nglass = \"BK7\"\nfilm = { eta = 1.3, thickness = 100 }", "expected glass with `eta`"),
        ("model = \"mirror\"\nmetal = \"gold\"\nfilm = { eta = 1.3, thickness = 100, tint = 1 }", "no such key"),
        ("model = \"lambert\"\nalbedo = 1\nfilm = { eta = 1.3, thickness = 100 }", "no such key"),
        ("model = \"mirror\"\nfilm = { eta = 1.3, thickness = 100 }", "no such key"),
    ] {
        let error = refused(&before_sky("", material));
        assert!(error.contains(expected), "{error}, not {expected}");
    }
}
