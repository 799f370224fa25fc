//! The next rays of the paths.

use std::time::Instant;

use super::{Carried, Wave};
use crate::integrator::Integrator;
use crate::random::Use;
use crate::shader::{Delta, Sampled};
use crate::vec3::{Vec3, dot, scale, sub};

/// Directions drawn by materials.
#[derive(Debug)]
pub(super) struct Scattered<const C: usize> {
    wo: Vec<Vec3>,
    u: Vec<[f32; 2]>,
    wi: Vec<Vec3>,
    weight: Vec<[f32; C]>,
    pdf: Vec<f32>,
}

impl<const C: usize> Default for Scattered<C> {
    fn default() -> Self {
        Scattered { wo: Vec::new(), u: Vec::new(), wi: Vec::new(), weight: Vec::new(), pdf: Vec::new() }
    }
}

/// A ray of `whitted` that carries less than this is not followed.
const NEGLIGIBLE: f32 = 1e-3;
/// From this depth on paths end by chance.
const ROULETTE: u32 = 3;

impl<const C: usize> Wave<'_, C> {
    /// Draws the next rays of the sorted hits. Returns whether all of them are mirrored or refracted.
    pub(super) fn scatter(&mut self, depth: u32) -> bool {
        self.carried.clear();
        self.batch.clear();
        let begun = Instant::now();
        self.draw_sorted(Use::Scatter(depth));
        self.stats.scatter += begun.elapsed();
        let mut specular = true;
        for part in 0..self.queue.parts.len() {
            let material = self.queue.parts[part].0;
            match (self.world.materials[material].delta(), self.integrator) {
                (Some(delta), _) => self.part_of_ways(part, delta),
                (None, Integrator::Path { .. }) => {
                    specular = false;
                    self.draw(part, depth);
                    self.continue_drawn(part, depth);
                }
                (None, _) => {}
            }
        }
        specular
    }

    /// Rays along the exact directions of a smooth surface: one of them by chance, or all.
    fn part_of_ways(&mut self, part: usize, delta: &Delta<C>) {
        let begun = Instant::now();
        for index in self.queue.parts[part].1.clone() {
            let hit = self.queue.order[index] as usize;
            let (mirror, through) = delta.ways(self.hits[hit].wo);
            let ways = [Some(mirror), through].into_iter().flatten();
            if matches!(self.integrator, Integrator::Whitted { .. }) {
                for way in ways {
                    self.follow_way(hit, way.wi, way.weight, NEGLIGIBLE);
                }
                continue;
            }
            let size = |weight: [f32; C]| weight.into_iter().sum::<f32>();
            let (a, b) = (size(mirror.weight), through.map_or(0.0, |way| size(way.weight)));
            if a + b <= 0.0 {
                continue;
            }
            let chance = a / (a + b);
            let u = self.numbers.of(index)[2];
            let (way, chance) = match through {
                Some(way) if u >= chance => (way, 1.0 - chance),
                _ => (mirror, chance),
            };
            self.follow_way(hit, way.wi, way.weight.map(|w| w / chance), 0.0);
        }
        self.stats.scatter += begun.elapsed();
    }

    fn follow_way(&mut self, hit: usize, local: Vec3, weight: [f32; C], least: f32) {
        let (hit, arrived) = (&self.hits[hit], &self.arrived[hit]);
        let throughput: [f32; C] = std::array::from_fn(|k| arrived.throughput[k] * weight[k]);
        let mut wi = hit.world(local);
        if !hit.sees(wi, local) {
            // At the silhouette of facets that a smooth normal hides, the direction is turned back out of the facet.
            let normal = hit.geometric;
            wi = sub(wi, scale(normal, 2.0 * dot(normal, wi)));
        }
        if throughput.iter().any(|t| *t > least) {
            self.batch.rays.push(hit.leave(hit.position, wi), wi, 0.0, f32::INFINITY);
            self.carried.push(Carried { slot: arrived.slot, throughput, pdf: f32::INFINITY });
        }
    }

    /// One material's hits, in full lanes.
    fn draw(&mut self, part: usize, depth: u32) {
        let begun = Instant::now();
        let (material, range) = &self.queue.parts[part];
        let Scattered { wo, u, wi, weight, pdf } = &mut self.scattered;
        wo.clear();
        u.clear();
        wo.extend(self.queue.order[range.clone()].iter().map(|hit| self.hits[*hit as usize].wo));
        u.extend(range.clone().map(|index| {
            let [a, b, ..] = self.numbers.of(index);
            [a, b]
        }));
        wi.resize(wo.len(), [0.0; 3]);
        weight.resize(wo.len(), [0.0; C]);
        pdf.resize(wo.len(), 0.0);
        self.stats.scatter += begun.elapsed();
        let begun = Instant::now();
        let out = Sampled { wi, weight, pdf };
        self.world.materials[*material].sample(wo, u, out, &mut self.scratch);
        self.stats.at(depth).count(wo.len(), self.backend.lanes());
        self.stats.at(depth).time += begun.elapsed();
    }

    /// Rays along the directions drawn, as far as they carry something and chance lets them.
    fn continue_drawn(&mut self, part: usize, depth: u32) {
        let begun = Instant::now();
        let Scattered { wi, weight, pdf, .. } = &self.scattered;
        let range = self.queue.parts[part].1.clone();
        let first = range.start;
        for (i, number) in self.queue.order[range].iter().enumerate() {
            let (hit, arrived) = (&self.hits[*number as usize], &self.arrived[*number as usize]);
            let mut throughput: [f32; C] = std::array::from_fn(|k| arrived.throughput[k] * weight[i][k]);
            let most = throughput.iter().fold(0.0f32, |most, t| most.max(*t));
            let world = hit.world(wi[i]);
            // NaN is no more than 0 either.
            let goes_on = pdf[i] > 0.0 && most > 0.0 && hit.sees(world, wi[i]);
            if !goes_on {
                continue;
            }
            if depth >= ROULETTE {
                let chance = most.min(0.95);
                if self.numbers.of(first + i)[3] >= chance {
                    continue;
                }
                throughput = throughput.map(|t| t / chance);
            }
            self.batch.rays.push(hit.leave(hit.position, world), world, 0.0, f32::INFINITY);
            self.carried.push(Carried { slot: arrived.slot, throughput, pdf: pdf[i] });
        }
        self.stats.scatter += begun.elapsed();
    }
}
