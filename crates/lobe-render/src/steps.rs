//! Rendering in steps on the caller's thread, for programs that have no other threads, such as pages in a browser.

use crate::camera::View;
use crate::film::{Film, Rect};
use crate::integrator::{Renderer, Task};
use crate::render::{Jobs, render, tiles};
use crate::settings::{RenderError, Settings};
use crate::transport::Transport;
use crate::world::World;

/// The result of a call to [`render_until`].
#[derive(Debug)]
pub struct Step<T: Transport> {
    /// The film with the additional samples.
    pub film: Film<T>,
    /// `true` if every pixel has all of its samples.
    pub is_done: bool,
}

/// Adds samples to a film as [`render()`](crate::render()) does, but on this thread, and only until `goes_on` returns
/// `false`. It is called after every tile, or after every pass of an integrator with light paths. The samples do not
/// depend on how they are divided into calls. `settings.threads` and `settings.time` are ignored.
///
/// Tiles get a few samples per pixel at a time, so even a call for a window of one tile can end early.
///
/// # Errors
/// [`RenderError`], as for [`render()`](crate::render()).
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
