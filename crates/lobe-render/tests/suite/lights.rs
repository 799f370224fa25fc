//! Tests of integrators that begin paths at lights: all of them find the same light.

use std::slice;
use std::sync::Arc;

use lobe::{Channels, Options, Scatter, specular};
use lobe_render::integrator::{Bdpt, Integrator, LightTracing, Sppm, Vcm};
use lobe_render::light::{Environment, Light};
use lobe_render::shader::{Backend, BsdfShader, Delta, DeltaShader, Shader, open_sheet};
use lobe_render::{Camera, Film, RenderError, Settings, Shape, World, WorldBuilder, render};

use super::common::*;

fn light(depth: u32) -> Arc<dyn Integrator> {
    Arc::new(LightTracing { depth, paths: None })
}

fn bdpt(depth: u32) -> Arc<dyn Integrator> {
    Arc::new(Bdpt { depth, paths: None })
}

fn sppm(depth: u32) -> Arc<dyn Integrator> {
    Arc::new(Sppm { depth, radius: Some(0.05), ..Sppm::default() })
}

fn vcm(depth: u32) -> Arc<dyn Integrator> {
    Arc::new(Vcm { depth, radius: Some(0.05), ..Vcm::default() })
}

/// The mean of each of 4 x 4 parts of a picture, with its standard error from independent pictures.
fn regions(world: &World, settings: &Settings, pictures: u32) -> Vec<[f64; 2]> {
    let mut sums = [[0.0; 2]; 16];
    let n = settings.samples.end;
    for picture in 0..pictures {
        let settings = Settings { samples: picture * n..(picture + 1) * n, ..settings.clone() };
        let film = super::common::picture(world, &settings);
        for (sums, mean) in sums.iter_mut().zip(means(&film)) {
            sums[0] += mean;
            sums[1] += mean * mean;
        }
    }
    let n = f64::from(pictures);
    sums.iter()
        .map(|[sum, squares]| [sum / n, ((squares / n - (sum / n).powi(2)).max(0.0) / (n - 1.0)).sqrt()])
        .collect()
}

fn means(film: &Film) -> [f64; 16] {
    let window = film.window();
    let (mut sums, mut counts) = ([0.0; 16], [0.0; 16]);
    for (at, colour) in film.colours().enumerate() {
        let (x, y) = (at as u32 % window.width, at as u32 / window.width);
        let part = (4 * y / window.height * 4 + 4 * x / window.width) as usize;
        sums[part] += colour.iter().map(|x| f64::from(*x)).sum::<f64>() / 3.0;
        counts[part] += 1.0;
    }
    std::array::from_fn(|part| sums[part] / counts[part])
}

/// Within five standard errors of both and a share of the mean.
fn assert_equal(name: &str, expected: &[[f64; 2]], found: &[[f64; 2]], bias: f64) {
    for (part, ([a, s], [b, t])) in expected.iter().zip(found).enumerate() {
        let noise = 5.0 * (s * s + t * t).sqrt() + bias * a;
        assert!((a - b).abs() < noise + 1e-6, "{name}, part {part}: {b:.5} +- {t:.5}, not {a:.5} +- {s:.5}");
    }
}

/// Cloth, a translucent sheet, gold, a glass ball above the cloth, and one kind of light.
fn scene(lights: &[Light], lamp: Option<bool>, glass: bool) -> World {
    let backend = Backend::best();
    let mut world = WorldBuilder::new();
    let cloth = world.material(cloth(backend));
    let white = world.material(lambert(0.6, backend));
    let glass_of = world.material(Arc::new(DeltaShader(Delta::Glass { eta: 1.5, tint: [1.0, 0.95, 0.9] })));
    let gold = lobe_model::Conductor {
        ggx: lobe_model::Ggx { alpha: [0.3, 0.5] },
        eta: [0.143, 0.375, 1.442],
        k: [3.983, 2.386, 1.603],
    };
    let gold: Arc<dyn Shader> = Arc::new(BsdfShader::<lobe_render::Rgb>::model(gold, backend).unwrap());
    let gold = world.material(gold);
    let sheet = world.material(sheet_of(backend));
    let scaled = |by: f32, shape: Shape| Shape {
        positions: shape.positions.iter().map(|p| p.map(|x| by * x)).collect(),
        ..shape
    };
    world.shape(&scaled(3.0, plane(0.4)), cloth, None, false).unwrap();
    world.shape(&sphere([-1.0, 0.5, -0.2], 0.5), gold, None, false).unwrap();
    if glass {
        world.shape(&sphere([0.9, 0.6, 0.3], 0.5), glass_of, None, false).unwrap();
    }
    // It stands upright and is lit from both sides.
    let turned = |p: [f32; 3]| [0.5 * p[0], 0.55 + 0.5 * p[2], -0.9 - p[1]];
    let plane = plane(0.2);
    let up = Shape {
        positions: plane.positions.iter().map(|p| turned(*p)).collect(),
        normals: vec![[0.0, 0.0, -1.0]; 4],
        tangents: plane.tangents.iter().map(|[x, _, z, w]| [*x, *z, 0.0, *w]).collect(),
        ..plane
    };
    world.shape(&up, sheet, None, false).unwrap();
    if let Some(two_sided) = lamp {
        let lamp = Shape {
            positions: up.positions.iter().map(|p| [p[0] + 0.3, 2.4 + 0.2 * p[2], 1.0 - p[1]]).collect(),
            normals: vec![[0.0, -1.0, 0.0]; 4],
            ..up.clone()
        };
        world.shape(&lamp, white, Some([9.0, 8.0, 7.0]), two_sided).unwrap();
    }
    lights.iter().for_each(|light| world.light(light.clone()));
    world.build().unwrap()
}

/// A sheet that reflects and transmits light, more of it straight through, with a different back.
fn sheet_of(backend: Backend) -> Arc<dyn Shader> {
    let folder = folder();
    let steps = |n: usize, step: f64| (0..n).map(|i| (step * i as f64).to_radians()).collect::<Vec<_>>();
    let file = |name: &str, scatter, share: f32| {
        let knots = [steps(10, 10.0), steps(3, 120.0), steps(19, 10.0), steps(12, 30.0)];
        let value = |i: usize| {
            let (sigma, theta, phi) = (i / (3 * 19 * 12), i / 12 % 19, i % 12);
            share * (0.1 + (-0.6 * theta as f32).exp()) * (1.0 - 0.05 * sigma as f32) * (1.0 + 0.1 * (phi % 3) as f32)
        };
        let values = (0..10 * 3 * 19 * 12).map(value).collect();
        let samples = specular::Data::new(scatter, knots, Channels::Mono, values).unwrap();
        let path = folder.path().join(name);
        lobe::formats::ddr::write(&samples, &path).unwrap();
        path
    };
    let front = [file("a.ddr", Scatter::Reflection, 0.3), file("a.ddt", Scatter::Transmission, 0.5)];
    let back = [file("b.ddr", Scatter::Reflection, 0.1), file("b.ddt", Scatter::Transmission, 0.4)];
    open_sheet(&front, &back, &Options::default(), backend).unwrap()
}

fn all_lights() -> Vec<Light> {
    let direction = [0.48, -0.64, -0.6];
    vec![
        Light::Point { position: [1.5, 1.8, 1.5], intensity: [2.0, 1.5, 1.0] },
        Light::Spot { position: [-1.5, 2.0, 1.0], direction, intensity: [6.0, 7.0, 8.0], falloff: [0.9, 0.7] },
        Light::Directional { toward: [0.36, 0.8, -0.48], irradiance: [0.5, 0.6, 0.7] },
        Light::Environment(Environment::gradient([0.3, 0.4, 0.8], [0.5; 3], [0.1; 3]).unwrap()),
    ]
}

fn from_above(size: [u32; 2], samples: u32, integrator: Arc<dyn Integrator>) -> Settings {
    let camera = Camera {
        position: [0.3, 1.7, 4.0],
        target: [0.0, 0.5, 0.0],
        up: [0.0, 1.0, 0.0],
        field_of_view: 0.75,
        lens_radius: 0.03,
        focus_distance: None,
    };
    Settings { camera, ..settings(size, samples, integrator) }
}

#[test]
fn every_integrator_finds_the_same_light_from_every_light() {
    let [point, spot, directional, sky] = <[Light; 4]>::try_from(all_lights()).unwrap();
    let all = || vec![point.clone(), spot.clone(), directional.clone(), sky.clone()];
    let scenes = [
        ("point", scene(slice::from_ref(&point), None, false)),
        ("spot", scene(slice::from_ref(&spot), None, false)),
        ("directional", scene(slice::from_ref(&directional), None, false)),
        ("sky", scene(slice::from_ref(&sky), None, false)),
        ("lamp", scene(&[], Some(false), false)),
        ("two-sided lamp", scene(&[], Some(true), false)),
        ("all", scene(&all(), Some(false), false)),
    ];
    for (name, world) in scenes {
        let of = |integrator| regions(&world, &from_above([32, 24], 16, integrator), 6);
        let expected = of(path_of(4));
        for (integrator, bias) in [(light(4), 0.0), (bdpt(4), 0.0), (vcm(4), 0.01), (sppm(4), 0.02)] {
            assert_equal(&format!("{name}, {integrator:?}"), &expected, &of(integrator.clone()), 0.002 + bias);
        }
    }
}

#[test]
fn light_through_glass_is_the_same_from_either_end() {
    let sky = all_lights().pop().unwrap();
    let world = scene(&[sky], Some(false), true);
    let of = |integrator, samples| regions(&world, &from_above([32, 24], samples, integrator), 6);
    let expected = of(path_of(6), 256);
    for (integrator, bias) in [(bdpt(6), 0.002), (vcm(6), 0.01), (sppm(6), 0.02)] {
        assert_equal(&format!("{integrator:?}"), &expected, &of(integrator.clone(), 32), bias);
    }
}

/// Light that no other integrator finds: the caustic of a point light, seen in a mirror.
#[test]
fn mirrors_show_caustics_of_points() {
    let world = scene(&all_lights()[..1], None, true);
    let of = |integrator, samples| regions(&world, &from_above([32, 24], samples, integrator), 6);
    let expected = of(vcm(6), 64);
    assert_equal("sppm", &expected, &of(sppm(6), 64), 0.02);
    let [part] = [means(&picture(&world, &from_above([32, 24], 64, bdpt(6))))];
    assert!(part.iter().zip(&expected).any(|(bdpt, [vcm, _])| *bdpt < 0.97 * vcm), "bdpt misses some of it");
}

#[test]
fn white_surfaces_vanish_in_a_white_sky_whatever_the_integrator() {
    let white: Arc<dyn Shader> = lambert(1.0, Backend::best());
    for (name, shader, bias) in [
        ("lambert", white, 4e-3),
        ("glass", Arc::new(DeltaShader(Delta::Glass { eta: 1.5, tint: [1.0; 3] })) as Arc<dyn Shader>, 4e-3),
    ] {
        let mut world = WorldBuilder::new();
        let material = world.material(shader);
        world.shape(&sphere([0.0, 0.5, 0.0], 1.0), material, None, false).unwrap();
        world.light(Light::Environment(Environment::constant([1.0; 3]).unwrap()));
        let world = world.build().unwrap();
        for integrator in [light(60), bdpt(60), sppm(60), vcm(60)] {
            let seen = mean(&picture(&world, &settings([48, 40], 32, integrator.clone())));
            assert!((seen - 1.0).abs() < bias, "{name}, {integrator:?}: {seen}");
        }
    }
}

#[test]
fn more_passes_bring_photon_maps_closer() {
    let world = scene(&all_lights()[..1], None, true);
    let of = |integrator: Arc<dyn Integrator>, samples| picture(&world, &from_above([32, 24], samples, integrator));
    let truth: Vec<[f32; 3]> = of(vcm(6), 400).colours().collect();
    let off = |film: &Film| {
        film.colours()
            .zip(&truth)
            .map(|(a, b)| (0..3).map(|k| f64::from(a[k] - b[k]).powi(2)).sum::<f64>())
            .sum::<f64>()
    };
    let wide: Arc<dyn Integrator> = Arc::new(Sppm { depth: 6, radius: Some(0.2), ..Sppm::default() });
    let errors = [1, 8, 64].map(|passes| off(&of(wide.clone(), passes)));
    assert!(errors[1] < 0.75 * errors[0] && errors[2] < 0.75 * errors[1], "{errors:?}");
}

#[test]
fn without_light_or_memory_there_is_an_error() {
    let dark = scene(&[], None, false);
    let black = scene(&[Light::Point { position: [0.0, 2.0, 0.0], intensity: [0.0; 3] }], None, false);
    let lit = scene(&all_lights()[..1], None, false);
    for integrator in [light(3), bdpt(3), sppm(3), vcm(3)] {
        for world in [&dark, &black] {
            let settings = from_above([16, 12], 1, integrator.clone());
            let error = render(world, &settings, Film::new(settings.window), |_| true).unwrap_err();
            assert!(matches!(error, RenderError::Dark), "{integrator:?}: {error}");
        }
    }
    let many = Arc::new(Vcm { paths: Some(u32::MAX), ..Vcm::default() });
    let settings = from_above([16, 12], 1, many);
    let error = render(&lit, &settings, Film::new(settings.window), |_| true).unwrap_err();
    assert!(matches!(error, RenderError::Memory(_)), "{error}");
    // A light with no surface in front of it.
    let mut world = WorldBuilder::new();
    let white = world.material(lambert(0.5, Backend::best()));
    world.shape(&plane(0.0), white, None, false).unwrap();
    let falloff = [0.99, 0.95];
    world.light(Light::Spot { position: [0.0, 2.0, 0.0], direction: [0.0, 1.0, 0.0], intensity: [1.0; 3], falloff });
    let world = world.build().unwrap();
    let settings = from_above([16, 12], 2, vcm(3));
    let (film, stats) = render(&world, &settings, Film::new(settings.window), |_| true).unwrap();
    assert_eq!((stats.landed, stats.light_paths, mean(&film)), (0, 2 * 16 * 12, 0.0));
}

#[test]
fn fewer_light_paths_than_pixels_and_more_see_the_same() {
    let world = scene(&all_lights()[..1], Some(false), false);
    let of = |paths| {
        let vcm = Vcm { depth: 4, paths, radius: Some(0.05), ..Vcm::default() };
        regions(&world, &from_above([32, 24], 16, Arc::new(vcm)), 6)
    };
    let expected = of(None);
    for paths in [700, 9000] {
        assert_equal(&format!("{paths} paths"), &expected, &of(Some(paths)), 0.01);
    }
}

/// Light that goes from a lamp by way of a mirror to a wall, and is seen in the mirror again.
#[test]
fn a_mirror_in_a_closed_box() {
    let mut world = WorldBuilder::new();
    let [white, black] = [0.5, 0.0].map(|albedo| world.material(lambert(albedo, Backend::best())));
    let mirror = world.material(Arc::new(DeltaShader(Delta::Mirror([0.9; 3]))));
    let walls = lobe_mesh::shapes::cuboid([3.0, 3.0, 3.0], 1).complete();
    let walls = Shape {
        positions: walls.positions.clone(),
        normals: walls.normals.clone().unwrap(),
        tangents: walls.tangents.clone().unwrap(),
        triangles: walls.triangles.clone(),
    };
    world.shape(&walls, white, None, false).unwrap();
    world.shape(&sphere([-0.4, -0.6, -0.3], 0.7), mirror, None, false).unwrap();
    world.shape(&sphere([0.9, 0.9, -0.6], 0.3), black, Some([4.0; 3]), false).unwrap();
    let world = world.build().unwrap();
    let camera = |settings: Settings| {
        let camera =
            Camera { position: [0.5, 0.3, 1.4], target: [0.0, -0.2, -0.5], field_of_view: 1.3, ..settings.camera };
        Settings { camera, ..settings }
    };
    let of = |integrator, samples| regions(&world, &camera(settings([32, 24], samples, integrator)), 6);
    let expected = of(path_of(7), 96);
    for (integrator, bias) in [(bdpt(7), 0.002), (vcm(7), 0.01), (sppm(7), 0.02)] {
        assert_equal(&format!("{integrator:?}"), &expected, &of(integrator.clone(), 32), bias);
    }
}

#[test]
fn stopped_passes_continue() {
    let world = mixed();
    for integrator in [light(4), bdpt(4), sppm(4), vcm(4)] {
        let settings = from_above([48, 32], 12, integrator.clone());
        let whole = picture(&world, &settings);
        let (mut film, mut pauses) = (Film::new(settings.window), 0);
        while film.samples().0 < 12 {
            let done = film.samples().0;
            let mut copy = None;
            film = render(&world, &settings, film, |progress| {
                copy = Some(progress.film());
                // At any time, the film has whole passes.
                progress.film().samples().0 == progress.film().samples().1 && progress.film().samples().0 < done + 5
            })
            .unwrap()
            .0;
            assert!(copy.is_some());
            pauses += 1;
        }
        assert!(pauses > 1 && whole == film, "{integrator:?}: {pauses}");
    }
}

#[test]
fn scenes_choose_the_integrator() {
    let folder = folder();
    let file = folder.path().join("scene.toml");
    let open = |keys: &str| {
        let text = format!("[camera]\nposition = [0, 0, 4]\ntarget = [0, 0, 0]\n[integrator]\n{keys}\n");
        std::fs::write(&file, text).unwrap();
        lobe_render::scene::Scene::open(&file, Backend::best()).map(|scene| format!("{:?}", scene.integrator))
    };
    let vcm = open("kind = \"vcm\"\ndepth = 5\npaths = 70\nradius = 0.5\nshrink = 0.8").unwrap();
    assert_eq!(vcm, "Vcm { depth: 5, paths: Some(70), radius: Some(0.5), shrink: 0.8 }");
    assert_eq!(open("kind = \"light\"").unwrap(), "LightTracing { depth: 8, paths: None }");
    for (keys, wrong) in [
        ("kind = \"sppm\"\nradius = 0", "radius"),
        ("kind = \"sppm\"\nshrink = 1.5", "shrink"),
        ("kind = \"vcm\"\npaths = 0", "paths"),
        ("kind = \"bdpt\"\nradius = 0.1", "radius"),
        ("kind = \"light\"\ndepth = 0", "depth"),
    ] {
        let error = open(keys).unwrap_err().to_string();
        assert!(error.contains(wrong), "{keys}: {error}");
    }
}
