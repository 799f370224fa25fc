//! Ambient occlusion.

use lobe_lane::{Lanes, MAX_LANES};
use lobe_scalar::Reference;
use lobe_trace::RayClass;

use super::Stages;
use crate::columns::RAYS;
use crate::random::Dimensions;
use crate::scene::node::{Node, SceneError};
use crate::transport::Transport;
use crate::vec3::Vec3;
use crate::vectors::cosine_hemisphere;
use crate::wavefront::{Keep, Origin, ShadowRay, Wavefront, spawn_rays};

/// Shows the share of directions, weighted with the cosine, in which there is no surface within a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientOcclusion {
    /// The distance; may be infinite.
    pub distance: f32,
}

impl Default for AmbientOcclusion {
    fn default() -> Self {
        AmbientOcclusion { distance: f32::INFINITY }
    }
}

impl Stages for AmbientOcclusion {
    const NAME: &'static str = "ao";
    const SUMMARY: &'static str = "Ambient occlusion: the share of directions that hit no surface";

    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError> {
        let default = AmbientOcclusion::default();
        Ok(AmbientOcclusion { distance: table.positive("distance")?.unwrap_or(default.distance) })
    }

    fn follow<T: Transport>(&self, wave: &mut Wavefront<'_, T>) {
        if wave.rays.is_empty() {
            return;
        }
        wave.intersect(RayClass::Camera, Keep::All);
        wave.record_first_hits();
        wave.sample_numbers(Dimensions::Scatter(0));
        let lanes = Reference::default();
        let mut local: Vec<Vec3> = Vec::with_capacity(wave.hits.len().next_multiple_of(MAX_LANES));
        for (hit, wo) in wave.hits.wo().iter().enumerate() {
            let [u, v, ..] = wave.numbers.of(hit);
            let [x, y, z] = lanes.extract_xyz(cosine_hemisphere(lanes, [lanes.splat(u), lanes.splat(v)]), 0);
            local.push([x, y, if wo[2] < 0.0 { -z } else { z }]);
        }
        local.resize(local.len().next_multiple_of(MAX_LANES), [0.0; 3]);
        let mut spawned = Vec::new();
        spawn_rays(wave.backend, &wave.hits, Origin::Lifted, &local, &mut spawned);
        let queue = &mut wave.shadow.queue;
        queue.clear();
        queue.extend(wave.arrived.len(), |out| {
            for (hit, arrived) in wave.arrived.iter().enumerate() {
                let (spawned, at) = (&spawned[hit / RAYS], hit % RAYS);
                let open = ShadowRay { slot: arrived.slot, radiance: T::from_colour(&wave.world.basis, [1.0; 3]) };
                out.write(spawned.ray(at), self.distance, open, spawned.goes(at));
            }
        });
        wave.resolve_shadow_rays(RayClass::Camera.shadow(false));
    }
}
