//! Renders a scene with several integrators for the same time each, and prints the error of each against a reference.
//!
//! ```sh
//! cargo run --release -p lobe-render --example integrators -- SCENE SECONDS REFERENCE_SECONDS FOLDER path,bdpt,sppm,vcm
//! ```
//!
//! The reference is rendered by the last integrator of the list, for REFERENCE_SECONDS, with different samples.
//! Pictures are written to FOLDER, unless it is `-`. One thread is used. The error is the root mean square of the
//! differences of channels, relative to the mean of the reference; the brightest thousandth of the pixels is left out.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use lobe::Backend;
use lobe_render::integrator::{Integrator, named};
use lobe_render::picture::{ToneMap, write_png};
use lobe_render::scene::Scene;
use lobe_render::{Film, Rect, Settings, render};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [scene, seconds, reference, folder, names] = &args[..] else {
        return Err("expected SCENE SECONDS REFERENCE_SECONDS FOLDER NAMES".into());
    };
    let scene = Scene::open(Path::new(scene), Backend::detect()?)?;
    let [width, height] = scene.size;
    let of = |integrator: Arc<dyn Integrator>, first: u32, seconds: f64| -> Result<(Film, f64), String> {
        let settings = Settings {
            camera: scene.camera,
            size: scene.size,
            window: Rect { x: 0, y: 0, width, height },
            filter: scene.filter,
            integrator,
            samples: first..first + (1 << 20),
            backend: Backend::best(),
            threads: 1,
            time: Some(Duration::from_secs_f64(seconds)),
        };
        let begun = Instant::now();
        let film = render(&scene.world, &settings, Film::new(settings.window), |_| true);
        Ok((film.map_err(|error| error.to_string())?.0, begun.elapsed().as_secs_f64()))
    };
    // The parameters of the scene, if it names the integrator.
    let integrator = |name: &str| -> Result<Arc<dyn Integrator>, String> {
        let spec = named(name).ok_or_else(|| format!("no integrator `{name}`"))?;
        let default = (spec.default)();
        let own = format!("{:?}", scene.integrator);
        let type_name = format!("{default:?}");
        let same = own.split(' ').next() == type_name.split(' ').next();
        Ok(if same { scene.integrator.clone() } else { default })
    };
    let names: Vec<&str> = names.split(',').collect();
    let last = names.last().ok_or("expected names of integrators")?;
    let (truth, _) = of(integrator(last)?, 1 << 24, reference.parse()?)?;
    let truth: Vec<[f32; 3]> = truth.colours().collect();
    let mean = truth.iter().flatten().map(|x| f64::from(*x)).sum::<f64>() / (3 * truth.len()) as f64;
    for name in &names {
        let (film, took) = of(integrator(name)?, 0, seconds.parse()?)?;
        let mut errors: Vec<f64> = film
            .colours()
            .zip(&truth)
            .map(|(a, b)| (0..3).map(|k| (f64::from(a[k] - b[k]) / mean).powi(2)).sum::<f64>() / 3.0)
            .collect();
        errors.sort_by(f64::total_cmp);
        errors.truncate(errors.len() - errors.len() / 1000);
        let error = (errors.iter().sum::<f64>() / errors.len() as f64).sqrt();
        let (least, most) = film.samples();
        println!(
            "{name}: {took:.2} s, {least} to {most} samples, error {:.4}, squared times seconds {:.5}",
            error,
            error * error * took
        );
        if folder != "-" {
            write_png(&Path::new(folder).join(format!("{name}.png")), &film, ToneMap { exposure: scene.exposure })?;
        }
    }
    Ok(())
}
