//! Furnace tests: under a uniform white sky, an object that loses no light is invisible.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use lobe::{Channels, Edges, Options, Scatter, specular};
use lobe_model::{Conductor, Ggx};
use lobe_render::integrator::Integrator;
use lobe_render::light::{AreaLight, Environment, Light};
use lobe_render::shader::{Backend, BsdfShader, Delta, DeltaShader, Shader, open, open_sheet};
use lobe_render::{Rgb, World, WorldBuilder};

use super::common::*;

fn furnace(shader: Arc<dyn Shader>) -> World {
    let mut world = WorldBuilder::new();
    let material = world.material(shader);
    world.shape(&sphere([0.0, 0.5, 0.0], 1.0), material, None, false).unwrap();
    world.light(Light::Environment(Environment::constant([1.0; 3]).unwrap()));
    world.build().unwrap()
}

/// A file whose every value is `albedo / pi`.
fn even(folder: &Path, scatter: Scatter, albedo: f32) -> PathBuf {
    // As many nodes as a small measurement has: directions are sampled from histograms of the size of the table.
    let steps = |n: usize, step: f64| (0..n).map(|i| (step * i as f64).to_radians()).collect::<Vec<_>>();
    let knots = [steps(10, 10.0), steps(3, 120.0), steps(19, 10.0), steps(12, 30.0)];
    let values = vec![albedo * std::f32::consts::FRAC_1_PI; 10 * 3 * 19 * 12];
    let samples = specular::Data::new(scatter, knots, Channels::Mono, values).unwrap();
    let path = folder.join(if scatter == Scatter::Reflection { "even.ddr" } else { "even.ddt" });
    lobe::formats::ddr::write(&samples, &path).unwrap();
    path
}

/// The largest difference of a pixel from 1, and the difference of the mean.
fn from_white(world: &World, integrator: Arc<dyn Integrator>) -> (f64, f64) {
    let film = picture(world, &settings([48, 40], 64, integrator));
    let pixels = film.pixels().iter().flat_map(|pixel| pixel.mean_radiance());
    let largest = pixels.map(|x| (f64::from(x) - 1.0).abs()).fold(0.0, f64::max);
    (largest, (mean(&film) - 1.0).abs())
}

#[test]
fn white_surfaces_vanish_in_a_white_sky() {
    let folder = folder();
    let white = even(folder.path(), Scatter::Reflection, 1.0);
    let table = open(&white, &Options::default(), Backend::best()).unwrap();
    let oren_nayar = lobe_model::OrenNayar { albedo: [1.0; 3], roughness: 0.0 };
    let shaders: [(&str, Arc<dyn Shader>, f64, f64); 4] = [
        ("lambert", lambert(1.0, Backend::best()), 0.08, 2e-3),
        ("table", table, 0.25, 3e-3),
        ("model", Arc::new(BsdfShader::<Rgb>::model(oren_nayar, Backend::best()).unwrap()), 0.25, 3e-3),
        ("mirror", Arc::new(DeltaShader(Delta::Mirror([1.0; 3]))), 0.05, 1e-3),
    ];
    for (name, shader, pixel, whole) in shaders {
        let world = furnace(shader);
        let (largest, mean) = from_white(&world, path_tracing());
        assert!(largest < pixel && mean < whole, "path, {name}: a pixel is {largest} off, the mean {mean}");
        // Convex objects receive only direct light.
        let (largest, mean) = from_white(&world, whitted(4));
        assert!(largest < 2.0 * pixel && mean < 6e-3, "whitted, {name}: a pixel is {largest} off, the mean {mean}");
    }
}

/// Colours that the channels cannot represent have negative values, and so does noise around 0.
#[test]
fn negative_values_are_kept() {
    let folder = folder();
    let file = even(folder.path(), Scatter::Reflection, -0.25);
    let edges = Edges { non_negative: false, ..Edges::default() };
    let world = furnace(open(&file, &Options { edges, ..Options::default() }, Backend::best()).unwrap());
    for integrator in [path_tracing(), whitted(2)] {
        let film = picture(&world, &settings([48, 40], 64, integrator.clone()));
        let seen = film.pixels()[film.index(24, 20)].mean_radiance();
        assert!(seen.iter().all(|x| (x + 0.25).abs() < 0.03), "{integrator:?}: {seen:?}");
    }
}

#[test]
fn glass_loses_nothing_when_all_of_its_rays_are_followed() {
    let world = furnace(Arc::new(DeltaShader(Delta::Glass { eta: 1.5, tint: [1.0; 3] })));
    for integrator in [path_of(60), whitted(16)] {
        let (_, mean) = from_white(&world, integrator.clone());
        assert!(mean < 4e-3, "{integrator:?}: the mean is {mean} off");
    }
}

#[test]
fn a_sheet_that_reflects_half_and_transmits_half_vanishes() {
    let folder = folder();
    let files = [Scatter::Reflection, Scatter::Transmission].map(|scatter| even(folder.path(), scatter, 0.5));
    let sheet = open_sheet(&files, &files, &Options::default(), Backend::best()).unwrap();
    assert!(sheet.lobes().transmits);
    let (largest, mean) = from_white(&furnace(sheet), path_of(40));
    assert!(largest < 0.3 && mean < 3e-3, "a pixel is {largest} off, the mean {mean}");
}

#[test]
fn nothing_occludes_a_convex_object() {
    let (largest, _) = from_white(&furnace(lambert(1.0, Backend::best())), ambient(f32::INFINITY));
    // Pixels next to the sphere are black, because there is no surface.
    assert_eq!(largest, 1.0);
    let film = picture(&furnace(lambert(1.0, Backend::best())), &settings([48, 40], 16, ambient(f32::INFINITY)));
    let middle = film.pixels()[film.index(24, 20)];
    assert!((middle.mean_radiance()[0] - 1.0).abs() < 1e-6, "{:?}", middle.mean_radiance());
}

/// A lamp above a square: sampling lights alone, and lights and materials together.
fn assert_the_same_light(name: &str, material: Arc<dyn Shader>) {
    let mut world = WorldBuilder::new();
    let material = world.material(material);
    let black = world.material(lambert(0.0, Backend::best()));
    world.shape(&plane(0.3), material, None, false).unwrap();
    world.shape(&sphere([0.3, 1.5, 0.2], 0.4), black, Some([5.0, 6.0, 7.0]), false).unwrap();
    let world = world.build().unwrap();
    let of = |integrator| mean(&picture(&world, &settings([40, 40], 128, integrator)));
    let both = of(path_of(1));
    let lights = of(whitted(1));
    assert!(both > 0.05, "{name}: {both}");
    assert!((both / lights - 1.0).abs() < 5e-3, "{name}: {both} with both, {lights} with lights");
}

#[test]
fn sampling_lights_and_sampling_materials_find_the_same_light() {
    assert!(AreaLight::<[f32; 3]>::new(vec![], [1.0; 3], false).is_none());
    assert_the_same_light("cloth", cloth(Backend::best()));
    let gold = Ggx { alpha: [0.1, 0.3] };
    let gold = Conductor { ggx: gold, eta: [0.143, 0.375, 1.442], k: [3.983, 2.386, 1.603] };
    assert_the_same_light("gold", Arc::new(BsdfShader::<Rgb>::model(gold, Backend::best()).unwrap()));

    let shared = std::env::var_os("LOBE_SHARED").map(PathBuf::from);
    let shared = shared.unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared").into());
    for name in [
        "rgl_bsdf/vch_golden_yellow_rgb.bsdf",
        "klems_xml/metalGrate.xml",
        "tensortree_xml/blindsT3.xml",
        "mdl_mbsdf/carpaint_blue.mbsdf",
        "kaist_pbsdf/spectralon_lowres.pbsdf",
        "cornell_brdf/garnet_red.brdf",
        "speos_anisotropicbsdf/aniso_bsdf.anisotropicbsdf",
        "zemax_bsdf/MagicBlack.bsdf",
    ] {
        let file = shared.join("data").join(name);
        if !file.exists() {
            println!("skipped {name}, which is not in {}", shared.display());
            continue;
        }
        match open(&file, &Options::default(), Backend::best()) {
            Ok(material) => assert_the_same_light(name, material),
            Err(error) => panic!("{name}: {error}"),
        }
    }
}
