//! Light that comes straight from lights, and what is in its way.

use std::ops::Range;
use std::time::Instant;

use lobe_trace::{Occluded, RayClass, RaySoA};

use super::{Wave, against, rays};
use crate::integrator::Integrator;
use crate::random::Use;
use crate::shader::Evaluated;
use crate::vec3::{Vec3, add, cosine_hemisphere, length, scale, sub};

/// Pairs of directions to be evaluated, and the shadow rays to be traced for them.
#[derive(Debug)]
pub(super) struct Direct<const C: usize> {
    wi: Vec<Vec3>,
    wo: Vec<Vec3>,
    f: Vec<[f32; C]>,
    pdf: Vec<f32>,
    asked: Vec<Asked<C>>,
    parts: Vec<(usize, Range<usize>)>,
    rays: RaySoA,
    /// For each shadow ray whose slot it is and what arrives if nothing is in the way.
    carried: Vec<(u32, [f32; C])>,
    hidden: Vec<bool>,
}

/// A place on a light, seen from a hit.
#[derive(Clone, Copy, Debug)]
struct Asked<const C: usize> {
    hit: u32,
    wi: Vec3,
    distance: f32,
    /// Radiance over the density of the drawing.
    radiance: [f32; C],
    /// That density; `None` for lights without extent.
    pdf: Option<f32>,
}

impl<const C: usize> Default for Direct<C> {
    fn default() -> Self {
        Direct {
            wi: Vec::new(),
            wo: Vec::new(),
            f: Vec::new(),
            pdf: Vec::new(),
            asked: Vec::new(),
            parts: Vec::new(),
            rays: RaySoA::default(),
            carried: Vec::new(),
            hidden: Vec::new(),
        }
    }
}

impl<const C: usize> Wave<'_, C> {
    /// Adds the light that reaches the sorted hits straight from lights: from one that is drawn, or from each in turn.
    pub(super) fn light(&mut self, class: RayClass, depth: u32) {
        let lights = self.world.lights.all.len();
        match self.integrator {
            _ if lights == 0 => {}
            Integrator::Whitted { .. } => (0..lights).for_each(|light| self.round(class, depth, Some(light))),
            _ => self.round(class, depth, None),
        }
    }

    fn round(&mut self, class: RayClass, depth: u32, light: Option<usize>) {
        let begun = Instant::now();
        self.ask(depth, light);
        self.stats.lights += begun.elapsed();
        self.evaluate(depth);
        let begun = Instant::now();
        self.answer(depth);
        self.stats.lights += begun.elapsed();
        let delta = match light {
            Some(light) => self.world.lights.all[light].is_delta(),
            None => self.world.lights.all.iter().all(|light| light.is_delta()),
        };
        self.shadow(class.shadow(delta));
    }

    /// Draws a place on a light for each hit that has a value for pairs of directions.
    fn ask(&mut self, depth: u32, light: Option<usize>) {
        // Each light of a round has numbers of its own.
        let set = Use::Light(depth + 64 * light.unwrap_or(0) as u32);
        self.draw_sorted(set);
        let Direct { wi, wo, asked, parts, .. } = &mut self.direct;
        wi.clear();
        wo.clear();
        asked.clear();
        parts.clear();
        let lights = &self.world.lights;
        for (material, range) in &self.queue.parts {
            if self.world.materials[*material].delta().is_some() {
                continue;
            }
            let begin = asked.len();
            for index in range.clone() {
                let number = self.queue.order[index];
                let hit = &self.hits[number as usize];
                let [u, x, y, _] = self.numbers.of(index);
                let (light, chance) = match light {
                    Some(light) => (light, 1.0),
                    None => lights.choose(u).expect("a light"),
                };
                let Some(lit) = lights.all[light].draw(hit.position, [x, y]) else { continue };
                let local = hit.local(lit.wi);
                if !hit.sees(lit.wi, local) {
                    continue;
                }
                let density = lit.pdf.map_or(chance, |pdf| pdf * chance);
                wi.push(local);
                wo.push(hit.wo);
                asked.push(Asked {
                    hit: number,
                    wi: lit.wi,
                    distance: lit.distance,
                    radiance: lit.radiance.map(|x| x / density),
                    pdf: lit.pdf.map(|_| density),
                });
            }
            if asked.len() > begin {
                parts.push((*material, begin..asked.len()));
            }
        }
    }

    /// Material by material, in full lanes.
    fn evaluate(&mut self, depth: u32) {
        let begun = Instant::now();
        let Direct { wi, wo, f, pdf, parts, .. } = &mut self.direct;
        f.resize(wi.len(), [0.0; C]);
        pdf.resize(wi.len(), 0.0);
        for (material, range) in &*parts {
            let out = Evaluated { f: &mut f[range.clone()], pdf: &mut pdf[range.clone()] };
            let shader = &self.world.materials[*material];
            shader.eval(&wi[range.clone()], &wo[range.clone()], out, &mut self.scratch);
            self.stats.at(depth).count(range.len(), self.backend.lanes());
        }
        self.stats.at(depth).time += begun.elapsed();
    }

    /// Shadow rays for the light that the materials send on.
    fn answer(&mut self, depth: u32) {
        let Direct { asked, f, pdf, rays: shadow, carried, .. } = &mut self.direct;
        rays::clear(shadow);
        carried.clear();
        let weighs = matches!(self.integrator, Integrator::Path { .. });
        let limit = self.integrator.limit(depth + 1);
        for (i, asked) in asked.iter().enumerate() {
            let (hit, arrived) = (&self.hits[asked.hit as usize], &self.arrived[asked.hit as usize]);
            let share = match asked.pdf {
                Some(density) if weighs => against(density, || pdf[i]),
                _ => 1.0,
            };
            let value: [f32; C] = std::array::from_fn(|k| {
                let value = arrived.throughput[k] * f[i][k] * asked.radiance[k] * share;
                if value > limit { limit } else { value }
            });
            // Not a number must go on, to be counted.
            if value.iter().all(|x| *x == 0.0) {
                continue;
            }
            let origin = hit.leave(hit.lifted, asked.wi);
            let (direction, distance) = if asked.distance.is_finite() {
                // From where the ray begins to the same place on the light, which is not as far.
                let way = sub(add(hit.position, scale(asked.wi, asked.distance)), origin);
                let length = length(way);
                (if length > 0.0 { scale(way, 1.0 / length) } else { asked.wi }, length)
            } else {
                (asked.wi, asked.distance)
            };
            // Just short of the light, which is a surface itself.
            shadow.push(origin, direction, 0.0, distance * 0.9999);
            carried.push((arrived.slot, value));
        }
    }

    /// Traces the shadow rays and adds what arrives.
    fn shadow(&mut self, class: RayClass) {
        let begun = Instant::now();
        let Direct { rays, carried, hidden, .. } = &mut self.direct;
        hidden.resize(carried.len(), false);
        self.backend.run(Occluded::new(&self.world.scene, class, rays.view(), hidden));
        for ((slot, value), hidden) in carried.iter().zip(&*hidden) {
            if !hidden {
                let seen = &mut self.slots[*slot as usize].seen;
                seen.radiance.iter_mut().zip(value).for_each(|(sum, value)| *sum += value);
            }
        }
        self.stats.rays += carried.len() as u64;
        self.stats.trace += begun.elapsed();
    }

    /// Ambient occlusion: 1 where a direction drawn by the cosine meets nothing within a distance.
    pub(super) fn ambient(&mut self, class: RayClass, distance: f32) {
        let sequences = self.arrived.iter().map(|carried| self.slots[carried.slot as usize].sequence);
        self.numbers.draw(self.backend, sequences, Use::Scatter(0));
        let Direct { rays: shadow, carried, .. } = &mut self.direct;
        rays::clear(shadow);
        carried.clear();
        for (at, (hit, arrived)) in self.hits.iter().zip(&self.arrived).enumerate() {
            let [x, y, ..] = self.numbers.of(at);
            let mut local = cosine_hemisphere([x, y]);
            if hit.wo[2] < 0.0 {
                local[2] = -local[2];
            }
            let wi = hit.world(local);
            if hit.sees(wi, local) {
                shadow.push(hit.leave(hit.lifted, wi), wi, 0.0, distance);
                carried.push((arrived.slot, [1.0; C]));
            }
        }
        self.shadow(class.shadow(false));
        self.carried.clear();
    }
}
