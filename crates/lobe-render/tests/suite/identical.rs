//! Tests that pictures have the same bits, however they are rendered.

use std::sync::Arc;

use lobe_render::integrator::{INTEGRATORS, Integrator};
use lobe_render::shader::Backend;
use lobe_render::{DEPTHS, Film, Rect, Settings, render};

use super::common::*;

const SIZE: [u32; 2] = [100, 70];
const SAMPLES: u32 = 7;

/// All integrators, some of them also with other parameters.
fn kinds() -> Vec<Arc<dyn Integrator>> {
    let defaults = INTEGRATORS.iter().map(|spec| (spec.default)());
    defaults.chain([whitted(5), ambient(1.0)]).collect()
}

#[test]
fn threads_do_not_matter() {
    let world = mixed();
    for integrator in kinds() {
        let settings = settings(SIZE, SAMPLES, integrator.clone());
        let one = picture(&world, &Settings { threads: 1, ..settings.clone() });
        assert!(mean(&one) > 0.05, "{integrator:?} sees something");
        for threads in [2, 3] {
            assert!(one == picture(&world, &Settings { threads, ..settings.clone() }), "{threads} of {integrator:?}");
        }
    }
}

#[test]
fn parts_of_the_picture_and_of_the_samples_add_up() {
    let world = mixed();
    for integrator in kinds() {
        let settings = settings(SIZE, SAMPLES, integrator.clone());
        let whole = picture(&world, &settings);
        let mut sum = Film::new(settings.window);
        for (window, samples) in [
            (Rect { x: 0, y: 0, width: 100, height: 31 }, 0..7),
            (Rect { x: 0, y: 31, width: 37, height: 39 }, 0..7),
            (Rect { x: 37, y: 31, width: 63, height: 39 }, 5..7),
            (Rect { x: 37, y: 31, width: 63, height: 39 }, 0..5),
        ] {
            sum.merge(&picture(&world, &Settings { window, samples, threads: 1, ..settings.clone() }));
        }
        assert!(whole == sum, "{integrator:?}");
    }
}

#[test]
fn a_stopped_rendering_continues() {
    let world = mixed();
    let settings = settings(SIZE, 100, path_tracing());
    let whole = picture(&world, &settings);
    // Stopped at the first call of `watch`, and then again at the third.
    let mut film = Film::new(settings.window);
    for looks in [1, 3] {
        let mut seen = 0;
        let stopped = render(&world, &settings, film, |_| {
            seen += 1;
            seen < looks
        });
        film = stopped.unwrap().0;
    }
    assert!(film.samples().0 < 100, "it was stopped");
    assert!(whole == render(&world, &settings, film, |_| true).unwrap().0);
}

#[test]
fn copies_made_while_rendering_have_the_first_samples() {
    let world = mixed();
    let settings = settings(SIZE, 100, path_tracing());
    let mut copies = Vec::new();
    let whole = render(&world, &settings, Film::new(settings.window), |progress| {
        copies.push(progress.film());
        true
    });
    let whole = whole.unwrap().0;
    let middle = copies.into_iter().find(|film| film.samples().1 > 0 && film.samples().0 < 100);
    let middle = middle.expect("a look while it is being rendered");
    assert!(whole == render(&world, &settings, middle, |_| true).unwrap().0);
}

#[test]
fn strict_backends_agree() {
    let worlds: Vec<_> =
        Backend::available().into_iter().map(|backend| (backend.strict(), mixed_on(backend.strict()))).collect();
    for integrator in kinds() {
        let settings = settings(SIZE, 4, integrator.clone());
        let films: Vec<(&str, Film)> = worlds
            .iter()
            .map(|(backend, world)| {
                (backend.name(), picture(world, &Settings { backend: *backend, ..settings.clone() }))
            })
            .collect();
        for (name, film) in &films[1..] {
            assert!(*film == films[0].1, "{name} differs from {} with {integrator:?}", films[0].0);
        }
    }
}

#[test]
fn lanes_are_in_use_after_a_bounce_among_several_materials() {
    let world = mixed();
    let settings = settings([128, 128], 4, path_tracing());
    let (_, stats) = render(&world, &settings, Film::new(settings.window), |_| true).unwrap();
    let (all, bounced) = (stats.materials(), stats.shading(1..DEPTHS));
    assert!(all.queries > 50_000 && bounced.queries > 10_000, "{stats:?}");
    assert!(all.lanes_in_use() > 0.95 && bounced.lanes_in_use() > 0.9, "{stats:?}");
}
