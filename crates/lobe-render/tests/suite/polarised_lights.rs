//! Lamps and skies whose light is polarised.

use crate::spectra::{refused, seen, sheet, sheets};

fn near(found: [f64; 4], expected: [f64; 4], within: f64) {
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < within), "{found:?}, not {expected:?}");
}

#[test]
fn lights_are_seen_as_they_are_polarised() {
    let sky = |polarised: &str| sheets("") + &format!("polarised = {{ {polarised} }}\n");
    near(seen(&sky("axis = [1, 0, 0], stokes = [0.6, 0, 0.2]")), [1.0, 0.6, 0.0, 0.2], 1e-5);
    near(seen(&sky("axis = [0, 3, 0]")), [1.0, -1.0, 0.0, 0.0], 1e-5);
    near(seen(&sky("axis = [1, 1, 0], stokes = [0.5, 0, 0]")), [1.0, 0.0, 0.5, 0.0], 1e-5);
    // The sun is to the right: the sky behind the object is polarised along the vertical.
    near(seen(&sky("sun = [1, 0, 0], degree = 0.7")), [1.0, -0.7, 0.0, 0.0], 1e-3);
    let lamp = sheet("lamp", "model = \"lambert\"\nalbedo = 0", 0.0);
    let lamp = lamp.trim_end().to_owned() + "\nradiance = 2\npolarised = { axis = [1, 0, 0], stokes = [0, 0, -1] }\n";
    near(seen(&sheets(&lamp)), [2.0, 0.0, 0.0, -2.0], 1e-5);
}

/// Up to the corners of a wide view, the vertical is across the x axis of the film, and a polariser absorbs light along it.
#[test]
fn vertical_light_is_vertical_in_the_whole_picture() {
    let wide = |objects: &str| sheets(objects).replace("field_of_view = 1\n", "field_of_view = 100\n");
    near(seen(&(wide("") + "polarised = { axis = [0, 1, 0] }\n")), [1.0, -1.0, 0.0, 0.0], 1e-5);
    let polariser = sheet("near", "model = \"polariser\"\nangle = 0", 3.5);
    near(seen(&wide(&polariser)), [0.5, 0.5, 0.0, 0.0], 1e-5);
}

#[test]
fn a_polariser_passes_polarised_light_by_the_law_of_malus() {
    for degrees in [0.0, 30.0, 90.0] {
        let polariser = sheet("near", &format!("model = \"polariser\"\nangle = {degrees}"), 1.0);
        let [s0, ..] = seen(&(sheets(&polariser) + "polarised = { axis = [1, 0, 0] }\n"));
        let expected = f64::to_radians(degrees).cos().powi(2);
        assert!((s0 - expected).abs() < 1e-5, "{degrees} degrees: {s0}, not {expected}");
    }
}

/// Sampled lamps, and rough surfaces, at the angle at which smooth ones mirror light of one plane only.
#[test]
fn a_rough_surface_mirrors_light_of_one_plane() {
    let angle = 1.5f64.atan();
    let (y, z) = (4.0 * angle.cos(), 4.0 * angle.sin());
    let scene = |polarised: &str| {
        format!(
            "[camera]\nposition = [0, {y}, {z}]\ntarget = [0, 0, 0]\nfield_of_view = 0.02\n[film]\nwidth = 4\nheight = 4\n\
            [spectrum]\nstokes = true\n[integrator]\nsamples = 4\ndepth = 1\n\
            [material.lacquer]\nmodel = \"conductor\"\nalpha = 0.2\neta = 1.5\nk = 0\n\
            [[object]]\nshape = \"plane\"\nsize = 4\nmaterial = \"lacquer\"\n\
            [[light]]\nkind = \"point\"\nposition = [0, 1, 1]\nintensity = 0\n\
            [[light]]\nkind = \"directional\"\ndirection = [0, {}, {z}]\nirradiance = 1\n{polarised}",
            -y
        )
    };
    let across = seen(&scene("polarised = { axis = [1, 0, 0] }\n"));
    let within = seen(&scene("polarised = { axis = [0, 1, 0] }\n"));
    let unpolarised = seen(&scene(""));
    assert!(across[0] > 0.01 && within[0] < 0.02 * across[0], "{across:?} {within:?}");
    // S1 refers to the right of the picture, which is across the plane of incidence.
    assert!((across[1] / across[0] - 1.0).abs() < 1e-3, "{across:?}");
    for component in 0..4 {
        let mean = 0.5 * (across[component] + within[component]);
        assert!((unpolarised[component] - mean).abs() < 1e-3 * across[0], "{unpolarised:?}, not {mean}");
    }
}

#[test]
fn lights_that_cannot_be_are_refused() {
    let sky = |polarised: &str| sheets("") + &format!("polarised = {{ {polarised} }}\n");
    let dark = sheet("dark", "model = \"lambert\"\nalbedo = 0", 0.0);
    let point = "[[light]]\nkind = \"point\"\nposition = [0, 0, 1]\nintensity = 1\npolarised = { sun = [0, 1, 0] }\n";
    for (text, expected) in [
        (sky("axis = [1, 0, 0], stokes = [1, 1, 0]"), "found light that is 141.4 % polarised"),
        (sky("axis = [0, 0, 0]"), "direction of length 0"),
        (sky("stokes = [1, 0, 0]"), "expected either `axis` or `sun`"),
        (sky("axis = [1, 0, 0], sun = [0, 1, 0]"), "expected either `axis` or `sun`"),
        (sky("sun = [0, 1, 0], degree = 2"), "from 0 to 1"),
        (sky("axis = [1, 0, 0], degree = 0.5"), "no such key"),
        (sheets("") + point, "expected `axis`"),
        (sheets(&(dark + "polarised = { axis = [1, 0, 0] }\n")), "expected a shape that emits light"),
    ] {
        let error = refused(&text);
        assert!(error.contains(expected), "{error}, not {expected}");
    }
}
