//! Rendering on the thread of the caller, a piece at a time: for programs that have no other, such as pages in a browser.

use crate::camera::View;
use crate::film::{Film, Rect};
use crate::integrator::{Renderer, Task};
use crate::render::{Jobs, render, tiles};
use crate::settings::{RenderError, Settings};
use crate::transport::Transport;
use crate::world::World;

/// What a call of [`render_until`] leaves.
#[derive(Debug)]
pub struct Step<T: Transport> {
    /// The film with the samples that were added.
    pub film: Film<T>,
    /// Whether every pixel has all of its samples.
    pub is_done: bool,
}

/// Adds samples to a film as [`render()`](crate::render()) does, but on this thread and no longer than `goes_on`, which is
/// asked after every tile, or after every pass of integrators that follow light from the lights. What a film gets does not
/// depend on how it is divided into calls. `settings.threads` and `settings.time` are not looked at.
///
/// Small windows have few tiles, so a call of a window of at most a tile ends after a few samples of each pixel.
///
/// # Errors
/// [`RenderError`] as of [`render()`](crate::render()).
pub fn render_until<T: Transport>(
    world: &World<T>,
    settings: &Settings<T>,
    film: Film<T>,
    mut goes_on: impl FnMut() -> bool,
) -> Result<Step<T>, RenderError> {
    let Settings { size, window, samples, .. } = settings.clone();
    let whole = Rect { x: 0, y: 0, width: size[0], height: size[1] };
    if window.area() == 0 || whole.intersection(&window) != Some(window) {
        return Err(RenderError::Window { window, size });
    }
    if film.window() != window {
        return Err(RenderError::Film { found: film.window(), expected: window });
    }
    let view = View::new(&settings.camera, size, settings.filter)?;
    let task = Task { world, view: &view, backend: settings.backend };
    let mut film = film;
    match settings.integrator.renderer(task) {
        Renderer::Tiles(mut renderer) => {
            let tiles = tiles(&film, &samples)?;
            let jobs = Jobs::new(&tiles, samples, 1);
            while let Some(job) = jobs.next() {
                film.merge(&renderer.render(job.rect, job.samples));
                if !goes_on() {
                    return Ok(Step { film, is_done: false });
                }
            }
        }
        Renderer::Passes(_) => {
            while samples.start + film.samples().0 < samples.end {
                let next = samples.start + film.samples().0 + 1;
                let settings = Settings { samples: samples.start..next, threads: 1, time: None, ..settings.clone() };
                film = render(world, &settings, film, |_| true)?.0;
                if !goes_on() {
                    return Ok(Step { film, is_done: next == samples.end });
                }
            }
        }
    }
    Ok(Step { film, is_done: true })
}
