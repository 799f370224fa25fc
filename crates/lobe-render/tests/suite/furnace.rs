//! Inside of an even white sky, what loses no light cannot be seen.

use std::sync::Arc;

use lobe::Edges;
use lobe_render::light::{AreaLight, Environment, Light};
use lobe_render::shader::{Delta, DeltaShader, Proxied, Shader, Sided, TableShader};
use lobe_render::{Integrator, World, WorldBuilder};
use lobe_table::{Channels, Samples, Scatter, Table};

use super::common::*;

fn furnace(shader: Arc<dyn Shader<3>>) -> World<3> {
    let mut world = WorldBuilder::new();
    let material = world.material(shader);
    world.shape(&sphere([0.0, 0.5, 0.0], 1.0), material, None, false).unwrap();
    world.light(Light::Environment(Environment::constant([1.0; 3]).unwrap()));
    world.build().unwrap()
}

/// A table whose every value is `1 / pi`.
fn white_table() -> Table {
    let radians = |knots: &[f64]| knots.iter().map(|x| x.to_radians()).collect::<Vec<_>>();
    let knots = [
        radians(&[0.0, 30.0, 60.0, 90.0]),
        radians(&[0.0, 120.0, 240.0]),
        radians(&[0.0, 10.0, 40.0, 90.0, 180.0]),
        radians(&[0.0, 90.0, 180.0, 270.0]),
    ];
    let values = vec![std::f32::consts::FRAC_1_PI; 4 * 3 * 5 * 4];
    let samples = Samples::new(Scatter::Reflection, knots, Channels::Mono, values).unwrap();
    Table::new(&samples, &Edges::default()).unwrap()
}

/// The largest difference of a pixel from 1, and that of the mean.
fn from_white(world: &World<3>, integrator: Integrator) -> (f64, f64) {
    let film = picture(world, &settings([48, 40], 64, integrator));
    let pixels = film.pixels().iter().flat_map(|pixel| pixel.mean_radiance());
    let largest = pixels.map(|x| (f64::from(x) - 1.0).abs()).fold(0.0, f64::max);
    (largest, (mean(&film) - 1.0).abs())
}

#[test]
fn white_surfaces_vanish_in_a_white_sky() {
    let oren_nayar = lobe_model::OrenNayar { albedo: [1.0; 3], roughness: 0.0 };
    let shaders: [(&str, Arc<dyn Shader<3>>, f64, f64); 5] = [
        ("lambert", lambert(1.0), 0.08, 2e-3),
        ("table", Arc::new(TableShader::new(white_table()).unwrap()), 0.25, 3e-3),
        ("proxied", Arc::new(Proxied::new(oren_nayar).unwrap()), 0.25, 3e-3),
        ("sided", Arc::new(Sided::new(oren_nayar)), 0.25, 3e-3),
        ("mirror", Arc::new(DeltaShader(Delta::Mirror([1.0; 3]))), 0.05, 1e-3),
    ];
    for (name, shader, pixel, whole) in shaders {
        let world = furnace(shader);
        let (largest, mean) = from_white(&world, PATH);
        assert!(largest < pixel && mean < whole, "path, {name}: a pixel is {largest} off, the mean {mean}");
        // Convex things have direct light only.
        let (largest, mean) = from_white(&world, Integrator::Whitted { depth: 4 });
        assert!(largest < 2.0 * pixel && mean < 6e-3, "whitted, {name}: a pixel is {largest} off, the mean {mean}");
    }
}

#[test]
fn glass_loses_nothing_when_all_of_its_rays_are_followed() {
    let world = furnace(Arc::new(DeltaShader(Delta::Glass { eta: 1.5, tint: [1.0; 3] })));
    for integrator in [Integrator::Path { depth: 60, limit: f32::INFINITY }, Integrator::Whitted { depth: 16 }] {
        let (_, mean) = from_white(&world, integrator);
        assert!(mean < 4e-3, "{integrator:?}: the mean is {mean} off");
    }
}

#[test]
fn nothing_occludes_a_convex_thing() {
    let (largest, _) = from_white(&furnace(lambert(1.0)), Integrator::Ambient { distance: f32::INFINITY });
    // Pixels beside the sphere are black, as there is no surface.
    assert_eq!(largest, 1.0);
    let film =
        picture(&furnace(lambert(1.0)), &settings([48, 40], 16, Integrator::Ambient { distance: f32::INFINITY }));
    let middle = film.pixels()[film.index(24, 20)];
    assert!((middle.mean_radiance()[0] - 1.0).abs() < 1e-6, "{:?}", middle.mean_radiance());
}

#[test]
fn drawing_lights_and_drawing_materials_find_the_same_light() {
    // A lamp above a cloth: by its lights alone, and by both together.
    let mut world = WorldBuilder::new();
    let cloth = world.material(Arc::new(TableShader::new(cloth()).unwrap()));
    let black = world.material(lambert(0.0));
    world.shape(&plane(0.3), cloth, None, false).unwrap();
    world.shape(&sphere([0.3, 1.5, 0.2], 0.4), black, Some([5.0, 6.0, 7.0]), false).unwrap();
    let world = world.build().unwrap();
    let both = mean(&picture(&world, &settings([40, 40], 128, Integrator::Path { depth: 1, limit: f32::INFINITY })));
    let lights = mean(&picture(&world, &settings([40, 40], 128, Integrator::Whitted { depth: 1 })));
    assert!(both > 0.05, "{both}");
    assert!((both / lights - 1.0).abs() < 5e-3, "{both} with both, {lights} with lights");
    assert!(AreaLight::<3>::new(vec![], [1.0; 3], false).is_none());
}
