//! Statistics of a rendering, in a line or as JSON.

use std::fmt;
use std::time::Duration;

use lobe_render::{DEPTHS, Stats};
use serde::Serialize;

/// The figures of one rendering.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// The rendered columns and rows.
    size: [u32; 2],
    /// The fewest and the most samples of a pixel.
    samples: [u32; 2],
    /// The time from the first ray to the last.
    seconds: f64,
    /// Rays traced.
    rays: u64,
    /// Samples that were not finite.
    invalid: u64,
    /// Shares of the threads' time.
    shares: Shares,
    /// The share of lanes in use while materials were evaluated, by the number of earlier surfaces on the path.
    lanes_in_use: Vec<f64>,
    /// The same at all depths together.
    lanes: f64,
}

#[derive(Debug, Serialize)]
struct Shares {
    trace: f64,
    materials: f64,
    lights: f64,
    sort: f64,
    other: f64,
}

impl Summary {
    /// Computes the summary.
    pub fn new(size: [u32; 2], (least, most): (u32, u32), elapsed: Duration, stats: &Stats) -> Self {
        let share = |time: Duration| time.as_secs_f64() / stats.total.as_secs_f64().max(1e-9);
        let materials = stats.materials();
        let (trace, lights, sort) = (share(stats.trace), share(stats.lights), share(stats.sort));
        let other = (1.0 - trace - lights - sort - share(materials.time)).max(0.0);
        let asked = (0..DEPTHS).map(|depth| stats.shading([depth])).take_while(|shading| shading.queries > 0);
        Summary {
            size,
            samples: [least, most],
            seconds: elapsed.as_secs_f64(),
            rays: stats.rays,
            invalid: stats.invalid,
            shares: Shares { trace, materials: share(materials.time), lights, sort, other },
            lanes_in_use: asked.map(|shading| shading.lanes_in_use()).collect(),
            lanes: materials.lanes_in_use(),
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([width, height], [least, most]) = (self.size, self.samples);
        let samples = if least == most { most.to_string() } else { format!("{least} to {most}") };
        let millions = self.rays as f64 * 1e-6;
        write!(f, "{width} x {height} pixels of {samples} samples in {:.1} s: ", self.seconds)?;
        write!(f, "{millions:.1} million rays, {:.1} million per second; ", millions / self.seconds.max(1e-9))?;
        let Shares { trace, materials, .. } = self.shares;
        write!(f, "{:.0} % of the time tracing, {:.0} % in materials", 100.0 * trace, 100.0 * materials)?;
        if self.lanes > 0.0 {
            write!(f, " with {:.0} % of the lanes in use", 100.0 * self.lanes)?;
        }
        Ok(())
    }
}
