//! Stages of paths that are connected or merged with others: paths from lights and from the camera, each with the
//! numbers needed for weights.
//!
//! [`emission`] begins light paths; they are [kept](keep), and seen by the [camera](to_camera). Paths from the camera
//! sample and find [lights](to_lights), are [connected](to_vertices) with light paths and [gather](merge) photons.

mod emission;
mod keep;
mod merge;
mod pairs;
mod to_camera;
mod to_lights;
mod to_vertices;

use lobe_trace::RayClass;

use super::morton::morton;
use super::rays::RayQueue;
use super::{PathState, Scatter, Wavefront};
use crate::channels::Channels;
use crate::clock::Instant;
use crate::connect::{Factors, LightPart, LightVertex, Mis, Pass, SplatAt};
use crate::film::{Film, Rect};
use crate::photon::Near;
use crate::random::Numbers;
use crate::transport::{Transport, TransportMode};
use crate::vec3::{self, Vec3};
use emission::EmittedBlock;
pub(crate) use merge::Merging;
use pairs::Pairs;
use to_camera::CameraBlock;

/// State of a path in addition to its [`PathState`], by slot, because these paths do not branch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk<T: Transport> {
    pub mis: Mis,
    /// The power that left the light, over the density of the ray, in W.
    pub flux: T::Spectrum,
    /// The index of the last hit.
    hit: u32,
    /// `true` if the ray comes from a light without a position.
    from_afar: bool,
}

/// One thread's memory for walks.
#[derive(Debug)]
pub(super) struct Walks<T: Transport> {
    walks: Vec<Walk<T>>,
    choices: Numbers,
    emitted: Vec<EmittedBlock<T>>,
    cameras: Vec<CameraBlock>,
    /// The density of the reverse of a sampled direction, by hit.
    reverse: Vec<f32>,
    pairs: Pairs<T>,
    others: Pairs<T>,
    near: Vec<Near>,
    places: Vec<Vec3>,
    /// Rays between two ends, with the light that passes along them.
    between: RayQueue<SplatAt<T>>,
    hidden: Vec<bool>,
    found: Vec<LightVertex<T>>,
    /// The slot of each.
    found_by: Vec<u32>,
    splats: Vec<SplatAt<T>>,
}

impl<T: Transport> Default for Walks<T> {
    fn default() -> Self {
        Walks {
            walks: Vec::new(),
            choices: Numbers::default(),
            emitted: Vec::new(),
            cameras: Vec::new(),
            reverse: Vec::new(),
            pairs: Pairs::default(),
            others: Pairs::default(),
            near: Vec::new(),
            places: Vec::new(),
            between: RayQueue::default(),
            hidden: Vec::new(),
            found: Vec::new(),
            found_by: Vec::new(),
            splats: Vec::new(),
        }
    }
}

/// The other mode, which is the mode of the reverse path.
fn reversed(mode: TransportMode) -> TransportMode {
    match mode {
        TransportMode::Radiance => TransportMode::Importance,
        TransportMode::Importance => TransportMode::Radiance,
    }
}

impl<T: Transport> Wavefront<'_, T> {
    /// Follows one sample of the pixels of a tile and returns the contributions.
    pub fn camera_paths(&mut self, tile: Rect, pass: &Pass, follow: impl FnOnce(&mut Self)) -> Film<T> {
        let begun = Instant::now();
        let mut film = Film::new(tile);
        self.begin(&morton(tile), pass.number..pass.number + 1);
        self.walks.walks.clear();
        for ray in 0..self.rays.len() {
            // Other points of the lens have the same density.
            let density = pass.pixels * self.view.density(self.rays.direction(ray));
            let mis = Mis::of_camera(density, pass.factors);
            self.walks.walks.push(Walk { mis, flux: T::Spectrum::ONE, hit: 0, from_afar: false });
        }
        follow(self);
        self.add_samples(&mut film);
        self.stats.total += begun.elapsed();
        film
    }

    /// Follows light paths and returns their surfaces.
    pub fn light_paths(
        &mut self,
        paths: std::ops::Range<u32>,
        pass: &Pass,
        follow: impl FnOnce(&mut Self),
    ) -> LightPart<T> {
        let begun = Instant::now();
        self.walks.found.clear();
        self.walks.found_by.clear();
        self.walks.splats.clear();
        self.emit_paths(paths.clone(), pass);
        follow(self);
        let Walks { found, found_by, splats, .. } = &mut self.walks;
        let mut part = LightPart::sorted(paths.len(), found_by, found);
        part.splats.extend_from_slice(splats);
        self.stats.total += begun.elapsed();
        part
    }

    /// Advances the weights of paths to the surfaces that they have hit.
    pub fn arrive(&mut self) {
        let begun = Instant::now();
        for hit in 0..self.hits.len() {
            let walk = &mut self.walks.walks[self.arrived[hit].slot as usize];
            let t = self.found.t[self.queue.order[hit] as usize];
            walk.mis.arrive(if walk.from_afar { 1.0 } else { t * t }, self.hits.front(hit).abs());
            walk.hit = hit as u32;
            walk.from_afar = false;
        }
        self.stats.interactions += begun.elapsed();
    }

    /// Like [`scatter`](Wavefront::scatter), with the numbers needed for weights.
    pub fn scatter_on(&mut self, scatter: Scatter, factors: Factors) {
        self.scatter(scatter);
        let begun = Instant::now();
        let Walks { walks, reverse, .. } = &mut self.walks;
        reverse.resize(self.hits.len(), 0.0);
        for group in &self.queue.groups {
            let (shader, hits) = (&self.world.materials[group.material], group.hits.clone());
            if shader.delta().is_none() {
                let (wo, wi) = (&self.hits.wo()[hits.clone()], &self.bsdf_samples.wi[hits.clone()]);
                shader.pdf(reversed(scatter.mode), wo, wi, &mut reverse[hits], &mut self.scratch);
                self.stats.at(scatter.depth).count(wo.len(), self.backend.lanes());
            }
        }
        self.stats.at(scatter.depth).time += begun.elapsed();
        let begun = Instant::now();
        for (ray, state) in self.rays.states.iter().enumerate() {
            let walk = &mut walks[state.slot as usize];
            let hit = walk.hit as usize;
            let cos = vec3::dot(self.hits.geometric(hit), self.rays.direction(ray)).abs();
            if state.pdf == f32::INFINITY {
                walk.mis.mirror(cos);
            } else {
                walk.mis.scatter(cos, state.pdf, reverse[hit], factors);
            }
        }
        self.stats.scatter += begun.elapsed();
    }

    /// Keeps the rays that have met only mirrors and glass. Returns the others.
    pub fn part_mirrored(&mut self) -> RayQueue<PathState<T>> {
        let (mut mirrored, mut others) = (RayQueue::default(), RayQueue::default());
        for (ray, state) in self.rays.states.iter().enumerate() {
            let queue = if state.pdf == f32::INFINITY { &mut mirrored } else { &mut others };
            queue.push(self.rays.ray(ray), f32::INFINITY, *state);
        }
        self.rays = mirrored;
        others
    }

    /// Traces the rays between ends, and passes those that arrive to `arrives`.
    fn resolve_between(&mut self, class: RayClass, mut arrives: impl FnMut(&mut Self, SplatAt<T>)) {
        let begun = Instant::now();
        let mut between = std::mem::take(&mut self.walks.between);
        let mut hidden = std::mem::take(&mut self.walks.hidden);
        hidden.resize(between.len(), false);
        self.world.scene.occluded(self.backend, class, between.rays.view(), &mut hidden);
        for (splat, hidden) in between.states.iter().zip(&hidden) {
            if !hidden {
                arrives(self, *splat);
            }
        }
        self.stats.rays += between.len() as u64;
        between.clear();
        self.walks.between = between;
        self.walks.hidden = hidden;
        self.stats.trace += begun.elapsed();
    }
}
