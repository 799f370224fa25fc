//! The next rays of the paths.

use std::time::Instant;

use lobe_lane::{Lanes, MAX_LANES, Mask};
use lobe_scalar::Reference;

use super::spawn::{Origin, SpawnedRays, spawn_rays};
use super::{PathState, Wavefront};
use crate::columns::RAYS;
use crate::integrator::Integrator;
use crate::random::Dimensions;
use crate::shader::{Delta, Sampled};
use crate::vec3::Vec3;
use crate::vectors::{dot, scale, sub};

/// Directions drawn by materials, one a hit.
#[derive(Debug, Default)]
pub(super) struct BsdfSamples<const C: usize> {
    u: Vec<[f32; 2]>,
    wi: Vec<Vec3>,
    weight: Vec<[f32; C]>,
    pdf: Vec<f32>,
    rays: Vec<SpawnedRays>,
}

/// A ray of `whitted` that carries less than this is not followed.
const NEGLIGIBLE: f32 = 1e-3;
/// From this depth on paths end by chance.
const ROULETTE: u32 = 3;

impl<const C: usize> Wavefront<'_, C> {
    /// Draws the next rays of the sorted hits. Returns whether all of them are mirrored or refracted.
    pub(super) fn scatter(&mut self, depth: u32) -> bool {
        self.sent.clear();
        let begun = Instant::now();
        self.draw(Dimensions::Scatter(depth));
        let n = self.hits.len();
        let BsdfSamples { u, wi, weight, pdf, .. } = &mut self.bsdf_samples;
        u.clear();
        u.extend((0..n).map(|hit| self.numbers.of(hit)).map(|[a, b, ..]| [a, b]));
        wi.resize(n.next_multiple_of(MAX_LANES), [0.0; 3]);
        weight.resize(n, [0.0; C]);
        pdf.resize(n, 0.0);
        self.stats.scatter += begun.elapsed();
        let mut specular = true;
        for part in 0..self.queue.parts.len() {
            let material = self.queue.parts[part].0;
            match (self.world.materials[material].delta(), self.integrator) {
                (Some(delta), _) => self.scatter_delta(part, delta),
                (None, Integrator::Path { .. }) => {
                    specular = false;
                    self.sample(part, depth);
                }
                (None, _) => {}
            }
        }
        if !specular {
            self.continue_paths(depth);
        }
        specular
    }

    /// Rays along the exact directions of a smooth surface: one of them by chance, or all.
    fn scatter_delta(&mut self, part: usize, delta: &Delta<C>) {
        let begun = Instant::now();
        for hit in self.queue.parts[part].1.clone() {
            let (mirror, through) = delta.samples(self.hits.wo()[hit]);
            let ways = [Some(mirror), through].into_iter().flatten();
            if matches!(self.integrator, Integrator::Whitted { .. }) {
                for way in ways {
                    self.push_delta(hit, way.wi, way.weight, NEGLIGIBLE);
                }
                continue;
            }
            let size = |weight: [f32; C]| weight.into_iter().sum::<f32>();
            let (a, b) = (size(mirror.weight), through.map_or(0.0, |way| size(way.weight)));
            if a + b <= 0.0 {
                continue;
            }
            let chance = a / (a + b);
            let u = self.numbers.of(hit)[2];
            let (way, chance) = match through {
                Some(way) if u >= chance => (way, 1.0 - chance),
                _ => (mirror, chance),
            };
            self.push_delta(hit, way.wi, way.weight.map(|w| w / chance), 0.0);
        }
        self.stats.scatter += begun.elapsed();
    }

    fn push_delta(&mut self, hit: usize, local: Vec3, weight: [f32; C], least: f32) {
        let arrived = &self.arrived[hit];
        let throughput: [f32; C] = std::array::from_fn(|k| arrived.throughput[k] * weight[k]);
        if !throughput.iter().any(|t| t.abs() > least) {
            return;
        }
        let lanes = Reference::default();
        let place = self.hits.places(lanes, hit);
        let local = lanes.splat_xyz(local);
        let mut wi = place.world(local);
        if !place.same_side(lanes, wi, local).any() {
            // At the silhouette of facets that a smooth normal hides, the direction is turned back out of the facet.
            let (normal, two) = (place.geometric, lanes.splat(2.0));
            wi = sub::<Reference>(wi, scale::<Reference>(normal, two * dot::<Reference>(normal, wi)));
        }
        let origin = place.offset_origin(lanes, place.position, wi);
        let ray = (lanes.extract_xyz(origin, 0), lanes.extract_xyz(wi, 0));
        self.sent.push(ray, f32::INFINITY, PathState { slot: arrived.slot, throughput, pdf: f32::INFINITY });
    }

    /// One material's hits, in full lanes.
    fn sample(&mut self, part: usize, depth: u32) {
        let begun = Instant::now();
        let (material, range) = &self.queue.parts[part];
        let BsdfSamples { u, wi, weight, pdf, .. } = &mut self.bsdf_samples;
        let (wo, u) = (&self.hits.wo()[range.clone()], &u[range.clone()]);
        let out =
            Sampled { wi: &mut wi[range.clone()], weight: &mut weight[range.clone()], pdf: &mut pdf[range.clone()] };
        self.world.materials[*material].sample(wo, u, out, &mut self.scratch);
        self.stats.at(depth).count(wo.len(), self.backend.lanes());
        self.stats.at(depth).time += begun.elapsed();
    }

    /// Rays along the directions drawn, as far as they carry something and chance lets them.
    fn continue_paths(&mut self, depth: u32) {
        let begun = Instant::now();
        let BsdfSamples { wi, weight, pdf, rays, .. } = &mut self.bsdf_samples;
        spawn_rays(self.backend, &self.hits, Origin::Surface, wi, rays);
        self.sent.extend(self.hits.len(), |out| {
            for (material, range) in &self.queue.parts {
                if self.world.materials[*material].delta().is_some() {
                    continue;
                }
                for hit in range.clone() {
                    let (arrived, ray) = (&self.arrived[hit], &rays[hit / RAYS]);
                    let mut throughput: [f32; C] = std::array::from_fn(|k| arrived.throughput[k] * weight[hit][k]);
                    let most = throughput.iter().fold(0.0f32, |most, t| most.max(t.abs()));
                    // NaN is no more than 0 either.
                    let mut goes = (pdf[hit] > 0.0) & (most > 0.0) & ray.goes(hit % RAYS);
                    if depth >= ROULETTE {
                        let chance = most.min(0.95);
                        goes &= self.numbers.of(hit)[3] < chance;
                        throughput = throughput.map(|t| t / chance);
                    }
                    let state = PathState { slot: arrived.slot, throughput, pdf: pdf[hit] };
                    out.write(ray.ray(hit % RAYS), f32::INFINITY, state, goes);
                }
            }
        });
        self.stats.scatter += begun.elapsed();
    }
}
