//! A wave: the paths of a tile, all at the same depth, their state in the cache.
//!
//! Camera packets are traced; the hits are sorted by material; each material is evaluated and sampled in full lanes for
//! all of its hits; shadow rays are traced; what goes on is the next wave. What is known of a hit lies in columns, in
//! the order of the sort.

mod direct;
mod queue;
mod rays;
mod scatter;
mod spawn;

use std::time::Instant;

use lobe_lane::{Lanes, MAX_LANES};
use lobe_scalar::Reference;
use lobe_trace::{HitSoA, Intersect, MISS, RayClass};

use crate::camera::View;
use crate::film::{Film, Rect, Sample};
use crate::integrator::Integrator;
use crate::interaction::Interactions;
use crate::light::Light;
use crate::random::{Dimensions, Numbers, Sequence};
use crate::shader::{Backend, Scratch};
use crate::stats::Stats;
use crate::vec3::Vec3;
use crate::world::World;
use direct::Direct;
use queue::Queue;
use rays::RayQueue;
use scatter::BsdfSamples;

/// About how many paths are under way at once: a material that covers a hundredth of them still fills its lanes, and
/// their state, a few hundred bytes each, stays in the cache.
pub(crate) const PATHS: usize = 8192;

/// Where a path came from and what it has seen.
#[derive(Clone, Copy, Debug)]
struct PathSlot<const C: usize> {
    pixel: [u32; 2],
    sequence: Sequence,
    sample: Sample<C>,
}

/// What a ray carries. With `whitted`, several rays have the same slot.
#[derive(Clone, Copy, Debug)]
struct PathState<const C: usize> {
    slot: u32,
    /// What radiance that comes along the ray is multiplied by.
    throughput: [f32; C],
    /// The density with which the direction was drawn; infinite where it could be no other.
    pdf: f32,
}

/// One thread's memory for waves over one scene.
pub(crate) struct Wavefront<'w, const C: usize> {
    world: &'w World<C>,
    view: &'w View,
    integrator: Integrator,
    backend: Backend,
    slots: Vec<PathSlot<C>>,
    /// Columns and rows of the pixels of the slots.
    pixels: [Vec<f32>; 2],
    sent: RayQueue<PathState<C>>,
    found: HitSoA,
    /// Rays that have hit something, sorted; where, and what they carry.
    queue: Queue,
    hits: Interactions,
    arrived: Vec<PathState<C>>,
    direct: Direct<C>,
    bsdf_samples: BsdfSamples<C>,
    numbers: Numbers,
    scratch: Scratch,
    pub stats: Stats,
}

impl<'w, const C: usize> Wavefront<'w, C> {
    pub fn new(world: &'w World<C>, view: &'w View, integrator: Integrator, backend: Backend) -> Self {
        Wavefront {
            world,
            view,
            integrator,
            backend,
            slots: Vec::new(),
            pixels: [Vec::new(), Vec::new()],
            sent: RayQueue::default(),
            found: HitSoA::default(),
            queue: Queue::default(),
            hits: Interactions::default(),
            arrived: Vec::new(),
            direct: Direct::default(),
            bsdf_samples: BsdfSamples::default(),
            numbers: Numbers::default(),
            scratch: Scratch::default(),
            stats: Stats::default(),
        }
    }

    /// Follows the samples of a tile. Returns what they see.
    pub fn render(&mut self, tile: Rect, samples: std::ops::Range<u32>) -> Film<C> {
        let begun = Instant::now();
        let mut film = Film::new(tile);
        let pixels = morton(tile);
        let together = (PATHS / pixels.len()).max(1);
        let mut from = samples.start;
        while from < samples.end {
            let until = samples.end.min(from.saturating_add(together as u32));
            self.begin(&pixels, from..until);
            self.follow();
            for slot in &self.slots {
                let at = film.index(slot.pixel[0], slot.pixel[1]);
                let finite = film.pixels_mut()[at].add(&slot.sample);
                self.stats.invalid += u64::from(!finite);
            }
            from = until;
        }
        self.stats.total += begun.elapsed();
        film
    }

    /// Camera rays, packets of neighbours.
    fn begin(&mut self, pixels: &[[u32; 2]], samples: std::ops::Range<u32>) {
        self.slots.clear();
        self.sent.clear();
        for sample in samples {
            let slot = |&pixel| PathSlot { pixel, sequence: Sequence::new(pixel, sample), sample: Sample::EMPTY };
            self.slots.extend(pixels.iter().map(slot));
        }
        self.numbers.draw(self.backend, self.slots.iter().map(|slot| slot.sequence), Dimensions::Camera);
        let n = self.slots.len();
        for (axis, places) in self.pixels.iter_mut().enumerate() {
            places.clear();
            places.extend(self.slots.iter().map(|slot| slot.pixel[axis] as f32));
            places.resize(n.next_multiple_of(MAX_LANES), 0.0);
        }
        let RayQueue { rays, states } = &mut self.sent;
        rays::fill(rays, n.next_multiple_of(MAX_LANES));
        self.view.rays(self.backend, &self.pixels, &self.numbers, rays);
        rays::fill(rays, n);
        states.extend((0..n).map(|slot| PathState { slot: slot as u32, throughput: [1.0; C], pdf: f32::INFINITY }));
        self.stats.samples += self.slots.len() as u64;
    }

    /// From the camera on, depth by depth.
    fn follow(&mut self) {
        let mut class = RayClass::Camera;
        let last = self.integrator.depth();
        for depth in 0..=last {
            if self.sent.is_empty() {
                break;
            }
            self.trace(class);
            self.sort(depth);
            self.shade_hits(depth);
            match self.integrator {
                Integrator::Normals => self.show_normals(),
                Integrator::Ambient { distance } => self.ambient(class, distance),
                Integrator::Path { .. } | Integrator::Whitted { .. } if depth < last => {
                    self.light(class, depth);
                    let specular = self.scatter(depth);
                    class = class.bounce(specular);
                }
                Integrator::Path { .. } | Integrator::Whitted { .. } => break,
            }
        }
    }

    fn trace(&mut self, class: RayClass) {
        let begun = Instant::now();
        rays::fit(&mut self.found, self.sent.len());
        self.backend.run(Intersect::new(&self.world.scene, class, self.sent.rays.view(), self.found.view()));
        self.stats.trace += begun.elapsed();
        self.stats.rays += self.sent.len() as u64;
    }

    /// Takes the light of rays that leave the scene, and sorts the others by the materials they have hit.
    fn sort(&mut self, depth: u32) {
        let begun = Instant::now();
        let debugging = self.integrator.is_debugging();
        let limit = self.integrator.limit(depth);
        // The last rays look for lights only.
        let all = depth == 0 || depth < self.integrator.depth();
        let (triangles, parts) = (self.world.triangles.as_slice(), &self.world.parts);
        let primitives = &self.found.primitive;
        self.queue.split(primitives.iter().map(|&primitive| primitive != MISS));
        self.queue.sort(self.world.materials.len(), |ray| {
            let part = &parts[triangles[primitives[ray] as usize][3] as usize];
            (all || part.light.is_some()).then_some(part.material)
        });
        if !debugging && let Some(sky) = self.world.lights.environment {
            for &ray in &self.queue.missed {
                let state = &self.sent.states[ray as usize];
                let radiance = background(self.world, sky, (self.sent.direction(ray as usize), state.pdf));
                add(&mut self.slots[state.slot as usize].sample.radiance, state.throughput, radiance, limit);
            }
        }
        self.arrived.clear();
        self.arrived.extend(self.queue.order.iter().map(|ray| self.sent.states[*ray as usize]));
        self.stats.sort += begun.elapsed();
    }

    /// Finds the places on surfaces, and takes the light of those that shine.
    fn shade_hits(&mut self, depth: u32) {
        let begun = Instant::now();
        let found = &self.found;
        self.hits.find(self.backend, self.world, &self.queue.order, &self.sent.rays, found);
        let debugging = self.integrator.is_debugging();
        let limit = self.integrator.limit(depth);
        for (hit, &part) in self.hits.parts().iter().enumerate() {
            let part = &self.world.parts[part as usize];
            if depth > 0 && part.light.is_none() {
                continue;
            }
            let (state, ray) = (&self.arrived[hit], self.queue.order[hit] as usize);
            let sample = &mut self.slots[state.slot as usize].sample;
            if depth == 0 {
                sample.normal = self.hits.normal(hit);
                sample.albedo = self.world.materials[part.material as usize].albedo();
                sample.depth = found.t[ray];
                sample.material = part.material + 1;
            }
            if !debugging && let Some(light) = part.light {
                let way = (found.t[ray], self.hits.front(hit), state.pdf);
                add(&mut sample.radiance, state.throughput, emission(self.world, light as usize, way), limit);
            }
        }
        self.stats.interactions += begun.elapsed();
    }

    /// Draws random numbers for the hits.
    fn draw(&mut self, of: Dimensions) {
        let sequences = self.arrived.iter().map(|state| self.slots[state.slot as usize].sequence);
        self.numbers.draw(self.backend, sequences, of);
    }

    /// The shading normal as a colour.
    fn show_normals(&mut self) {
        for (hit, state) in self.arrived.iter().enumerate() {
            let normal = self.hits.normal(hit);
            let sample = &mut self.slots[state.slot as usize].sample;
            sample.radiance = std::array::from_fn(|k| 0.5 + 0.5 * normal[k.min(2)]);
        }
        self.sent.clear();
    }
}

/// Radiance from where there is no surface, for a ray of that direction, which was drawn with that density.
fn background<const C: usize>(world: &World<C>, index: usize, (direction, pdf): (Vec3, f32)) -> [f32; C] {
    let Light::Environment(environment) = &world.lights.all[index] else { return [0.0; C] };
    let (radiance, density) = environment.seen(direction);
    let share = power_heuristic(pdf, || world.lights.chance(index) * density);
    radiance.map(|x| x * share)
}

/// Radiance from a surface that shines, for a ray that was drawn with that density, comes from that far, and has that
/// cosine with the normal.
fn emission<const C: usize>(world: &World<C>, index: usize, (distance, cos, pdf): (f32, f32, f32)) -> [f32; C] {
    let Light::Area(area) = &world.lights.all[index] else { return [0.0; C] };
    let lanes = Reference::default();
    let density = || lanes.extract(area.pdf(lanes, lanes.splat(distance), lanes.splat(cos)), 0);
    let share = power_heuristic(pdf, || world.lights.chance(index) * density());
    area.emitted(cos > 0.0).map(|x| x * share)
}

/// The share of a sample that was drawn with density `pdf` where another way would have drawn it with density `other`:
/// the power heuristic of Veach 1997 ("Robust Monte Carlo Methods for Light Transport Simulation", section 9.2.4).
fn power_heuristic(pdf: f32, other: impl FnOnce() -> f32) -> f32 {
    if pdf == f32::INFINITY {
        return 1.0;
    }
    let ratio = other() / pdf;
    1.0 / (1.0 + ratio * ratio)
}

/// Adds `throughput * radiance`, no channel of it more than `limit`.
fn add<const C: usize>(sum: &mut [f32; C], throughput: [f32; C], radiance: [f32; C], limit: f32) {
    for k in 0..C {
        // Written so that what is no number stays one, to be counted.
        let value = throughput[k] * radiance[k];
        sum[k] += if value > limit { limit } else { value };
    }
}

/// The pixels of a tile, neighbours close to each other: Morton's order.
fn morton(tile: Rect) -> Vec<[u32; 2]> {
    let side = tile.width.max(tile.height).next_power_of_two();
    let mut pixels = Vec::with_capacity(tile.area());
    for code in 0..u64::from(side) * u64::from(side) {
        let [x, y] = [every_other_bit(code), every_other_bit(code >> 1)];
        if x < tile.width && y < tile.height {
            pixels.push([tile.x + x, tile.y + y]);
        }
    }
    pixels
}

fn every_other_bit(code: u64) -> u32 {
    let mut bits = code & 0x5555_5555_5555_5555;
    for (shift, mask) in [
        (1, 0x3333_3333_3333_3333),
        (2, 0x0f0f_0f0f_0f0f_0f0f),
        (4, 0x00ff_00ff_00ff_00ff),
        (8, 0x0000_ffff_0000_ffff),
        (16, 0xffff_ffff),
    ] {
        bits = (bits | bits >> shift) & mask;
    }
    bits as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_of_a_tile_once_and_neighbours_together() {
        let tile = Rect { x: 10, y: 20, width: 13, height: 7 };
        let pixels = morton(tile);
        assert_eq!(pixels.len(), 13 * 7);
        assert_eq!(pixels[..4], [[10, 20], [11, 20], [10, 21], [11, 21]]);
        let mut sorted = pixels.clone();
        sorted.sort();
        sorted.dedup();
        assert_eq!(sorted.len(), pixels.len());
    }

    #[test]
    fn shares_of_two_ways_are_one() {
        let (a, b) = (0.3f32, 2.0f32);
        assert!((power_heuristic(a, || b) + power_heuristic(b, || a) - 1.0).abs() < 1e-6);
        assert_eq!(power_heuristic(f32::INFINITY, || 1.0), 1.0);
    }
}
