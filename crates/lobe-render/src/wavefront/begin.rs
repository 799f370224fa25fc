//! The stage of camera rays: begins the first wave of a tile, and sums all of its waves.

use std::ops::Range;

use lobe_lane::MAX_LANES;

use super::morton::morton;
use super::rays::{self, RayQueue};
use super::{PATHS, PathSlot, PathState, Wavefront};
use crate::clock::Instant;
use crate::film::{Film, Rect, Sample};
use crate::integrator::Stages;
use crate::random::{Dimensions, Sequence};
use crate::transport::Transport;

impl<T: Transport> Wavefront<'_, T> {
    /// Follows the paths of these samples of a tile with an integrator and returns their contributions.
    pub fn render(&mut self, integrator: &impl Stages, tile: Rect, samples: Range<u32>) -> Film<T> {
        let begun = Instant::now();
        let mut film = Film::new(tile);
        let pixels = morton(tile);
        let together = (PATHS / pixels.len()).max(1);
        let mut from = samples.start;
        while from < samples.end {
            let until = samples.end.min(from.saturating_add(together as u32));
            self.begin(&pixels, from..until);
            integrator.follow(self);
            self.add_samples(&mut film);
            from = until;
        }
        self.stats.total += begun.elapsed();
        film
    }

    /// Adds the contributions of the paths to their pixels.
    pub(super) fn add_samples(&mut self, film: &mut Film<T>) {
        for slot in &self.slots {
            let at = film.index(slot.pixel[0], slot.pixel[1]);
            let finite = film.pixels_mut()[at].add(&slot.sample);
            self.stats.invalid += u64::from(!finite);
        }
    }

    /// Generates camera rays, in packets of neighbours.
    pub(super) fn begin(&mut self, pixels: &[[u32; 2]], samples: Range<u32>) {
        self.slots.clear();
        self.rays.clear();
        for sample in samples {
            let slot = |&pixel| PathSlot { pixel, sequence: Sequence::new(pixel, sample), sample: Sample::EMPTY };
            self.slots.extend(pixels.iter().map(slot));
        }
        self.numbers.sample(self.backend, self.slots.iter().map(|slot| slot.sequence), Dimensions::Camera);
        let n = self.slots.len();
        for (axis, column) in self.pixels.iter_mut().enumerate() {
            column.clear();
            column.extend(self.slots.iter().map(|slot| slot.pixel[axis] as f32));
            column.resize(n.next_multiple_of(MAX_LANES), 0.0);
        }
        let RayQueue { rays, states } = &mut self.rays;
        rays::fill(rays, n.next_multiple_of(MAX_LANES));
        self.view.rays(self.backend, &self.pixels, &self.numbers, rays);
        rays::fill(rays, n);
        let (basis, top) = (&self.world.basis, self.view.top());
        states.extend((0..n).map(|slot| {
            let direction = rays.direction.each_ref().map(|column| column[slot]);
            PathState { slot: slot as u32, throughput: T::at_camera(basis, top, direction), pdf: f32::INFINITY }
        }));
        self.stats.samples += self.slots.len() as u64;
    }
}
