//! Renders a scene into an array: a quarter of its size, four samples per pixel.

use std::error::Error;
use std::path::Path;

use lobe_render::scene::Scene;
use lobe_render::shader::Backend;
use lobe_render::{Film, Rect, Settings, render};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scenes/cloth-metal-paint.toml");

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let backend = Backend::detect()?;
    let scene = Scene::open(Path::new(FILE), backend)?;
    let size = scene.size.map(|pixels| pixels / 4);
    let window = Rect { x: 0, y: 0, width: size[0], height: size[1] };
    let settings = Settings {
        camera: scene.camera,
        size,
        window,
        filter: scene.filter,
        integrator: scene.integrator,
        samples: 0..4,
        backend,
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        time: None,
    };
    let (film, _) = render(&scene.world, &settings, Film::new(window), |progress| {
        println!("{} of {} samples", progress.done, progress.total);
        true
    })?;

    // Linear radiance in R G B, row by row from the top.
    let image: Vec<[f32; 3]> = film.pixels().iter().map(|pixel| pixel.mean_radiance()).collect();
    let mean = image.iter().flatten().sum::<f32>() / (3 * image.len()) as f32;
    println!("{} x {} pixels, mean radiance {mean:.3}", size[0], size[1]);
    assert!(image.len() == (size[0] * size[1]) as usize && mean > 0.0);
    Ok(())
}
