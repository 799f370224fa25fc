//! Where time and lanes go.

use std::ops::AddAssign;
use std::time::Duration;

/// What a rendering took, summed over threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Paths that left the camera.
    pub samples: u64,
    /// Rays traced, shadow rays with them.
    pub rays: u64,
    /// Samples whose radiance was no finite number, and which count as black.
    pub invalid: u64,
    /// Pairs of directions and drawings that materials were asked for.
    pub queries: u64,
    /// Lanes that were occupied by them, full or not.
    pub occupied: u64,
    /// Everything.
    pub total: Duration,
    /// Tracing rays.
    pub trace: Duration,
    /// Materials: values, densities and drawn directions.
    pub material: Duration,
    /// Positions and frames of hits, and the light that rays meet.
    pub meet: Duration,
    /// Sorting by material.
    pub sort: Duration,
    /// Drawing places on lights, and preparing shadow rays.
    pub lights: Duration,
    /// Preparing drawn directions and the next rays.
    pub scatter: Duration,
}

impl Stats {
    /// The share of lanes that did work while materials were evaluated.
    pub fn lanes_in_use(&self) -> f64 {
        if self.occupied == 0 { 0.0 } else { self.queries as f64 / self.occupied as f64 }
    }

    /// The share of the time that materials took.
    pub fn material_share(&self) -> f64 {
        self.material.as_secs_f64() / self.total.as_secs_f64().max(1e-9)
    }

    /// Counts a batch of `n` queries on that many lanes.
    pub(crate) fn lanes(&mut self, n: usize, lanes: usize) {
        self.queries += n as u64;
        self.occupied += n.next_multiple_of(lanes) as u64;
    }
}

impl AddAssign for Stats {
    fn add_assign(&mut self, other: Stats) {
        self.samples += other.samples;
        self.rays += other.rays;
        self.invalid += other.invalid;
        self.queries += other.queries;
        self.occupied += other.occupied;
        self.total += other.total;
        self.trace += other.trace;
        self.material += other.material;
        self.meet += other.meet;
        self.sort += other.sort;
        self.lights += other.lights;
        self.scatter += other.scatter;
    }
}
