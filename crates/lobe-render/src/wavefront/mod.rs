//! A wave: the paths of a tile, all at the same depth, with their state in the cache.
//!
//! Each stage of a wave has its own module, and integrators compose them: rays are [intersected](intersect) and their
//! hits sorted by material; rays that [escape] reach the environment; surfaces that [emit] add light; lights are
//! sampled for the hits ([next_event]), and [shadow] rays are resolved; materials [scatter] the rays of the next wave.
//! The properties of hits are kept in columns, in sorted order.

mod begin;
mod emit;
mod escape;
mod intersect;
mod material_queue;
mod morton;
mod next_event;
mod rays;
mod scatter;
mod shadow;
mod spawn;
mod walk;

use lobe_trace::HitSoA;

use crate::camera::View;
use crate::film::Sample;
use crate::interaction::Interactions;
use crate::random::{Dimensions, Numbers, Sequence};
use crate::shader::{Backend, Scratch};
use crate::stats::Stats;
use crate::transport::Transport;
use crate::world::World;
pub(crate) use intersect::Keep;
use material_queue::MaterialQueue;
use next_event::NextEventBuffers;
pub(crate) use next_event::{LightChoice, NextEvent};
use rays::RayQueue;
use scatter::BsdfSamples;
pub(crate) use scatter::{DeltaChoice, Scatter};
pub(crate) use shadow::ShadowRay;
use shadow::ShadowRays;
pub(crate) use spawn::{Origin, spawn_rays};
pub(crate) use walk::Merging;
use walk::Walks;

/// Approximate number of paths of a wave: a material that covers a hundredth of them still fills its lanes, and their
/// state, a few hundred bytes each, stays in the cache.
pub(crate) const PATHS: usize = 8192;

/// The origin of a path and its contribution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathSlot<T: Transport> {
    pub pixel: [u32; 2],
    pub sequence: Sequence,
    pub sample: Sample<T>,
}

/// The state of a path along a ray. If an integrator branches, several rays may have the same slot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathState<T: Transport> {
    pub slot: u32,
    /// The throughput that is applied to light that arrives along the ray.
    pub throughput: T::Throughput,
    /// The density with which the direction was sampled; infinite if it was the only possible one.
    pub pdf: f32,
}

/// One thread's memory for waves over one scene.
pub(crate) struct Wavefront<'w, T: Transport> {
    pub world: &'w World<T>,
    pub view: &'w View,
    pub backend: Backend,
    pub slots: Vec<PathSlot<T>>,
    /// Columns and rows of the pixels of the slots.
    pixels: [Vec<f32>; 2],
    /// The rays of the wave.
    pub rays: RayQueue<PathState<T>>,
    found: HitSoA,
    /// The rays that have hit something, sorted; their interactions; and the states of their paths.
    queue: MaterialQueue,
    pub hits: Interactions,
    pub arrived: Vec<PathState<T>>,
    next_event: NextEventBuffers<T>,
    pub shadow: ShadowRays<T>,
    bsdf_samples: BsdfSamples<T>,
    pub numbers: Numbers,
    scratch: Scratch,
    /// Additional state of paths that are connected or merged with others.
    walks: Walks<T>,
    pub stats: Stats,
}

impl<'w, T: Transport> Wavefront<'w, T> {
    pub fn new(world: &'w World<T>, view: &'w View, backend: Backend) -> Self {
        Wavefront {
            world,
            view,
            backend,
            slots: Vec::new(),
            pixels: [Vec::new(), Vec::new()],
            rays: RayQueue::default(),
            found: HitSoA::default(),
            queue: MaterialQueue::default(),
            hits: Interactions::default(),
            arrived: Vec::new(),
            next_event: NextEventBuffers::default(),
            shadow: ShadowRays::default(),
            bsdf_samples: BsdfSamples::default(),
            numbers: Numbers::default(),
            scratch: Scratch::default(),
            walks: Walks::default(),
            stats: Stats::default(),
        }
    }

    /// Samples random numbers for the hits.
    pub fn sample_numbers(&mut self, dimensions: Dimensions) {
        let sequences = self.arrived.iter().map(|state| self.slots[state.slot as usize].sequence);
        self.numbers.sample(self.backend, sequences, dimensions);
    }
}

/// The weight of a sample with density `pdf` if another technique would have sampled it with density `other`: the power
/// heuristic of Veach 1997 ("Robust Monte Carlo Methods for Light Transport Simulation", section 9.2.4).
fn power_heuristic(pdf: f32, other: f32) -> f32 {
    if pdf == f32::INFINITY {
        return 1.0;
    }
    let ratio = other / pdf;
    1.0 / (1.0 + ratio * ratio)
}

/// Adds light that arrives at the slot of a path, no channel of it more than `limit`.
fn accumulate<T: Transport>(slot: &mut PathSlot<T>, radiance: T::Radiance, limit: f32) {
    let radiance = T::limited(radiance, limit);
    for (sum, value) in slot.sample.radiance.as_mut().iter_mut().zip(radiance.as_ref()) {
        *sum += value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_two_techniques_add_up_to_one() {
        let (a, b) = (0.3f32, 2.0f32);
        assert!((power_heuristic(a, b) + power_heuristic(b, a) - 1.0).abs() < 1e-6);
        assert_eq!(power_heuristic(f32::INFINITY, 1.0), 1.0);
    }
}
