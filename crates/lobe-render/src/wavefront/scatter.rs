//! The stage that scatters paths, which gives the rays of the next wave.

use lobe_lane::{Lanes, MAX_LANES, Mask};
use lobe_scalar::Reference;

use super::rays::Ray;
use super::spawn::{Origin, SpawnedRays, spawn_rays};
use super::{PathState, Wavefront};
use crate::channels::Channels;
use crate::clock::Instant;
use crate::columns::RAYS;
use crate::interaction::Interactions;
use crate::random::Dimensions;
use crate::shader::{Choice, Delta, DeltaSample, DeltaSamples, Sampled};
use crate::transport::{Bounce, Transport, TransportMode};
use crate::vec3::Vec3;
use crate::vectors::{dot, scale, sub};

/// How paths are scattered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scatter {
    /// Number of surfaces that the path has hit before this one.
    pub depth: u32,
    /// The quantity that the path carries.
    pub mode: TransportMode,
    /// The exact directions of mirrors and glass that are followed.
    pub delta: DeltaChoice,
    /// The depth from which paths end by Russian roulette; `None` if paths end at materials that have values.
    pub roulette: Option<u32>,
}

/// The exact directions that are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum DeltaChoice {
    /// A randomly chosen one.
    One,
    /// All directions that carry more than this.
    Branch(f32),
}

/// Directions sampled by materials, one per hit.
#[derive(Debug)]
pub(super) struct BsdfSamples<T: Transport> {
    u: Vec<[f32; 2]>,
    pub wi: Vec<Vec3>,
    weight: Vec<T::Scattering>,
    pdf: Vec<f32>,
    rays: Vec<SpawnedRays>,
}

impl<T: Transport> Default for BsdfSamples<T> {
    fn default() -> Self {
        BsdfSamples { u: Vec::new(), wi: Vec::new(), weight: Vec::new(), pdf: Vec::new(), rays: Vec::new() }
    }
}

impl<T: Transport> Wavefront<'_, T> {
    /// Replaces the rays of the wave by those that its hits scatter. Returns `true` if all of them have exact
    /// directions.
    pub fn scatter(&mut self, scatter: Scatter) -> bool {
        self.rays.clear();
        let begun = Instant::now();
        self.sample_numbers(Dimensions::Scatter(scatter.depth));
        let n = self.hits.len();
        let BsdfSamples { u, wi, weight, pdf, .. } = &mut self.bsdf_samples;
        u.clear();
        u.extend((0..n).map(|hit| self.numbers.of(hit)).map(|[a, b, ..]| [a, b]));
        wi.resize(n.next_multiple_of(MAX_LANES), [0.0; 3]);
        weight.resize(n, T::ABSORBED);
        pdf.resize(n, 0.0);
        self.stats.scatter += begun.elapsed();
        let mut specular = true;
        for group in 0..self.queue.groups.len() {
            let shader = &self.world.materials[self.queue.groups[group].material];
            if let Some(delta) = shader.delta() {
                self.scatter_delta(group, delta, scatter);
            } else if scatter.roulette.is_some() {
                specular = false;
                self.sample_bsdf(group, scatter);
            }
        }
        if let Some(roulette) = scatter.roulette
            && !specular
        {
            self.continue_paths(scatter, roulette);
        }
        specular
    }

    /// Rays along the exact directions of a smooth surface: a randomly chosen one, or all.
    fn scatter_delta(&mut self, group: usize, delta: &Delta<T::Spectrum>, scatter: Scatter) {
        let begun = Instant::now();
        for hit in self.queue.groups[group].hits.clone() {
            let DeltaSamples { reflection, transmission } = self.delta_samples(hit, delta, scatter.mode);
            if let DeltaChoice::Branch(least) = scatter.delta {
                self.push_delta(hit, reflection, scatter, least);
                if let Some(transmission) = transmission {
                    self.push_delta(hit, transmission, scatter, least);
                }
                continue;
            }
            let size = |sample: &DeltaSample<T::Spectrum>| sample.weight.as_ref().iter().sum::<f32>();
            let (a, b) = (size(&reflection), transmission.as_ref().map_or(0.0, size));
            if a + b <= 0.0 {
                continue;
            }
            let chance = a / (a + b);
            let u = self.numbers.of(hit)[2];
            let (sample, chance) = match transmission {
                Some(transmission) if u >= chance => (transmission, 1.0 - chance),
                _ => (reflection, chance),
            };
            let weight = sample.weight.map(|w| w / chance);
            self.push_delta(hit, DeltaSample { weight, ..sample }, scatter, 0.0);
        }
        self.stats.scatter += begun.elapsed();
    }

    fn delta_samples(&self, hit: usize, delta: &Delta<T::Spectrum>, mode: TransportMode) -> DeltaSamples<T::Spectrum> {
        let wo = self.hits.wo()[hit];
        if !T::POLARISED && !delta.disperses() {
            return delta.samples(mode, wo);
        }
        let lone = delta.disperses().then(|| T::lone(&self.arrived[hit].throughput, self.numbers.of(hit)[0]));
        delta.samples_of(mode, wo, Choice { is_polarised: T::POLARISED, lone })
    }

    fn push_delta(&mut self, hit: usize, sample: DeltaSample<T::Spectrum>, scatter: Scatter, least: f32) {
        let PathState { slot, throughput, .. } = self.arrived[hit];
        let mut throughput = if T::POLARISED {
            let bounce = Bounce { frame: self.hits.frame(hit), wi: sample.wi, wo: self.hits.wo()[hit] };
            T::bounce_exactly(throughput, sample.weight, sample.polarisation.as_ref(), &bounce)
        } else {
            T::apply(throughput, T::scattering(sample.weight))
        };
        // NaN is not followed either.
        let carries = T::magnitude(&throughput) > least;
        if !carries {
            return;
        }
        let lanes = Reference::default();
        let surface = self.hits.load(lanes, hit);
        let local = lanes.splat_xyz(sample.wi);
        let mut wi = surface.world(local);
        if !surface.same_side(lanes, wi, local).any() {
            // At the silhouette of facets hidden by a smooth normal, the direction is rotated back out of the facet.
            let (normal, two) = (surface.geometric, lanes.splat(2.0));
            wi = sub::<Reference>(wi, scale::<Reference>(normal, two * dot::<Reference>(normal, wi)));
        }
        if scatter.mode == TransportMode::Importance {
            throughput = T::weigh(throughput, adjoint_correction(&self.hits, hit, sample.wi));
        }
        let origin = lanes.extract_xyz(surface.offset_origin(lanes, surface.position, wi), 0);
        let ray = Ray { origin, direction: lanes.extract_xyz(wi, 0) };
        self.rays.push(ray, f32::INFINITY, PathState { slot, throughput, pdf: f32::INFINITY });
    }

    /// Samples directions for the hits of one material, in full lanes.
    fn sample_bsdf(&mut self, group: usize, scatter: Scatter) {
        let begun = Instant::now();
        let hits = self.queue.groups[group].hits.clone();
        let BsdfSamples { u, wi, weight, pdf, .. } = &mut self.bsdf_samples;
        let (wo, u) = (&self.hits.wo()[hits.clone()], &u[hits.clone()]);
        let out = Sampled { wi: &mut wi[hits.clone()], weight: &mut weight[hits.clone()], pdf: &mut pdf[hits] };
        let shader = &self.world.materials[self.queue.groups[group].material];
        shader.sample(scatter.mode, wo, u, out, &mut self.scratch);
        self.stats.at(scatter.depth).count(wo.len(), self.backend.lanes());
        self.stats.at(scatter.depth).time += begun.elapsed();
    }

    /// Rays along the sampled directions, if they carry something and survive Russian roulette.
    fn continue_paths(&mut self, scatter: Scatter, roulette: u32) {
        let begun = Instant::now();
        let Scatter { depth, mode, .. } = scatter;
        let Wavefront { world, hits, arrived, numbers, queue, .. } = self;
        let BsdfSamples { wi, weight, pdf, rays, .. } = &mut self.bsdf_samples;
        spawn_rays(self.backend, hits, Origin::Surface, wi, rays);
        self.rays.extend(hits.len(), |out| {
            for group in &queue.groups {
                if world.materials[group.material].delta().is_some() {
                    continue;
                }
                for hit in group.hits.clone() {
                    let (arrived, ray) = (&arrived[hit], &rays[hit / RAYS]);
                    let mut throughput = if T::POLARISED {
                        let bounce = Bounce { frame: hits.frame(hit), wi: wi[hit], wo: hits.wo()[hit] };
                        T::bounce(&arrived.throughput, &weight[hit], &bounce)
                    } else {
                        T::apply(arrived.throughput, weight[hit])
                    };
                    if mode == TransportMode::Importance {
                        throughput = T::weigh(throughput, adjoint_correction(hits, hit, wi[hit]));
                    }
                    let most = T::magnitude(&throughput);
                    // This also drops NaN.
                    let mut goes = (pdf[hit] > 0.0) & (most > 0.0) & ray.goes(hit % RAYS);
                    if depth >= roulette {
                        let chance = most.min(0.95);
                        goes &= numbers.of(hit)[3] < chance;
                        throughput = T::survive(throughput, chance);
                    }
                    let state = PathState { slot: arrived.slot, throughput, pdf: pdf[hit] };
                    out.write(ray.ray(hit % RAYS), f32::INFINITY, state, goes);
                }
            }
        });
        self.stats.scatter += begun.elapsed();
    }
}

/// The correction of importance at a hit for its shading normal.
fn adjoint_correction(hits: &Interactions, hit: usize, wi: Vec3) -> f32 {
    let lanes = Reference::default();
    let [wo, wi] = [hits.wo()[hit], wi].map(|local| lanes.splat_xyz(local));
    lanes.extract(hits.load(lanes, hit).adjoint_correction(lanes, wo, wi), 0)
}
