//! One surface, one light: `f cos / r^2`.

use lobe::Material;
use lobe_render::light::Light;
use lobe_render::shader::Backend;
use lobe_render::{Camera, Filter, WorldBuilder};

use super::common::*;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

#[test]
fn a_measured_plane_under_a_point_light() {
    let brdf = Material::open(CLOTH).unwrap().with_backend(Backend::best().strict());
    let shader = cloth(Backend::best().strict());
    for (turn, light, eye) in [
        (0.0f32, [0.4f64, 1.0, 0.3], [-0.7f64, 1.1, 0.2]),
        (0.7, [0.4, 1.0, 0.3], [-0.7, 1.1, 0.2]),
        (2.5, [-2.0, 0.7, 1.0], [0.3, 3.0, 2.0]),
    ] {
        let place = [0.21f64, 0.0, -0.13];
        let intensity = [2.0f32, 3.0, 5.0];
        let mut world = WorldBuilder::new();
        let material = world.material(shader.clone());
        world.shape(&plane(turn), material, None, false).unwrap();
        world.light(Light::Point { position: light.map(|x| x as f32), intensity });
        let world = world.build().unwrap();

        // By hand: x along the tangent, z along the normal +y, y = z cross x.
        let (sin, cos) = f64::from(turn).sin_cos();
        let frame = [[cos, 0.0, -sin], [-sin, 0.0, -cos], [0.0, 1.0, 0.0]];
        let local = |v: [f64; 3]| frame.map(|axis| dot(axis, v) as f32);
        let toward = |to: [f64; 3]| [to[0] - place[0], to[1] - place[1], to[2] - place[2]];
        let (wi, wo) = (local(unit(toward(light))), local(unit(toward(eye))));
        let mut f = [0.0; 3];
        brdf.eval(wi, wo, &mut f);
        let r2 = dot(toward(light), toward(light));

        for integrator in [path_tracing(), whitted(2)] {
            let name = format!("{integrator:?}");
            let mut settings = settings([1, 1], 4, integrator);
            settings.backend = Backend::best().strict();
            settings.filter = Filter::Box;
            settings.camera = Camera {
                position: eye.map(|x| x as f32),
                target: place.map(|x| x as f32),
                field_of_view: 1e-6,
                lens_radius: 0.0,
                ..settings.camera
            };
            let seen = picture(&world, &settings).pixels()[0].mean_radiance();
            for k in 0..3 {
                let expected = f64::from(f[k]) * f64::from(wi[2]) * f64::from(intensity[k]) / r2;
                let error = (f64::from(seen[k]) / expected - 1.0).abs();
                assert!(expected > 1e-3 && error < 1e-5, "{name}, turned by {turn}: {} for {expected}", seen[k]);
            }
        }
    }
}

#[test]
fn a_point_light_behind_an_obstacle_gives_nothing() {
    let mut world = WorldBuilder::new();
    let white = world.material(lambert(1.0, Backend::best()));
    world.shape(&plane(0.0), white, None, false).unwrap();
    world.shape(&sphere([0.0, 2.0, 0.0], 0.3), white, None, false).unwrap();
    world.light(Light::Point { position: [0.0, 4.0, 0.0], intensity: [10.0; 3] });
    let world = world.build().unwrap();
    let mut settings = settings([1, 1], 4, whitted(1));
    let at = |x: f32| Camera { position: [x, 1.0, 0.3], target: [x, 0.0, 0.0], field_of_view: 1e-3, ..settings.camera };
    // The sphere's shadow is a disk of radius 4 tan(asin(0.3 / 2)) = 0.61.
    let (dark, bright) = (at(0.5), at(0.9));
    settings.camera = dark;
    assert_eq!(mean(&picture(&world, &settings)), 0.0);
    settings.camera = bright;
    assert!(mean(&picture(&world, &settings)) > 0.1);
}
