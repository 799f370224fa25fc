//! What wavelengths and polarisation cost: frames of the same scene in several kinds of light.

use std::path::Path;
use std::time::Instant;

use lobe::Backend;
use lobe_render::scene::{AnyScene, Scene};
use lobe_render::{Film, Rect, Settings, Transport, render};
use serde::Serialize;

/// A frame in one kind of light.
#[derive(Clone, Debug, Serialize)]
pub struct Kind {
    /// The kind of light.
    pub light: &'static str,
    /// Milliseconds on one thread.
    pub milliseconds: f64,
    /// Its time over that of red, green and blue.
    pub ratio: f64,
}

const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");

/// The tables `[spectrum]`; the first is the baseline.
const KINDS: [(&str, &str); 5] = [
    ("red, green and blue", ""),
    ("16 wavelengths", "[spectrum]\nbands = 16\n"),
    ("red, green and blue, S0 to S3", "[spectrum]\nstokes = true\n"),
    ("red, green and blue, polarised, S0 alone", "[spectrum]\nstokes = true\nsensor = \"energy\"\n"),
    ("16 wavelengths, S0 to S3", "[spectrum]\nbands = 16\nstokes = true\n"),
];

/// A measured cloth, a table of Mueller matrices, glass and metal on a floor, under a lamp and the sky.
const SCENE: &str = r#"
[camera]
position = [0, 1.4, 4]
target = [0, 0.5, 0]
[film]
width = 192
height = 144
[integrator]
samples = 2
depth = 5
[material.floor]
model = "lambert"
albedo = [0.5, 0.4, 0.3]
[material.cloth]
file = "cloth-17x7x17x13.ddr"
[material.standard]
file = "standard-7x9x13.mueller"
[material.glass]
model = "glass"
[material.metal]
model = "mirror"
metal = "copper"
[[object]]
shape = "plane"
size = 12
material = "standard"
[[object]]
shape = "sphere"
radius = 0.5
translate = [-1.2, 0.5, 0]
material = "cloth"
[[object]]
shape = "sphere"
radius = 0.5
translate = [0, 0.5, 0.2]
material = "glass"
[[object]]
shape = "sphere"
radius = 0.5
translate = [1.2, 0.5, 0]
material = "metal"
[[object]]
shape = "sphere"
radius = 0.4
translate = [0.6, 0.4, 1.2]
material = "floor"
[[object]]
shape = "sphere"
radius = 0.4
translate = [1, 3, 1]
material = "floor"
radiance = 12
[[light]]
kind = "environment"
zenith = [0.3, 0.4, 0.7]
horizon = 0.6
"#;

/// Renders them in turn, this many times.
///
/// # Errors
/// If the fixtures cannot be read.
pub fn measure(backend: Backend, rounds: usize) -> anyhow::Result<Vec<Kind>> {
    let mut frames = Vec::new();
    for (_, spectrum) in KINDS {
        let text = format!("{spectrum}{SCENE}");
        let scene = AnyScene::parse(Path::new("kinds.toml"), Path::new(FIXTURES), &text, backend)?;
        frames.push(match scene {
            AnyScene::Rgb(scene) => frame(scene, backend),
            AnyScene::Bands8(scene) => frame(scene, backend),
            AnyScene::Bands16(scene) => frame(scene, backend),
            AnyScene::Bands32(scene) => frame(scene, backend),
            AnyScene::StokesRgb(scene) => frame(scene, backend),
            AnyScene::Stokes16(scene) => frame(scene, backend),
            AnyScene::EnergyRgb(scene) => frame(scene, backend),
            AnyScene::Energy16(scene) => frame(scene, backend),
        });
    }
    let mut times = [f64::INFINITY; KINDS.len()];
    for _ in 0..rounds {
        for (frame, time) in frames.iter_mut().zip(&mut times) {
            *time = time.min(frame());
        }
    }
    let kinds = KINDS.into_iter().zip(times);
    Ok(kinds.map(|((light, _), ms)| Kind { light, milliseconds: ms, ratio: ms / times[0] }).collect())
}

/// Renders a scene on one thread and returns the milliseconds.
fn frame<T: Transport>(scene: Scene<T>, backend: Backend) -> Box<dyn FnMut() -> f64> {
    let window = Rect { x: 0, y: 0, width: scene.size[0], height: scene.size[1] };
    let settings = Settings {
        camera: scene.camera,
        size: scene.size,
        window,
        filter: scene.filter,
        integrator: scene.integrator.clone(),
        samples: 0..scene.samples,
        backend,
        threads: 1,
        time: None,
    };
    Box::new(move || {
        let begun = Instant::now();
        let film = render(&scene.world, &settings, Film::<T>::new(window), |_| true).expect("a camera and a window");
        std::hint::black_box(film);
        1e3 * begun.elapsed().as_secs_f64()
    })
}
