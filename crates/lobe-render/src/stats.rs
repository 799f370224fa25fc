//! What time and lanes are spent on.

use std::ops::AddAssign;
use std::time::Duration;

/// The queries of materials at one depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shading {
    /// Pairs of directions evaluated, and directions sampled.
    pub queries: u64,
    /// Lanes that were occupied by them, full or not.
    pub occupied: u64,
    /// How long it took.
    pub time: Duration,
}

impl Shading {
    /// The share of lanes that did work.
    pub fn lanes_in_use(&self) -> f64 {
        if self.occupied == 0 { 0.0 } else { self.queries as f64 / self.occupied as f64 }
    }

    /// Counts a batch of `n` queries on that many lanes.
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

/// Depths that are counted separately; the last one includes all that are deeper.
pub const DEPTHS: usize = 8;

/// What a rendering took, summed over threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Paths that left the camera.
    pub samples: u64,
    /// Rays traced, shadow rays with them.
    pub rays: u64,
    /// Paths that left a light.
    pub light_paths: u64,
    /// Those of them that met a surface.
    pub landed: u64,
    /// Photons that were near a surface that the camera sees.
    pub gathered: u64,
    /// Samples whose radiance was not finite, and which count as black.
    pub invalid: u64,
    /// Materials by the number of surfaces that the ray had hit before: values, densities and sampled directions.
    pub shading: [Shading; DEPTHS],
    /// Everything.
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

    /// What materials at a depth are counted in.
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
