//! The gain from lanes in whole pictures: frames of a scene of many measured materials, and the rays alone.

mod kinds;
mod light;
mod packets;
mod scene;
mod show;

use std::time::{Duration, Instant};

use lobe::Backend;
use lobe_render::{DEPTHS, Film, Settings, Stats, World, render};
use serde::Serialize;

use kinds::Kind;
use light::LightRays;
use packets::Packets;

/// The name by which it can be selected.
pub const ID: &str = "pictures";

/// All figures of the section.
#[derive(Debug, Serialize)]
pub struct Pictures {
    /// Materials of the scene.
    materials: usize,
    /// Triangles of the scene.
    triangles: usize,
    /// One per backend, scalar first.
    frames: Vec<Frame>,
    /// Time of a frame on one thread divided by the time on two, on the last backend; `None` on a machine with one
    /// core.
    threads: Option<f64>,
    /// Four-ray packets compared with the scalar instance of the same code; empty on a machine without SSE2.
    packets: Vec<Packets>,
    /// Rays from the lights on the last backend, by the number of surfaces that they have met.
    light: Vec<LightRays>,
    /// Another scene on the last backend, in several kinds of light; red, green and blue first.
    kinds: Vec<Kind>,
}

/// A frame on one thread.
#[derive(Clone, Debug, Serialize)]
struct Frame {
    backend: &'static str,
    milliseconds: f64,
    /// The share of the frame that was spent in materials.
    material_share: f64,
    /// Nanoseconds in a material per pair of directions or sample, after at least one bounce.
    bounced_nanoseconds: f64,
    /// The share of lanes in use while materials were evaluated, by the number of surfaces hit before.
    lanes_in_use: Vec<f64>,
}

/// Renders and traces.
///
/// # Errors
/// If the fixture of the cloth cannot be read.
pub fn measure(quick: bool) -> anyhow::Result<Pictures> {
    let rounds = if quick { 3 } else { 12 };
    let mut backends = vec![Backend::named("scalar")?];
    backends.extend(Backend::named("sse2").ok());
    let best = Backend::best().fused();
    if backends.iter().all(|backend| backend.name() != best.name()) {
        backends.push(best);
    }
    let worlds = backends.iter().map(|&backend| scene::world(backend)).collect::<anyhow::Result<Vec<_>>>()?;
    let mut frames: Vec<Frame> = Vec::new();
    let mut threads = [f64::INFINITY; 2];
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    for _ in 0..rounds {
        for (at, (backend, world)) in backends.iter().zip(&worlds).enumerate() {
            let frame = Frame::take(world, *backend);
            match frames.get_mut(at) {
                Some(best) => best.keep_the_least(&frame),
                None => frames.push(frame),
            }
        }
        if cores > 1
            && let (Some(backend), Some(world)) = (backends.last(), worlds.last())
        {
            for (threads, least) in [1, 2].into_iter().zip(&mut threads) {
                let settings = Settings { backend: *backend, threads, samples: 0..SHARED, ..scene::settings() };
                *least = least.min(picture(world, settings).0.as_secs_f64());
            }
        }
    }
    let triangles = worlds.first().map_or(0, World::triangles);
    let threads = (cores > 1).then_some(threads[0] / threads[1]);
    let light = match (backends.last(), worlds.last()) {
        (Some(backend), Some(world)) => light::measure(world, *backend, rounds),
        _ => Vec::new(),
    };
    let packets = packets::measure(rounds);
    let kinds = kinds::measure(best, rounds)?;
    Ok(Pictures { materials: scene::MATERIALS, triangles, frames, threads, packets, light, kinds })
}

/// Samples of the frames that threads share: so many that the last tile of each thread is a small part of the work.
const SHARED: u32 = 8;

/// The time of a frame, and how it was spent.
fn picture(world: &World, settings: Settings) -> (Duration, Stats) {
    let begun = Instant::now();
    let (_, stats) = render(world, &settings, Film::new(settings.window), |_| true).expect("a camera and a window");
    (begun.elapsed(), stats)
}

impl Frame {
    fn take(world: &World, backend: Backend) -> Self {
        let (time, stats) = picture(world, Settings { backend, threads: 1, ..scene::settings() });
        let bounced = stats.shading(1..DEPTHS);
        let depths = (0..DEPTHS).map(|depth| stats.shading([depth])).take_while(|shading| shading.queries > 0);
        Frame {
            backend: backend.name(),
            milliseconds: 1e3 * time.as_secs_f64(),
            material_share: stats.material_share(),
            bounced_nanoseconds: 1e9 * bounced.time.as_secs_f64() / bounced.queries.max(1) as f64,
            lanes_in_use: depths.map(|shading| shading.lanes_in_use()).collect(),
        }
    }

    fn keep_the_least(&mut self, other: &Frame) {
        if other.milliseconds < self.milliseconds {
            (self.milliseconds, self.material_share) = (other.milliseconds, other.material_share);
        }
        self.bounced_nanoseconds = self.bounced_nanoseconds.min(other.bounced_nanoseconds);
    }
}
