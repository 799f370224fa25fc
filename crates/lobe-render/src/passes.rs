//! Renders passes over a picture on all threads: first light paths, then tiles that use them.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

use crate::camera::View;
use crate::clock::Instant;
use crate::connect::{Factors, LightPart, LightVertex, Pass, radius_of};
use crate::film::{Film, Rect};
use crate::integrator::{PassRenderer, Plan};
use crate::photon::{LightMap, Photon, Photons};
use crate::settings::{Progress, RenderError, Settings};
use crate::stats::Stats;
use crate::transport::Transport;
use crate::vec3;
use crate::wavefront::PATHS;
use crate::world::World;

/// Columns and rows of a tile of a pass: its pixels make one wave.
const TILE: [u32; 2] = [128, 64];
/// The largest number of light paths of a pass, unless more are requested.
const MOST: u64 = 1 << 20;
/// The number of surfaces per light path for which memory is requested.
const SURFACES: u64 = 4;

/// The state of one thread.
pub(crate) type Worker<'w, T> = Box<dyn PassRenderer<T> + Send + 'w>;

/// Renders pass after pass. A film that is continued must have whole passes.
pub(crate) fn render<'w, T: Transport>(
    world: &World<T>,
    settings: &Settings<T>,
    view: &View,
    mut film: Film<T>,
    mut workers: Vec<Worker<'w, T>>,
    watch: &mut dyn FnMut(&Progress<'_, T>) -> bool,
) -> Result<(Film<T>, Stats), RenderError> {
    let Settings { size, window, samples, .. } = settings.clone();
    let plan = workers[0].plan();
    if !world.lights.emit() {
        return Err(RenderError::Dark);
    }
    let (least, most) = film.samples();
    let next = samples.start.checked_add(least).filter(|_| least == most).ok_or(RenderError::Uneven)?;
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    let paths = plan.paths.unwrap_or(pixels.min(MOST) as u32);
    if film.splats().first().is_some_and(|splat| splat.paths != u64::from(least) * u64::from(paths)) {
        return Err(RenderError::Uneven);
    }
    room::<T>(&plan, paths, &window)?;
    let radius = plan.gathering.map(|gathering| gathering.radius.unwrap_or_else(|| two_pixels(settings)));
    let tiles = tiles(window);
    let begun = Instant::now();
    let total = window.area() as u64 * u64::from(samples.end.saturating_sub(samples.start));
    let ended = AtomicBool::new(false);
    let mut stats = Stats::default();
    for number in next..samples.end {
        let late = settings.time.is_some_and(|limit| begun.elapsed() >= limit) && number > samples.start;
        if late || ended.load(Ordering::Relaxed) {
            break;
        }
        let shrink = plan.gathering.map_or(1.0, |gathering| gathering.shrink);
        let radius = radius.map(|first| radius_of(first, number, shrink));
        let merging = radius.filter(|_| plan.splats);
        let factors = Factors::new(if plan.splats { paths } else { 0 }, merging);
        let pass = Pass { number, paths, depth: plan.depth, radius, columns: size[0], pixels: pixels as f32, factors };
        let so_far = window.area() as u64 * u64::from(number - samples.start);
        let done = AtomicUsize::new(0);
        let mut tick = || {
            let done = so_far + done.load(Ordering::Relaxed) as u64;
            let progress = Progress { done, total, elapsed: begun.elapsed(), film: &|| film.clone() };
            if !watch(&progress) {
                ended.store(true, Ordering::Relaxed);
            }
        };
        // The light paths of the whole picture, whatever the window.
        let jobs = (paths as usize).div_ceil(PATHS);
        let parts: Vec<Mutex<LightPart<T>>> = (0..jobs).map(|_| Mutex::new(LightPart::default())).collect();
        let brought = Mutex::new((Film::<T>::new(window), 0u64));
        if plan.splats {
            brought.lock().unwrap_or_else(PoisonError::into_inner).0.add_light_paths(u64::from(paths));
        }
        let follow = |worker: &mut Worker<'w, T>, job: usize| {
            let begin = (job * PATHS) as u32;
            let mut part = worker.light(begin..paths.min(begin.saturating_add(PATHS as u32)), &pass);
            let mut brought = brought.lock().unwrap_or_else(PoisonError::into_inner);
            for splat in part.splats.drain(..) {
                let finite = brought.0.splat(splat.raster, splat.radiance, view.filter());
                brought.1 += u64::from(!finite);
            }
            drop(brought);
            *parts[job].lock().unwrap_or_else(PoisonError::into_inner) = part;
        };
        parallel(&mut workers, jobs, &ended, &follow, &mut tick);
        if ended.load(Ordering::Relaxed) {
            break;
        }
        let sorting = Instant::now();
        let mut map = LightMap { parts: Vec::new(), paths: PATHS, photons: Photons::none() };
        if plan.keeps {
            map.parts =
                parts.into_iter().map(|part| part.into_inner().unwrap_or_else(PoisonError::into_inner)).collect();
        }
        if let (Some(gathering), Some(radius)) = (plan.gathering, radius) {
            map.photons = Photons::new(&map.parts, gathering.least, &world.bounds(), radius);
        }
        stats.gather += sorting.elapsed();
        stats.total += sorting.elapsed();
        let look = |worker: &mut Worker<'w, T>, job: usize| {
            let seen = worker.camera(tiles[job], &pass, &map);
            brought.lock().unwrap_or_else(PoisonError::into_inner).0.merge(&seen);
            done.fetch_add(tiles[job].area(), Ordering::Relaxed);
        };
        parallel(&mut workers, tiles.len(), &ended, &look, &mut tick);
        if ended.load(Ordering::Relaxed) && done.load(Ordering::Relaxed) < window.area() {
            break;
        }
        let (pass_film, invalid) = brought.into_inner().unwrap_or_else(PoisonError::into_inner);
        stats.invalid += invalid;
        film.merge(&pass_film);
    }
    for worker in &workers {
        stats += worker.stats();
    }
    Ok((film, stats))
}

/// Checks that there is enough memory for the light paths of a pass.
fn room<T: Transport>(plan: &Plan, paths: u32, window: &Rect) -> Result<(), RenderError> {
    let film = window.area() as u64 * 200;
    let surfaces = u64::from(paths) * u64::from(plan.depth).min(SURFACES);
    let vertices = if plan.keeps { surfaces * size_of::<LightVertex<T>>() as u64 } else { 0 };
    let photons = plan.gathering.map_or(0, |_| surfaces * (size_of::<Photon<T>>() as u64 + 32));
    lobe_memory::require(film + vertices + photons).map_err(RenderError::Memory)
}

/// The size of two pixels at the target of the camera.
fn two_pixels<T: Transport>(settings: &Settings<T>) -> f32 {
    let camera = &settings.camera;
    let distance = vec3::length(vec3::sub(camera.target, camera.position));
    2.0 * 2.0 * libm::tanf(0.5 * camera.field_of_view) * distance / settings.size[1] as f32
}

fn tiles(window: Rect) -> Vec<Rect> {
    let [width, height] = TILE;
    let mut tiles = Vec::new();
    for y in window.rows().step_by(height as usize) {
        for x in window.columns().step_by(width as usize) {
            tiles.extend(Rect { x, y, width, height }.intersection(&window));
        }
    }
    tiles
}

/// Hands out jobs to workers, each on its own thread, until all are done or the work is `ended`. Calls `tick` from this
/// thread about every tenth of a second.
fn parallel<W: Send>(
    workers: &mut [W],
    jobs: usize,
    ended: &AtomicBool,
    work: &(impl Fn(&mut W, usize) + Sync),
    tick: &mut dyn FnMut(),
) {
    let next = AtomicUsize::new(0);
    let run = |worker: &mut W| {
        while !ended.load(Ordering::Relaxed) {
            let job = next.fetch_add(1, Ordering::Relaxed);
            if job >= jobs {
                break;
            }
            work(worker, job);
        }
    };
    let (running, finished) = (Mutex::new(0usize), Condvar::new());
    let lock = || running.lock().unwrap_or_else(PoisonError::into_inner);
    let (run, running_of, finished_of) = (&run, &running, &finished);
    std::thread::scope(|scope| {
        let mut handles = Vec::new();
        for worker in workers.iter_mut().take(jobs.max(1)) {
            *lock() += 1;
            let leaving = Leaving { running: running_of, finished: finished_of };
            let spawned = std::thread::Builder::new().spawn_scoped(scope, move || {
                let _leaving = leaving;
                run(worker);
            });
            match spawned {
                Ok(handle) => handles.push(handle),
                // The system cannot start more threads, so the existing ones do the work.
                Err(_) => break,
            }
        }
        let mut left = lock();
        while *left > 0 {
            drop(left);
            tick();
            left = lock();
            if *left > 0 {
                let waited = finished.wait_timeout(left, Duration::from_millis(100));
                left = waited.unwrap_or_else(PoisonError::into_inner).0;
            }
        }
        drop(left);
        for handle in handles {
            handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    });
    // If no thread could be started, all jobs are left.
    if let Some(worker) = workers.first_mut() {
        run(worker);
    }
    tick();
}

/// Reports that a thread has ended, even by a panic, or was never started.
struct Leaving<'a> {
    running: &'a Mutex<usize>,
    finished: &'a Condvar,
}

impl Drop for Leaving<'_> {
    fn drop(&mut self) {
        *self.running.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        self.finished.notify_all();
    }
}
