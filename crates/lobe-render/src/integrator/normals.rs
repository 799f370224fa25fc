//! Shading normals.

use lobe_trace::RayClass;

use super::Stages;
use crate::scene::node::{Node, SceneError};
use crate::transport::Transport;
use crate::wavefront::{Keep, Wavefront};

/// Shows the shading normals as colours, `(n + 1) / 2`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Normals;

impl Stages for Normals {
    const NAME: &'static str = "normals";
    const SUMMARY: &'static str = "Shading normals as colours";

    fn read(_: &Node<'_, '_>) -> Result<Self, SceneError> {
        Ok(Normals)
    }

    fn follow<T: Transport>(&self, wave: &mut Wavefront<'_, T>) {
        if wave.rays.is_empty() {
            return;
        }
        wave.intersect(RayClass::Camera, Keep::All);
        wave.record_first_hits();
        for (hit, arrived) in wave.arrived.iter().enumerate() {
            let colour = wave.hits.normal(hit).map(|n| 0.5 + 0.5 * n);
            wave.slots[arrived.slot as usize].sample.radiance = T::from_colour(&wave.world.basis, colour);
        }
    }
}
