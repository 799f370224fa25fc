//! Distributes tiles over threads, and reports progress.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::camera::View;
use crate::clock::Instant;
use crate::film::{Film, Rect};
use crate::integrator::{Renderer, Task};
use crate::passes;
use crate::settings::{Progress, RenderError, Settings};
use crate::stats::Stats;
use crate::transport::Transport;
use crate::wavefront::PATHS;
use crate::world::World;

/// Pixels along the side of a tile; a few samples of its pixels make a wave.
const TILE: u32 = 64;

/// State shared by the threads.
struct Shared<T: Transport> {
    state: Mutex<State<T>>,
    finished: Condvar,
}

struct State<T: Transport> {
    film: Film<T>,
    tiles: Vec<Tile<T>>,
    running: usize,
}

/// The pixels of a tile. Samples are added in order, so that a film written in between has the first ones.
pub(crate) struct Tile<T: Transport> {
    pub(crate) rect: Rect,
    /// The next sample to be added.
    next: u32,
    /// Samples that were finished before earlier ones.
    early: Vec<(Range<u32>, Film<T>)>,
}

impl<T: Transport> Shared<T> {
    /// Locks a mutex even if a thread has panicked: it leaves whole samples behind, and its panic is propagated when
    /// the threads are joined.
    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T: Transport> State<T> {
    fn add(&mut self, tile: usize, samples: Range<u32>, seen: Film<T>) {
        let State { film, tiles, .. } = self;
        let tile = &mut tiles[tile];
        tile.early.push((samples, seen));
        while let Some(at) = tile.early.iter().position(|(samples, _)| samples.start == tile.next) {
            let (samples, seen) = tile.early.swap_remove(at);
            film.merge(&seen);
            tile.next = samples.end;
        }
    }
}

/// Renders, continuing a film that already has some of the samples. `watch` is called from this thread about every
/// tenth of a second, and ends the rendering when it returns `false`.
///
/// # Errors
/// [`RenderError`] if the settings are invalid.
pub fn render<T: Transport>(
    world: &World<T>,
    settings: &Settings<T>,
    film: Film<T>,
    mut watch: impl FnMut(&Progress<'_, T>) -> bool,
) -> Result<(Film<T>, Stats), RenderError> {
    let Settings { size, window, samples, .. } = settings.clone();
    let whole = Rect { x: 0, y: 0, width: size[0], height: size[1] };
    if window.area() == 0 || whole.intersection(&window) != Some(window) {
        return Err(RenderError::Window { window, size });
    }
    if film.window() != window {
        return Err(RenderError::Film { found: film.window(), expected: window });
    }
    let view = View::new(&settings.camera, size, settings.filter)?;
    let task = || Task { world, view: &view, backend: settings.backend };
    if let Renderer::Passes(first) = settings.integrator.renderer(task()) {
        let mut workers = vec![first];
        for _ in 1..settings.threads.max(1).min(affordable()) {
            workers.extend(match settings.integrator.renderer(task()) {
                Renderer::Passes(worker) => Some(worker),
                Renderer::Tiles(_) => None,
            });
        }
        return passes::render(world, settings, &view, film, workers, &mut watch);
    }
    let tiles = tiles(&film, &samples)?;
    // If time is limited, every pixel gets its first sample soon; otherwise waves are as large as possible.
    let first = if settings.time.is_some() { 1 } else { (PATHS as u32).div_ceil(TILE * TILE) };
    let jobs = Jobs::new(&tiles, samples.clone(), first);
    let begun = Instant::now();
    let total = window.area() as u64 * u64::from(samples.end.saturating_sub(samples.start));
    let left: u64 = tiles.iter().map(|t| t.rect.area() as u64 * u64::from(samples.end.saturating_sub(t.next))).sum();
    let done = AtomicU64::new(total - left);
    let threads = settings.threads.clamp(1, jobs.count().max(1)).min(affordable());
    let shared = Shared { state: Mutex::new(State { film, tiles, running: threads }), finished: Condvar::new() };
    let ended = AtomicBool::new(false);
    let worker = || {
        let _leaving = Leaving(&shared);
        let Renderer::Tiles(mut renderer) = settings.integrator.renderer(task()) else {
            unreachable!("an integrator has one kind of renderer")
        };
        while let Some(job) = jobs.next() {
            let late = settings.time.is_some_and(|limit| begun.elapsed() >= limit) && !job.first;
            if late || ended.load(Ordering::Relaxed) {
                break;
            }
            let seen = renderer.render(job.rect, job.samples.clone());
            done.fetch_add(job.rect.area() as u64 * u64::from(job.samples.end - job.samples.start), Ordering::Relaxed);
            shared.lock().add(job.tile, job.samples, seen);
        }
        renderer.stats()
    };
    let stats = std::thread::scope(|scope| {
        let mut handles = Vec::new();
        for started in 0..threads {
            match std::thread::Builder::new().spawn_scoped(scope, worker) {
                Ok(handle) => handles.push(handle),
                // The system cannot start more threads, so the existing ones do the work, or this one if there are
                // none.
                Err(_) => {
                    shared.lock().running -= threads - started;
                    break;
                }
            }
        }
        let mut stats = Stats::default();
        if handles.is_empty() {
            shared.lock().running += 1;
            stats += worker();
        }
        let mut state = shared.lock();
        while state.running > 0 {
            drop(state);
            let done = done.load(Ordering::Relaxed);
            let progress = Progress { done, total, elapsed: begun.elapsed(), film: &|| shared.lock().film.clone() };
            if !watch(&progress) {
                ended.store(true, Ordering::Relaxed);
            }
            state = shared.lock();
            if state.running > 0 {
                let waited = shared.finished.wait_timeout(state, Duration::from_millis(100));
                state = waited.unwrap_or_else(PoisonError::into_inner).0;
            }
        }
        drop(state);
        for handle in handles {
            stats += handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
        stats
    });
    let state = shared.state.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok((state.film, stats))
}

/// The number of threads for which there is memory.
fn affordable() -> usize {
    /// Bytes of a thread: its stack, the memory that the allocator keeps for it, and its waves.
    const THREAD: u64 = 100 << 20;
    lobe_memory::available().map_or(usize::MAX, |bytes| (bytes / THREAD).max(1) as usize)
}

/// Reports that a thread has ended, even by a panic.
struct Leaving<'a, T: Transport>(&'a Shared<T>);

impl<T: Transport> Drop for Leaving<'_, T> {
    fn drop(&mut self) {
        self.0.lock().running -= 1;
        self.0.finished.notify_all();
    }
}

/// The tiles of a window, and the number of samples that each has.
pub(crate) fn tiles<T: Transport>(film: &Film<T>, samples: &Range<u32>) -> Result<Vec<Tile<T>>, RenderError> {
    let window = film.window();
    let mut tiles = Vec::new();
    for y in window.rows().step_by(TILE as usize) {
        for x in window.columns().step_by(TILE as usize) {
            let rect = Rect { x, y, width: TILE, height: TILE };
            let rect = rect.intersection(&window).expect("a tile of the window");
            let done = film.pixels()[film.index(x, y)].samples;
            let even = rect.rows().all(|y| rect.columns().all(|x| film.pixels()[film.index(x, y)].samples == done));
            let next = samples.start.checked_add(done).filter(|_| even).ok_or(RenderError::Uneven)?;
            tiles.push(Tile { rect, next, early: Vec::new() });
        }
    }
    Ok(tiles)
}

/// Part of the work.
pub(crate) struct Job {
    tile: usize,
    pub(crate) rect: Rect,
    pub(crate) samples: Range<u32>,
    /// `true` if these are the first samples of its pixels.
    first: bool,
}

/// The work in the order in which it is handed out: few samples of all tiles, then more.
pub(crate) struct Jobs {
    /// For each tile, its pixels and the first sample that is left.
    tiles: Vec<(Rect, u32)>,
    /// The ends of passes, ascending.
    passes: Vec<u32>,
    start: u32,
    next: AtomicUsize,
}

impl Jobs {
    /// The work, with this many samples in the first pass.
    pub(crate) fn new<T: Transport>(tiles: &[Tile<T>], samples: Range<u32>, first: u32) -> Self {
        let mut passes = Vec::new();
        let (mut end, mut size) = (samples.start, first);
        while end < samples.end {
            end = samples.end.min(end.saturating_add(size));
            passes.push(end);
            size = (2 * size).min(16);
        }
        let tiles = tiles.iter().map(|tile| (tile.rect, tile.next)).collect();
        Jobs { tiles, passes, start: samples.start, next: AtomicUsize::new(0) }
    }

    /// An upper bound of the number of jobs.
    fn count(&self) -> usize {
        self.passes.len().saturating_mul(self.tiles.len())
    }

    /// The next job that has not been done before.
    pub(crate) fn next(&self) -> Option<Job> {
        loop {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let (pass, tile) = (number / self.tiles.len(), number % self.tiles.len());
            let end = *self.passes.get(pass)?;
            let begin = if pass == 0 { self.start } else { self.passes[pass - 1] };
            let (rect, left) = self.tiles[tile];
            if left < end {
                return Some(Job { tile, rect, samples: begin.max(left)..end, first: pass == 0 });
            }
        }
    }
}
