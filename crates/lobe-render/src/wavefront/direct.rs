//! Light that comes straight from lights, and what is in its way.

use std::ops::Range;
use std::time::Instant;

use lobe::{Floats, Kernel, Lanes};
use lobe_lane::{MAX_LANES, Mask};
use lobe_scalar::Reference;
use lobe_trace::{Occluded, RayClass};

use super::rays::RayQueue;
use super::spawn::{Origin, SpawnedRays, spawn_rays};
use super::{Wavefront, power_heuristic};
use crate::columns::{Column, RAYS, ZEROS, ensure_len, store, vector};
use crate::integrator::Integrator;
use crate::interaction::Interactions;
use crate::light::Lights;
use crate::random::{Dimensions, Numbers};
use crate::shader::Evaluated;
use crate::vec3::Vec3;
use crate::vectors::{add, cosine_hemisphere, dot, scale, select, sub};

/// Pairs of directions to be evaluated, and the shadow rays to be traced for them.
#[derive(Debug, Default)]
pub(super) struct Direct<const C: usize> {
    light_samples: Vec<LightSampleBlock<C>>,
    /// The hits that light may reach, and their pairs of directions.
    reached: Vec<u32>,
    wi: Vec<Vec3>,
    wo: Vec<Vec3>,
    f: Vec<[f32; C]>,
    pdf: Vec<f32>,
    /// For each material its part of them.
    parts: Vec<(usize, Range<usize>)>,
    spawned: Vec<SpawnedRays>,
    /// Shadow rays: whose slot each is, and what arrives if nothing is in the way.
    sent: RayQueue<(u32, [f32; C])>,
    hidden: Vec<bool>,
}

/// Samples of lights for 64 hits, and their shadow rays.
#[derive(Clone, Debug)]
struct LightSampleBlock<const C: usize> {
    /// Toward the light, in the frame of the material.
    wi: [Column; 3],
    /// The shadow ray.
    origin: [Column; 3],
    direction: [Column; 3],
    t_max: Column,
    /// Radiance over the density of the drawing.
    radiance: [Column; C],
    /// That density; infinite for lights without extent.
    pdf: Column,
}

impl<const C: usize> LightSampleBlock<C> {
    const ZEROS: Self = LightSampleBlock {
        wi: [ZEROS; 3],
        origin: [ZEROS; 3],
        direction: [ZEROS; 3],
        t_max: ZEROS,
        radiance: [ZEROS; C],
        pdf: ZEROS,
    };
}

impl<const C: usize> Wavefront<'_, C> {
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
        self.sample_lights(depth, light);
        self.stats.lights += begun.elapsed();
        self.evaluate_bsdfs(depth);
        let begun = Instant::now();
        self.enqueue_shadow_rays(depth);
        self.stats.lights += begun.elapsed();
        let delta = match light {
            Some(light) => self.world.lights.all[light].is_delta(),
            None => self.world.lights.all.iter().all(|light| light.is_delta()),
        };
        self.resolve_shadow_rays(class.shadow(delta));
    }

    /// Draws a place on a light for each hit that has a value for pairs of directions.
    fn sample_lights(&mut self, depth: u32, light: Option<usize>) {
        // Each light of a round has numbers of its own.
        self.draw(Dimensions::Light(depth + 64 * light.unwrap_or(0) as u32));
        let Direct { light_samples, reached, wi, wo, parts, .. } = &mut self.direct;
        let n = self.hits.len();
        ensure_len(light_samples, n.div_ceil(RAYS), LightSampleBlock::ZEROS);
        // One more, to be written over.
        reached.resize(n + 1, 0);
        wi.resize(n + 1, [0.0; 3]);
        wo.resize(n + 1, [0.0; 3]);
        parts.clear();
        let mut count = 0;
        for (material, range) in &self.queue.parts {
            if self.world.materials[*material].delta().is_some() {
                continue;
            }
            let begin = count;
            count += self.backend.run(SampleLights {
                lights: &self.world.lights,
                light,
                hits: &self.hits,
                range: range.clone(),
                numbers: &self.numbers,
                light_samples,
                reached: &mut reached[begin..],
                wi: &mut wi[begin..],
                wo: &mut wo[begin..],
            });
            if count > begin {
                parts.push((*material, begin..count));
            }
        }
        reached.truncate(count);
    }

    /// Material by material, in full lanes.
    fn evaluate_bsdfs(&mut self, depth: u32) {
        let begun = Instant::now();
        let Direct { reached, wi, wo, f, pdf, parts, .. } = &mut self.direct;
        f.resize(reached.len(), [0.0; C]);
        pdf.resize(reached.len(), 0.0);
        for (material, range) in &*parts {
            let out = Evaluated { f: &mut f[range.clone()], pdf: &mut pdf[range.clone()] };
            let shader = &self.world.materials[*material];
            shader.eval(&wi[range.clone()], &wo[range.clone()], out, &mut self.scratch);
            self.stats.at(depth).count(range.len(), self.backend.lanes());
        }
        self.stats.at(depth).time += begun.elapsed();
    }

    /// Shadow rays for the light that the materials send on.
    fn enqueue_shadow_rays(&mut self, depth: u32) {
        let Direct { light_samples, reached, f, pdf, sent, .. } = &mut self.direct;
        let weighs = matches!(self.integrator, Integrator::Path { .. });
        let limit = self.integrator.limit(depth + 1);
        sent.clear();
        sent.extend(reached.len(), |out| {
            for ((&hit, f), &pdf) in reached.iter().zip(&*f).zip(&*pdf) {
                let (light_samples, at) = (&light_samples[hit as usize / RAYS], hit as usize % RAYS);
                let arrived = &self.arrived[hit as usize];
                let share = if weighs { power_heuristic(light_samples.pdf[at], || pdf) } else { 1.0 };
                let value: [f32; C] = std::array::from_fn(|k| {
                    let value = arrived.throughput[k] * f[k] * light_samples.radiance[k][at] * share;
                    if value > limit { limit } else { value }
                });
                // Not a number must go on, to be counted.
                let some = value.iter().fold(false, |some, x| some | (*x != 0.0));
                let ray = (vector(&light_samples.origin, at), vector(&light_samples.direction, at));
                out.write(ray, light_samples.t_max[at], (arrived.slot, value), some);
            }
        });
    }

    /// Traces the shadow rays and adds what arrives.
    fn resolve_shadow_rays(&mut self, class: RayClass) {
        let begun = Instant::now();
        let Direct { sent, hidden, .. } = &mut self.direct;
        hidden.resize(sent.len(), false);
        self.backend.run(Occluded::new(&self.world.scene, class, sent.rays.view(), hidden));
        for ((slot, value), hidden) in sent.states.iter().zip(&*hidden) {
            if !hidden {
                let sample = &mut self.slots[*slot as usize].sample;
                sample.radiance.iter_mut().zip(value).for_each(|(sum, value)| *sum += value);
            }
        }
        self.stats.rays += sent.len() as u64;
        self.stats.trace += begun.elapsed();
    }

    /// Ambient occlusion: 1 where a direction drawn by the cosine meets nothing within a distance.
    pub(super) fn ambient(&mut self, class: RayClass, distance: f32) {
        self.draw(Dimensions::Scatter(0));
        let Direct { wi, spawned, sent, .. } = &mut self.direct;
        let lanes = Reference::default();
        wi.clear();
        for (hit, wo) in self.hits.wo().iter().enumerate() {
            let [x, y, ..] = self.numbers.of(hit);
            let local = lanes.extract_xyz(cosine_hemisphere(lanes, [lanes.splat(x), lanes.splat(y)]), 0);
            wi.push(if wo[2] < 0.0 { [local[0], local[1], -local[2]] } else { local });
        }
        wi.resize(wi.len().next_multiple_of(MAX_LANES), [0.0; 3]);
        spawn_rays(self.backend, &self.hits, Origin::Lifted, wi, spawned);
        sent.clear();
        sent.extend(self.arrived.len(), |out| {
            for (hit, arrived) in self.arrived.iter().enumerate() {
                let (spawned, at) = (&spawned[hit / RAYS], hit % RAYS);
                out.write(spawned.ray(at), distance, (arrived.slot, [1.0; C]), spawned.goes(at));
            }
        });
        self.resolve_shadow_rays(class.shadow(false));
        self.sent.clear();
    }
}

/// Draws places on lights for some of the hits. Returns how many of them light may reach.
struct SampleLights<'a, const C: usize> {
    lights: &'a Lights<C>,
    light: Option<usize>,
    hits: &'a Interactions,
    range: Range<usize>,
    numbers: &'a Numbers,
    light_samples: &'a mut [LightSampleBlock<C>],
    reached: &'a mut [u32],
    wi: &'a mut [Vec3],
    wo: &'a mut [Vec3],
}

impl<const C: usize> Kernel for SampleLights<'_, C> {
    type Out = usize;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> usize {
        let SampleLights { lights, light, hits, range, numbers, light_samples, reached, wi, wo } = self;
        let back = hits.wo();
        let mut count = 0;
        let mut at = range.start & !(L::LANES - 1);
        while at < range.end {
            let place = hits.places(lanes, at);
            let [choice, u, v, _] = numbers.lanes(lanes, at);
            let sample = lights.sample_li(lanes, light, place.position, [choice, u, v]);
            let local = place.local(sample.wi);
            let reaches = (sample.valid & place.same_side(lanes, sample.wi, local)).bits() as usize;

            // From where the ray begins to the same place on the light, which is not as far.
            let origin = place.offset_origin(lanes, place.lifted, sample.wi);
            let way = sub::<L>(add::<L>(place.position, scale::<L>(sample.wi, sample.distance)), origin);
            let length = dot::<L>(way, way).sqrt();
            let (zero, one, infinite) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(f32::INFINITY));
            let near = sample.distance.lt(infinite);
            let direction = select(lanes, near & zero.lt(length), scale::<L>(way, one / length), sample.wi);
            // Just short of the light, which is a surface itself.
            let t_max = lanes.select(near, length, infinite) * lanes.splat(0.9999);

            let (out, first) = (&mut light_samples[at / RAYS], at & (RAYS - L::LANES));
            store(lanes, &mut out.wi, first, local);
            store(lanes, &mut out.origin, first, origin);
            store(lanes, &mut out.direction, first, direction);
            lanes.store(&mut out.t_max[first..], t_max);
            lanes.store(&mut out.pdf[first..], sample.pdf);
            let mut k = 0;
            while k < C {
                lanes.store(&mut out.radiance[k][first..], sample.radiance[k]);
                k += 1;
            }
            let mut hit = at.max(range.start);
            while hit < range.end.min(at + L::LANES) {
                // Written in any case, and written over where it is not to be kept: no branch that cannot be foreseen.
                let lane = hit - at;
                reached[count] = hit as u32;
                wi[count] = vector(&out.wi, first + lane);
                wo[count] = back[hit];
                count += reaches >> lane & 1;
                hit += 1;
            }
            at += L::LANES;
        }
        count
    }
}
