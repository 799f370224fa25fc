//! The stage that connects light paths to the camera.

use std::ops::Range;

use lobe::{Floats, Kernel, Lanes};
use lobe_trace::RayClass;

use super::{Walks, Wavefront};
use crate::camera::View;
use crate::clock::Instant;
use crate::columns::{Column, RAYS, ZEROS, ensure_len, store, vector};
use crate::connect::{Pass, SplatAt, Unpolarised};
use crate::interaction::Interactions;
use crate::random::{Dimensions, Numbers};
use crate::transport::TransportMode;
use crate::vec3::{dot, neg};
use crate::vectors::{self, add, scale, select, sub};
use crate::wavefront::rays::Ray;

/// 64 hits as the camera sees them.
#[derive(Clone, Debug)]
pub(super) struct CameraBlock {
    /// Toward the camera, in the world and in the frame.
    toward: [Column; 3],
    local: [Column; 3],
    /// The ray to the camera.
    origin: [Column; 3],
    direction: [Column; 3],
    t_max: Column,
    distance: Column,
    /// Importance over the density of the point of the lens.
    importance: Column,
    raster: [Column; 2],
    /// 1 if it is seen, otherwise 0.
    seen: Column,
}

impl CameraBlock {
    const ZEROS: Self = CameraBlock {
        toward: [ZEROS; 3],
        local: [ZEROS; 3],
        origin: [ZEROS; 3],
        direction: [ZEROS; 3],
        t_max: ZEROS,
        distance: ZEROS,
        importance: ZEROS,
        raster: [ZEROS; 2],
        seen: ZEROS,
    };
}

impl<T: Unpolarised> Wavefront<'_, T> {
    /// Splats the hits of light paths that the camera sees, weighted against the other techniques if these are used.
    pub fn connect_to_camera(&mut self, depth: u32, pass: &Pass, weighted: bool) {
        let begun = Instant::now();
        self.sample_numbers(Dimensions::Light(depth + 1));
        let n = self.hits.len();
        let Walks { walks, cameras, pairs, between, .. } = &mut self.walks;
        ensure_len(cameras, n.div_ceil(RAYS), CameraBlock::ZEROS);
        self.backend.run(SampleCamera {
            view: self.view,
            hits: &self.hits,
            range: 0..n,
            numbers: &self.numbers,
            out: cameras,
        });
        pairs.clear();
        let mut seen = Vec::with_capacity(n);
        for group in &self.queue.groups {
            if !self.world.materials[group.material].lobes().values {
                continue;
            }
            for hit in group.hits.clone() {
                let (block, at) = (&cameras[hit / RAYS], hit % RAYS);
                if block.seen[at] > 0.0 {
                    pairs.push(vector(&block.local, at), self.hits.wo()[hit]);
                    seen.push(hit as u32);
                }
            }
            pairs.end_group(group.material);
        }
        self.stats.lights += begun.elapsed();
        let (materials, mode) = (&self.world.materials, TransportMode::Importance);
        pairs.evaluate(materials, mode, weighted, self.backend.lanes(), &mut self.scratch, self.stats.at(depth));
        let begun = Instant::now();
        for (pair, &hit) in seen.iter().enumerate() {
            let hit = hit as usize;
            let (block, at) = (&cameras[hit / RAYS], hit % RAYS);
            let state = &self.arrived[hit];
            let walk = &walks[state.slot as usize];
            let toward = vector(&block.toward, at);
            let place = self.hits.place(hit);
            let share = if weighted {
                let distance = block.distance[at];
                let density = pass.pixels * self.view.density(neg(toward));
                let over = density * dot(place.geometric, toward).abs() / (distance * distance);
                walk.mis.splatted(over, pairs.reverse[pair], pass.factors)
            } else {
                1.0
            };
            let local = [pairs.wo[pair], pairs.wi[pair]];
            let correction = place.adjoint_correction(local, [place.world(local[0]), toward]);
            let factor = share * correction * block.importance[at] * pass.pixels;
            let radiance = T::radiance(T::apply(state.throughput, T::scale(pairs.f[pair], factor)), walk.flux);
            // NaN must continue, to be counted.
            if radiance.as_ref().iter().fold(false, |some, x| some | (*x != 0.0)) {
                let raster = [block.raster[0][at], block.raster[1][at]];
                let ray = Ray { origin: vector(&block.origin, at), direction: vector(&block.direction, at) };
                between.push(ray, block.t_max[at], SplatAt { raster, radiance });
            }
        }
        self.stats.lights += begun.elapsed();
        self.resolve_between(RayClass::ScatteredShadow, |wave, splat| wave.walks.splats.push(splat));
    }
}

/// Samples the lens for hits.
struct SampleCamera<'a> {
    view: &'a View,
    hits: &'a Interactions,
    range: Range<usize>,
    numbers: &'a Numbers,
    out: &'a mut [CameraBlock],
}

impl Kernel for SampleCamera<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let SampleCamera { view, hits, range, numbers, out } = self;
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let mut at = range.start;
        while at < range.end {
            let surface = hits.load(lanes, at);
            let [u, v, ..] = numbers.lanes(lanes, at);
            let sample = view.sample_we_filtered(lanes, surface.position, [u, v]);
            let local = surface.local(sample.wi);
            let seen = sample.valid & surface.same_side(lanes, sample.wi, local);
            let origin = surface.offset_origin(lanes, surface.lifted, sample.wi);
            let lens = add::<L>(surface.position, scale::<L>(sample.wi, sample.distance));
            let way = sub::<L>(lens, origin);
            let length = vectors::dot::<L>(way, way).sqrt();
            let direction = select(lanes, zero.lt(length), scale::<L>(way, one / length), sample.wi);
            let (out, first) = (&mut out[at / RAYS], at & (RAYS - L::LANES));
            store(lanes, &mut out.toward, first, sample.wi);
            store(lanes, &mut out.local, first, local);
            store(lanes, &mut out.origin, first, origin);
            store(lanes, &mut out.direction, first, direction);
            lanes.store(&mut out.t_max[first..], length);
            lanes.store(&mut out.distance[first..], sample.distance);
            lanes.store(&mut out.importance[first..], sample.importance / sample.pdf);
            lanes.store(&mut out.raster[0][first..], sample.raster[0]);
            lanes.store(&mut out.raster[1][first..], sample.raster[1]);
            lanes.store(&mut out.seen[first..], lanes.select(seen, one, zero));
            at += L::LANES;
        }
    }
}
