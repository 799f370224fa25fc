//! The stage in which camera paths gather photons.

use super::to_lights::add;
use super::{Walks, Wavefront};
use crate::clock::Instant;
use crate::connect::{Mis, Pass, Unpolarised};
use crate::photon::{LightMap, gather};
use crate::transport::TransportMode;
use crate::vec3::{Vec3, dot};

/// The part of the light that is gathered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Merging {
    /// All of it, because there is no other technique.
    Alone,
    /// The share that is not left to other techniques.
    Weighted,
}

/// Approximate number of photons gathered before materials are evaluated.
const TOGETHER: usize = 8192;

/// The least cosine between the normals of the place and of a photon, so that light does not come around corners.
const ALONG: f32 = 0.5;

impl<T: Unpolarised> Wavefront<'_, T> {
    /// Adds the light that has arrived near the hits.
    pub fn merge_photons(&mut self, depth: u32, pass: &Pass, map: &LightMap<T>, merging: Merging) {
        let Some(radius) = pass.radius.filter(|_| map.photons.len() > 0) else { return };
        let begun = Instant::now();
        let materials = self.stats.at(depth).time;
        let normalization =
            (1.0 / (std::f64::consts::PI * f64::from(radius) * f64::from(radius) * f64::from(pass.paths))) as f32;
        let Walks { walks, pairs, near, places, .. } = &mut self.walks;
        let mut kept: Vec<[u32; 2]> = Vec::new();
        for group in &self.queue.groups {
            let shader = &self.world.materials[group.material];
            if !shader.lobes().values {
                continue;
            }
            places.clear();
            places.extend(group.hits.clone().map(|hit| self.hits.position(hit)));
            let first = group.hits.start;
            let mut from = 0;
            while from < places.len() {
                from = gather(self.backend, &map.photons, places, radius, from, TOGETHER, near);
                pairs.clear();
                kept.clear();
                let mut at = usize::MAX;
                let mut place = crate::place::Place::ZERO;
                for near in &*near {
                    let hit = first + near.place as usize;
                    if at != hit {
                        (at, place) = (hit, self.hits.place(hit));
                    }
                    let photon = &map.photons.photons()[near.photon as usize];
                    let local: Vec3 = place.local(photon.wi);
                    let fits = photon.surfaces + depth <= pass.depth
                        && dot(place.geometric, photon.normal) > ALONG
                        && place.same_side(photon.wi, local);
                    if fits {
                        pairs.push(local, self.hits.wo()[hit]);
                        kept.push([hit as u32, near.photon]);
                    }
                }
                pairs.end_group(group.material);
                let (mode, weighted) = (TransportMode::Radiance, merging == Merging::Weighted);
                let (lanes, scratch) = (self.backend.lanes(), &mut self.scratch);
                pairs.evaluate(&self.world.materials, mode, weighted, lanes, scratch, self.stats.at(depth));
                for (pair, [hit, photon]) in kept.iter().enumerate() {
                    let (hit, photon) = (*hit as usize, &map.photons.photons()[*photon as usize]);
                    let state = &self.arrived[hit];
                    // Light arrives per area of the triangle.
                    let cos = dot(self.hits.geometric(hit), photon.wi).abs();
                    let mut share = normalization / cos.max(1e-4);
                    if weighted {
                        let densities = [pairs.forward[pair], pairs.reverse[pair]];
                        let camera = &walks[state.slot as usize].mis;
                        share *= Mis::merge(&photon.mis, camera, densities, pass.factors);
                    }
                    let f = T::scale(pairs.f[pair], share);
                    let radiance = T::radiance(T::apply(state.throughput, f), photon.flux);
                    add(&mut self.slots[state.slot as usize].sample.radiance, &radiance);
                }
                self.stats.gathered += kept.len() as u64;
            }
        }
        let materials = self.stats.at(depth).time - materials;
        self.stats.gather += begun.elapsed().saturating_sub(materials);
    }
}
