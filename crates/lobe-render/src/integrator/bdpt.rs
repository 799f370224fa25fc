//! Bidirectional path tracing.

use super::{LightStages, Plan, read_depth_and_paths, vcm};
use crate::connect::{Pass, Unpolarised};
use crate::photon::LightMap;
use crate::scene::node::{Node, SceneError};
use crate::wavefront::Wavefront;

/// Paths from the camera and from the lights, connected in all ways, each weighted by its density among all (Veach and
/// Guibas 1995; Lafortune and Willems 1993). Unbiased.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bdpt {
    /// The largest number of surfaces of a path.
    pub depth: u32,
    /// Number of light paths per sample of all pixels; if it is `None`, as many as there are pixels, up to 2^20.
    pub paths: Option<u32>,
}

impl Default for Bdpt {
    fn default() -> Self {
        Bdpt { depth: 8, paths: None }
    }
}

impl LightStages for Bdpt {
    const NAME: &'static str = "bdpt";
    const SUMMARY: &'static str = "Paths from camera and lights, connected: rooms lit indirectly, caustics; unbiased";

    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError> {
        let (depth, paths) = read_depth_and_paths(table, Bdpt::default().depth)?;
        Ok(Bdpt { depth, paths })
    }

    fn plan(&self) -> Plan {
        Plan { depth: self.depth, paths: self.paths, splats: true, keeps: true, gathering: None }
    }

    fn follow_light<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, pass: &Pass) {
        vcm::follow_light(wave, pass);
    }

    fn follow_camera<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, pass: &Pass, map: &LightMap<T>) {
        vcm::follow_camera(wave, pass, map);
    }
}
