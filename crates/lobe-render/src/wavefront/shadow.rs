//! The stage that resolves shadow rays: light arrives unless something blocks it.

use lobe_trace::RayClass;

use super::Wavefront;
use super::rays::RayQueue;
use crate::clock::Instant;
use crate::transport::Transport;

/// The light that a shadow ray decides about.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowRay<T: Transport> {
    /// The slot of its path.
    pub slot: u32,
    /// The light that arrives if nothing is in the way.
    pub radiance: T::Radiance,
}

/// Shadow rays to be traced.
#[derive(Debug)]
pub(crate) struct ShadowRays<T: Transport> {
    pub queue: RayQueue<ShadowRay<T>>,
    hidden: Vec<bool>,
}

impl<T: Transport> Default for ShadowRays<T> {
    fn default() -> Self {
        ShadowRays { queue: RayQueue::default(), hidden: Vec::new() }
    }
}

impl<T: Transport> Wavefront<'_, T> {
    /// Traces the shadow rays of the queue and adds the arriving light to their paths.
    pub fn resolve_shadow_rays(&mut self, class: RayClass) {
        let begun = Instant::now();
        let ShadowRays { queue, hidden } = &mut self.shadow;
        hidden.resize(queue.len(), false);
        self.world.scene.occluded(self.backend, class, queue.rays.view(), hidden);
        for (ShadowRay { slot, radiance }, hidden) in queue.states.iter().zip(&*hidden) {
            if !hidden {
                let sum = &mut self.slots[*slot as usize].sample.radiance;
                sum.as_mut().iter_mut().zip(radiance.as_ref()).for_each(|(sum, value)| *sum += value);
            }
        }
        self.stats.rays += queue.len() as u64;
        self.stats.trace += begun.elapsed();
    }
}
