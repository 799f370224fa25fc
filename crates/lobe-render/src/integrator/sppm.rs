//! Progressive photon mapping.

use lobe_trace::RayClass;

use super::light::ROULETTE;
use super::{Gathering, LightStages, Plan, read_depth_and_paths, read_gathering};
use crate::connect::{Pass, Unpolarised};
use crate::photon::LightMap;
use crate::scene::node::{Node, SceneError};
use crate::transport::TransportMode;
use crate::wavefront::{DeltaChoice, Keep, LightChoice, Merging, NextEvent, Scatter, Wavefront};

/// Gathers photons at the first surface that is not a mirror or glass, in passes whose radius shrinks (Hachisuka and
/// Jensen 2009; Knaus and Zwicker 2011). Direct light is sampled. Gathered light is blurred, less with each pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sppm {
    /// The largest number of surfaces of a path.
    pub depth: u32,
    /// Number of light paths per pass; if it is `None`, as many as there are pixels, up to 2^20.
    pub paths: Option<u32>,
    /// Radius within which photons are gathered in the first pass; if it is `None`, the size of two pixels at the
    /// target of the camera.
    pub radius: Option<f32>,
    /// How the radius shrinks from pass to pass, from 0.1 (fast) to 1 (not at all).
    pub shrink: f32,
}

impl Default for Sppm {
    fn default() -> Self {
        Sppm { depth: 8, paths: None, radius: None, shrink: 0.7 }
    }
}

impl Sppm {
    /// Light that has met only one surface is sampled as direct light.
    fn gathering(&self) -> Gathering {
        Gathering { radius: self.radius, shrink: self.shrink, least: 2 }
    }
}

impl LightStages for Sppm {
    const NAME: &'static str = "sppm";
    const SUMMARY: &'static str =
        "Photon maps: caustics also in mirrors and through glass; blurred a little, less with each pass";

    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError> {
        let default = Sppm::default();
        let (depth, paths) = read_depth_and_paths(table, default.depth)?;
        let Gathering { radius, shrink, .. } = read_gathering(table, default.gathering())?;
        Ok(Sppm { depth, paths, radius, shrink })
    }

    fn plan(&self) -> Plan {
        let gathering = Some(self.gathering());
        Plan { depth: self.depth, paths: self.paths, splats: false, keeps: true, gathering }
    }

    fn follow_light<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, _: &Pass) {
        for depth in 0..self.depth {
            if wave.rays.is_empty() {
                break;
            }
            wave.intersect(RayClass::Diffuse, Keep::All);
            if depth == 0 {
                wave.count_landed();
            } else {
                wave.keep_vertices(depth);
            }
            if depth + 1 < self.depth {
                let (mode, delta) = (TransportMode::Importance, DeltaChoice::One);
                wave.scatter(Scatter { depth, mode, delta, roulette: Some(ROULETTE) });
            }
        }
    }

    fn follow_camera<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, pass: &Pass, map: &LightMap<T>) {
        let (mut class, limit) = (RayClass::Camera, f32::INFINITY);
        for depth in 0..=self.depth {
            if wave.rays.is_empty() {
                break;
            }
            let last = depth == self.depth;
            wave.intersect(class, if last { Keep::Emitters } else { Keep::All });
            if depth == 0 {
                wave.record_first_hits();
            }
            wave.escape(limit);
            wave.emit(limit);
            if last {
                break;
            }
            wave.next_event(NextEvent { class, depth, lights: LightChoice::One, weighted: true, limit });
            wave.merge_photons(depth, pass, map, Merging::Alone);
            let (mode, delta) = (TransportMode::Radiance, DeltaChoice::One);
            wave.scatter(Scatter { depth, mode, delta, roulette: Some(ROULETTE) });
            // Scattered rays only look for lights; photons have brought the rest.
            let scattered = wave.part_mirrored();
            let mirrored = std::mem::replace(&mut wave.rays, scattered);
            if !wave.rays.is_empty() {
                wave.intersect(RayClass::Diffuse, Keep::Emitters);
                wave.escape(limit);
                wave.emit(limit);
            }
            wave.rays = mirrored;
            class = RayClass::Mirror;
        }
    }
}
