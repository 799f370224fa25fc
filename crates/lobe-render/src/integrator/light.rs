//! Light tracing.

use lobe_trace::RayClass;

use super::{LightStages, Plan, read_depth_and_paths};
use crate::connect::{Pass, Unpolarised};
use crate::photon::LightMap;
use crate::scene::node::{Node, SceneError};
use crate::transport::TransportMode;
use crate::wavefront::{DeltaChoice, Keep, Scatter, Wavefront};

/// Paths from the lights, connected to the camera from every surface (Dutre and Willems 1994; Arvo 1986, "Backward Ray
/// Tracing"). No light path reaches the camera by way of a mirror or glass, so these show only the lights themselves,
/// found by paths from the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightTracing {
    /// The largest number of surfaces that a path may hit.
    pub depth: u32,
    /// Number of light paths per sample of all pixels; if it is `None`, as many as there are pixels, up to 2^20.
    pub paths: Option<u32>,
}

impl Default for LightTracing {
    fn default() -> Self {
        LightTracing { depth: 8, paths: None }
    }
}

/// From this depth on, paths end by Russian roulette.
pub(super) const ROULETTE: u32 = 3;

impl LightStages for LightTracing {
    const NAME: &'static str = "light";
    const SUMMARY: &'static str =
        "Paths from the lights: caustics without noise, but nothing visible in mirrors or through glass";

    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError> {
        let (depth, paths) = read_depth_and_paths(table, LightTracing::default().depth)?;
        Ok(LightTracing { depth, paths })
    }

    fn plan(&self) -> Plan {
        Plan { depth: self.depth, paths: self.paths, splats: true, keeps: false, gathering: None }
    }

    fn follow_light<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, pass: &Pass) {
        for depth in 0..self.depth {
            if wave.rays.is_empty() {
                break;
            }
            wave.intersect(RayClass::Diffuse, Keep::All);
            if depth == 0 {
                wave.count_landed();
            }
            wave.connect_to_camera(depth, pass, false);
            if depth + 1 < self.depth {
                let (mode, delta) = (TransportMode::Importance, DeltaChoice::One);
                wave.scatter(Scatter { depth, mode, delta, roulette: Some(ROULETTE) });
            }
        }
    }

    fn follow_camera<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, _: &Pass, _: &LightMap<T>) {
        let mut class = RayClass::Camera;
        for depth in 0..=self.depth {
            if wave.rays.is_empty() {
                break;
            }
            let last = depth == self.depth;
            wave.intersect(class, if last { Keep::Emitters } else { Keep::All });
            if depth == 0 {
                wave.record_first_hits();
            }
            wave.escape(f32::INFINITY);
            wave.emit(f32::INFINITY);
            if last {
                break;
            }
            let (mode, delta) = (TransportMode::Radiance, DeltaChoice::One);
            wave.scatter(Scatter { depth, mode, delta, roulette: Some(ROULETTE) });
            wave.part_mirrored();
            class = RayClass::Mirror;
        }
    }
}
