//! The stage that samples lights for the hits of a wave: next-event estimation.

use std::ops::Range;

use lobe::{Floats, Kernel, Lanes};
use lobe_lane::Mask;
use lobe_trace::RayClass;

use super::material_queue::MaterialHits;
use super::rays::Ray;
use super::shadow::ShadowRay;
use super::{Wavefront, power_heuristic};
use crate::channels::Channels;
use crate::clock::Instant;
use crate::columns::{Column, RAYS, ZEROS, ensure_len, store, vector};
use crate::interaction::Interactions;
use crate::light::Lights;
use crate::random::{Dimensions, Numbers};
use crate::shader::Evaluated;
use crate::transport::{Bounce, Transport, TransportMode};
use crate::vec3::Vec3;
use crate::vectors::{add, dot, scale, select, sub};

/// How lights are sampled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NextEvent {
    /// The class of the rays that have arrived.
    pub class: RayClass,
    /// Number of surfaces that the paths have hit before this one.
    pub depth: u32,
    pub lights: LightChoice,
    /// `true` if samples are weighted against directions sampled by materials (multiple importance sampling).
    pub weighted: bool,
    /// The largest contribution to a channel of a path.
    pub limit: f32,
}

/// The lights that are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LightChoice {
    /// A randomly chosen one.
    One,
    /// Each in turn.
    Each,
}

/// Pairs of directions to be evaluated.
#[derive(Debug)]
pub(super) struct NextEventBuffers<T: Transport> {
    pub light_samples: Vec<LightSampleBlock<T>>,
    /// The hits that light may reach, with their pairs of directions.
    pub reached: Vec<u32>,
    pub wi: Vec<Vec3>,
    pub wo: Vec<Vec3>,
    pub f: Vec<T::Scattering>,
    pub pdf: Vec<f32>,
    /// The range of each material.
    pub groups: Vec<MaterialHits>,
}

impl<T: Transport> Default for NextEventBuffers<T> {
    fn default() -> Self {
        NextEventBuffers {
            light_samples: Vec::new(),
            reached: Vec::new(),
            wi: Vec::new(),
            wo: Vec::new(),
            f: Vec::new(),
            pdf: Vec::new(),
            groups: Vec::new(),
        }
    }
}

/// Samples of lights for 64 hits, and their shadow rays.
#[derive(Clone, Debug)]
pub(super) struct LightSampleBlock<T: Transport> {
    /// Toward the light, in the frame of the material.
    wi: [Column; 3],
    /// The shadow ray.
    pub origin: [Column; 3],
    pub direction: [Column; 3],
    pub t_max: Column,
    /// Radiance over the density of the sample.
    radiance: <T::Spectrum as Channels>::Columns,
    /// The density of the sample; infinite for lights without extent.
    pub pdf: Column,
    /// The number of the light, if light is polarised.
    light: [i32; RAYS],
}

impl<T: Transport> LightSampleBlock<T> {
    const ZEROS: Self = LightSampleBlock {
        wi: [ZEROS; 3],
        origin: [ZEROS; 3],
        direction: [ZEROS; 3],
        t_max: ZEROS,
        radiance: T::Spectrum::ZERO_COLUMNS,
        pdf: ZEROS,
        light: [0; RAYS],
    };

    #[inline(always)]
    pub fn emitted(&self, at: usize) -> T::Spectrum {
        let mut emitted = T::Spectrum::ZERO;
        for (value, column) in emitted.as_mut().iter_mut().zip(self.radiance.as_ref()) {
            *value = column[at];
        }
        emitted
    }
}

impl<T: Transport> Wavefront<'_, T> {
    /// Adds direct light at the hits.
    pub fn next_event(&mut self, event: NextEvent) {
        let lights = self.world.lights.all.len();
        match event.lights {
            _ if lights == 0 => {}
            LightChoice::One => self.next_event_on(event, None),
            LightChoice::Each => (0..lights).for_each(|light| self.next_event_on(event, Some(light))),
        }
    }

    fn next_event_on(&mut self, event: NextEvent, light: Option<usize>) {
        let begun = Instant::now();
        self.sample_lights(event.depth, light);
        self.stats.lights += begun.elapsed();
        self.evaluate_bsdfs(event.depth);
        let begun = Instant::now();
        self.enqueue_shadow_rays(event);
        self.stats.lights += begun.elapsed();
        let delta = match light {
            Some(light) => self.world.lights.all[light].is_delta(),
            None => self.world.lights.all.iter().all(|light| light.is_delta()),
        };
        self.resolve_shadow_rays(event.class.shadow(delta));
    }

    /// Samples a light for each hit whose material has values for pairs of directions.
    pub(super) fn sample_lights(&mut self, depth: u32, light: Option<usize>) {
        // Each light has its own random numbers.
        self.sample_numbers(Dimensions::Light(depth + 64 * light.unwrap_or(0) as u32));
        let NextEventBuffers { light_samples, reached, wi, wo, groups, .. } = &mut self.next_event;
        let n = self.hits.len();
        ensure_len(light_samples, n.div_ceil(RAYS), LightSampleBlock::ZEROS);
        // One more, to be overwritten.
        reached.resize(n + 1, 0);
        wi.resize(n + 1, [0.0; 3]);
        wo.resize(n + 1, [0.0; 3]);
        groups.clear();
        let mut count = 0;
        for MaterialHits { material, hits } in &self.queue.groups {
            if !self.world.materials[*material].lobes().values {
                continue;
            }
            let begin = count;
            count += self.backend.run(SampleLights {
                lights: &self.world.lights,
                light,
                hits: &self.hits,
                range: hits.clone(),
                numbers: &self.numbers,
                samples: light_samples,
                reached: &mut reached[begin..],
                wi: &mut wi[begin..],
                wo: &mut wo[begin..],
            });
            if count > begin {
                groups.push(MaterialHits { material: *material, hits: begin..count });
            }
        }
        reached.truncate(count);
    }

    /// Evaluates the pairs material by material, in full lanes.
    pub(super) fn evaluate_bsdfs(&mut self, depth: u32) {
        let begun = Instant::now();
        let NextEventBuffers { reached, wi, wo, f, pdf, groups, .. } = &mut self.next_event;
        f.resize(reached.len(), T::ABSORBED);
        pdf.resize(reached.len(), 0.0);
        for MaterialHits { material, hits } in &*groups {
            let out = Evaluated { f: &mut f[hits.clone()], pdf: &mut pdf[hits.clone()] };
            let shader = &self.world.materials[*material];
            shader.eval(TransportMode::Radiance, &wi[hits.clone()], &wo[hits.clone()], out, &mut self.scratch);
            self.stats.at(depth).count(hits.len(), self.backend.lanes());
        }
        self.stats.at(depth).time += begun.elapsed();
    }

    /// Shadow rays for the light that the materials scatter.
    fn enqueue_shadow_rays(&mut self, event: NextEvent) {
        let NextEventBuffers { light_samples, reached, f, pdf, wi, .. } = &self.next_event;
        let queue = &mut self.shadow.queue;
        queue.clear();
        queue.extend(reached.len(), |out| {
            for (pair, ((&hit, f), &pdf)) in reached.iter().zip(f).zip(pdf).enumerate() {
                let (sample, at) = (&light_samples[hit as usize / RAYS], hit as usize % RAYS);
                let arrived = &self.arrived[hit as usize];
                let share = if event.weighted { power_heuristic(sample.pdf[at], pdf) } else { 1.0 };
                let radiance = if T::POLARISED {
                    let hit = hit as usize;
                    let bounce = Bounce { frame: self.hits.frame(hit), wi: wi[pair], wo: self.hits.wo()[hit] };
                    let polarisation = self.world.lights.polarisation(sample.light[at] as usize);
                    let toward = vector(&sample.direction, at);
                    T::scattered_radiance(&arrived.throughput, f, &bounce, sample.emitted(at), polarisation, toward)
                } else {
                    T::radiance(T::apply(arrived.throughput, *f), sample.emitted(at))
                };
                let radiance = T::limited(radiance.map(|value| value * share), event.limit);
                // NaN must continue, to be counted.
                let some = radiance.as_ref().iter().fold(false, |some, x| some | (*x != 0.0));
                let ray = Ray { origin: vector(&sample.origin, at), direction: vector(&sample.direction, at) };
                out.write(ray, sample.t_max[at], ShadowRay { slot: arrived.slot, radiance }, some);
            }
        });
    }
}

/// Samples lights for some of the hits. Returns the number of hits that light may reach.
struct SampleLights<'a, T: Transport> {
    lights: &'a Lights<T::Spectrum>,
    light: Option<usize>,
    hits: &'a Interactions,
    range: Range<usize>,
    numbers: &'a Numbers,
    samples: &'a mut [LightSampleBlock<T>],
    reached: &'a mut [u32],
    wi: &'a mut [Vec3],
    wo: &'a mut [Vec3],
}

impl<T: Transport> Kernel for SampleLights<'_, T> {
    type Out = usize;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> usize {
        let SampleLights { lights, light, hits, range, numbers, samples, reached, wi, wo } = self;
        let back = hits.wo();
        let mut count = 0;
        let mut at = range.start & !(L::LANES - 1);
        while at < range.end {
            let surface = hits.load(lanes, at);
            let [choice, u, v, _] = numbers.lanes(lanes, at);
            let sample = lights.sample_li(lanes, light, surface.position, [choice, u, v]);
            let local = surface.local(sample.wi);
            let reaches = (sample.valid & surface.same_side(lanes, sample.wi, local)).bits() as usize;

            // From the origin of the ray to the same point on the light, which is slightly nearer.
            let origin = surface.offset_origin(lanes, surface.lifted, sample.wi);
            let way = sub::<L>(add::<L>(surface.position, scale::<L>(sample.wi, sample.distance)), origin);
            let length = dot::<L>(way, way).sqrt();
            let (zero, one, infinite) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(f32::INFINITY));
            let near = sample.distance.lt(infinite);
            let direction = select(lanes, near & zero.lt(length), scale::<L>(way, one / length), sample.wi);
            // Ends just before the light, which is itself a surface.
            let t_max = lanes.select(near, length, infinite) * lanes.splat(0.9999);

            let (out, first) = (&mut samples[at / RAYS], at & (RAYS - L::LANES));
            store(lanes, &mut out.wi, first, local);
            store(lanes, &mut out.origin, first, origin);
            store(lanes, &mut out.direction, first, direction);
            lanes.store(&mut out.t_max[first..], t_max);
            lanes.store(&mut out.pdf[first..], sample.pdf);
            if T::POLARISED {
                let number = match light {
                    Some(light) => lanes.splat_int(light as i32),
                    None => lights.chosen_by(lanes, choice),
                };
                lanes.store_int(&mut out.light[first..], number);
            }
            let (columns, radiance) = (out.radiance.as_mut(), sample.radiance.as_ref());
            let mut k = 0;
            while k < T::Spectrum::COUNT {
                lanes.store(&mut columns[k][first..], radiance[k]);
                k += 1;
            }
            let mut hit = at.max(range.start);
            while hit < range.end.min(at + L::LANES) {
                // Always written, and overwritten if it is not kept: a branch would be unpredictable.
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
