//! Statistics of the use of time and lanes.

use std::ops::AddAssign;
use std::time::Duration;

/// Material queries at one depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shading {
    /// Number of pairs of directions evaluated and of directions sampled.
    pub queries: u64,
    /// Number of lanes of the registers that they occupied, used or not.
    pub occupied: u64,
    /// Time that it took.
    pub time: Duration,
}

impl Shading {
    /// The share of lanes that did work.
    pub fn lanes_in_use(&self) -> f64 {
        if self.occupied == 0 { 0.0 } else { self.queries as f64 / self.occupied as f64 }
    }

    /// Counts a batch of `n` queries on this many lanes.
    pub(crate) fn count(&mut self, n: usize, lanes: usize) {
        self.queries += n as u64;
        self.occupied += n.next_multiple_of(lanes) as u64;
    }
}

impl AddAssign for Shading {
    fn add_assign(&mut self, other: Shading) {
        self.queries += other.queries;
        self.occupied += other.occupied;
        self.time += other.time;
    }
}

/// Number of depths that are counted separately; the last one includes all deeper ones.
pub const DEPTHS: usize = 8;

/// Statistics of a rendering, summed over threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Number of paths that left the camera.
    pub samples: u64,
    /// Number of rays traced, including shadow rays.
    pub rays: u64,
    /// Number of paths that left a light.
    pub light_paths: u64,
    /// Number of these that met a surface.
    pub landed: u64,
    /// Number of photons found near a surface that the camera sees.
    pub gathered: u64,
    /// Number of samples whose radiance was not finite, which count as black.
    pub invalid: u64,
    /// Materials by the number of surfaces that the ray had hit before: values, densities and sampled directions.
    pub shading: [Shading; DEPTHS],
    /// Total time.
    pub total: Duration,
    /// Tracing rays.
    pub trace: Duration,
    /// Positions and frames of hits, and the light that rays hit.
    pub interactions: Duration,
    /// Sorting by material.
    pub sort: Duration,
    /// Sampling lights, and preparing shadow rays.
    pub lights: Duration,
    /// Preparing sampled directions and the next rays.
    pub scatter: Duration,
    /// Sorting and finding photons.
    pub gather: Duration,
}

impl Stats {
    /// Materials at these depths together.
    pub fn shading(&self, depths: impl IntoIterator<Item = usize>) -> Shading {
        let mut sum = Shading::default();
        depths.into_iter().filter_map(|depth| self.shading.get(depth)).for_each(|shading| sum += *shading);
        sum
    }

    /// Materials at all depths together.
    pub fn materials(&self) -> Shading {
        self.shading(0..DEPTHS)
    }

    /// The share of the time that materials took.
    pub fn material_share(&self) -> f64 {
        self.materials().time.as_secs_f64() / self.total.as_secs_f64().max(1e-9)
    }

    /// The counter for materials at a depth.
    pub(crate) fn at(&mut self, depth: u32) -> &mut Shading {
        &mut self.shading[(depth as usize).min(DEPTHS - 1)]
    }
}

impl AddAssign for Stats {
    fn add_assign(&mut self, other: Stats) {
        self.samples += other.samples;
        self.rays += other.rays;
        self.light_paths += other.light_paths;
        self.landed += other.landed;
        self.gathered += other.gathered;
        self.invalid += other.invalid;
        self.shading.iter_mut().zip(other.shading).for_each(|(sum, shading)| *sum += shading);
        self.total += other.total;
        self.trace += other.trace;
        self.interactions += other.interactions;
        self.sort += other.sort;
        self.lights += other.lights;
        self.scatter += other.scatter;
        self.gather += other.gather;
    }
}
