//! The stage that connects camera paths with the surfaces of a light path.

use lobe_trace::RayClass;

use super::to_lights::add;
use super::{Walks, Wavefront};
use crate::clock::Instant;
use crate::connect::{LightVertex, Meeting, Mis, Pass, SplatAt, Unpolarised};
use crate::photon::LightMap;
use crate::transport::TransportMode;
use crate::vec3::{dot, length, neg, scale, sub};
use crate::wavefront::rays::Ray;

/// A hit and a surface with which it is connected.
struct Connection<'a, T: Unpolarised> {
    hit: usize,
    vertex: &'a LightVertex<T>,
    /// Unit vector from the hit, and the distance.
    wi: [f32; 3],
    distance: f32,
}

impl<T: Unpolarised> Wavefront<'_, T> {
    /// Adds the light that reaches the hits from the surfaces of the light paths that are their partners.
    pub fn connect_to_vertices(&mut self, depth: u32, pass: &Pass, map: &LightMap<T>) {
        let begun = Instant::now();
        let Walks { walks, pairs, others, between, .. } = &mut self.walks;
        let mut connections: Vec<Connection<'_, T>> = Vec::with_capacity(2 * self.hits.len());
        pairs.clear();
        for group in &self.queue.groups {
            if !self.world.materials[group.material].lobes().values {
                continue;
            }
            for hit in group.hits.clone() {
                let slot = self.arrived[hit].slot as usize;
                let vertices = map.path(pass.partner(self.slots[slot].pixel));
                if vertices.is_empty() {
                    continue;
                }
                let place = self.hits.place(hit);
                for vertex in vertices.iter().take_while(|vertex| vertex.surfaces + depth < pass.depth) {
                    let way = sub(vertex.place.position, place.position);
                    let distance = length(way);
                    let near = distance > 0.0 && distance < f32::INFINITY;
                    if !near {
                        continue;
                    }
                    let wi = scale(way, 1.0 / distance);
                    let (here, there) = (place.local(wi), vertex.place.local(neg(wi)));
                    if place.same_side(wi, here) && vertex.place.same_side(neg(wi), there) {
                        pairs.push(here, self.hits.wo()[hit]);
                        connections.push(Connection { hit, vertex, wi, distance });
                    }
                }
            }
            pairs.end_group(group.material);
        }
        // The other ends, sorted by material: a counting sort.
        let mut starts = vec![0u32; self.world.materials.len() + 1];
        for connection in &connections {
            starts[connection.vertex.material as usize + 1] += 1;
        }
        for material in 0..self.world.materials.len() {
            starts[material + 1] += starts[material];
        }
        let mut order = vec![0u32; connections.len()];
        others.clear();
        others.wi.resize(connections.len(), [0.0; 3]);
        others.wo.resize(connections.len(), [0.0; 3]);
        let mut next = starts.clone();
        for (pair, Connection { vertex, wi, .. }) in connections.iter().enumerate() {
            let at = &mut next[vertex.material as usize];
            order[pair] = *at;
            others.wi[*at as usize] = vertex.place.local(neg(*wi));
            others.wo[*at as usize] = vertex.wo;
            *at += 1;
        }
        for (material, ends) in starts.windows(2).enumerate() {
            if ends[0] < ends[1] {
                others.groups.push((material, ends[0] as usize..ends[1] as usize));
            }
        }
        self.stats.lights += begun.elapsed();
        let (materials, lanes) = (&self.world.materials, self.backend.lanes());
        for (pairs, mode) in [(&mut *pairs, TransportMode::Radiance), (&mut *others, TransportMode::Importance)] {
            pairs.evaluate(materials, mode, true, lanes, &mut self.scratch, self.stats.at(depth));
        }
        let begun = Instant::now();
        for (pair, Connection { hit, vertex, wi, distance }) in connections.into_iter().enumerate() {
            let other = order[pair] as usize;
            let state = &self.arrived[hit];
            let place = self.hits.place(hit);
            let squared = distance * distance;
            let light = Meeting {
                mis: &vertex.mis,
                density: pairs.forward[pair] * vertex.place.cos(wi) / squared,
                reverse: others.reverse[other],
            };
            let camera = Meeting {
                mis: &walks[state.slot as usize].mis,
                density: others.forward[other] * dot(place.geometric, wi).abs() / squared,
                reverse: pairs.reverse[pair],
            };
            let share = Mis::connect(light, camera, pass.factors);
            let local = [vertex.wo, others.wi[other]];
            let correction = vertex.place.adjoint_correction(local, [vertex.place.world(vertex.wo), neg(wi)]);
            let sent = T::scale(others.f[other], share * correction / squared);
            let radiance = T::radiance(T::apply(T::apply(state.throughput, pairs.f[pair]), sent), vertex.flux);
            // NaN must continue, to be counted.
            if radiance.as_ref().iter().fold(false, |some, x| some | (*x != 0.0)) {
                let (from, to) = (place.shadow_origin(wi), vertex.place.shadow_origin(neg(wi)));
                let way = sub(to, from);
                let reach = length(way);
                if reach > 0.0 {
                    let ray = Ray { origin: from, direction: scale(way, 1.0 / reach) };
                    // The slot takes the place of the position in the picture.
                    let raster = [f32::from_bits(state.slot), 0.0];
                    between.push(ray, 0.9999 * reach, SplatAt { raster, radiance });
                }
            }
        }
        self.stats.lights += begun.elapsed();
        self.resolve_between(RayClass::ScatteredShadow, |wave, SplatAt { raster, radiance }| {
            add(&mut wave.slots[raster[0].to_bits() as usize].sample.radiance, &radiance);
        });
    }
}
