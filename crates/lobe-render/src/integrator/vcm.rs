//! Vertex connection and merging.

use lobe_trace::RayClass;

use super::light::ROULETTE;
use super::{Gathering, LightStages, Plan, read_depth_and_paths, read_gathering};
use crate::connect::{Pass, Unpolarised};
use crate::photon::LightMap;
use crate::scene::node::{Node, SceneError};
use crate::transport::TransportMode;
use crate::wavefront::{DeltaChoice, Keep, Merging, Scatter, Wavefront};

/// Bidirectional path tracing and photon mapping as one method, each technique weighted by its density (Georgiev,
/// Krivanek, Davidovic and Slusallek 2012). Caustics seen in a mirror are found only by merging, which blurs them a
/// little, less with each pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vcm {
    /// The largest number of surfaces of a path.
    pub depth: u32,
    /// Number of light paths per sample of all pixels; if it is `None`, as many as there are pixels, up to 2^20.
    pub paths: Option<u32>,
    /// Radius within which paths are merged in the first pass; if it is `None`, the size of two pixels at the target of
    /// the camera.
    pub radius: Option<f32>,
    /// How the radius shrinks from pass to pass, from 0.1 (fast) to 1 (not at all).
    pub shrink: f32,
}

impl Default for Vcm {
    fn default() -> Self {
        Vcm { depth: 8, paths: None, radius: None, shrink: 0.75 }
    }
}

impl Vcm {
    fn gathering(&self) -> Gathering {
        Gathering { radius: self.radius, shrink: self.shrink, least: 1 }
    }
}

impl LightStages for Vcm {
    const NAME: &'static str = "vcm";
    const SUMMARY: &'static str = "bdpt and sppm together: all light, also caustics seen in mirrors";

    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError> {
        let default = Vcm::default();
        let (depth, paths) = read_depth_and_paths(table, default.depth)?;
        let Gathering { radius, shrink, .. } = read_gathering(table, default.gathering())?;
        Ok(Vcm { depth, paths, radius, shrink })
    }

    fn plan(&self) -> Plan {
        let gathering = Some(self.gathering());
        Plan { depth: self.depth, paths: self.paths, splats: true, keeps: true, gathering }
    }

    fn follow_light<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, pass: &Pass) {
        follow_light(wave, pass);
    }

    fn follow_camera<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, pass: &Pass, map: &LightMap<T>) {
        follow_camera(wave, pass, map);
    }
}

/// Light paths are kept, and the camera sees them.
pub(super) fn follow_light<T: Unpolarised>(wave: &mut Wavefront<'_, T>, pass: &Pass) {
    for depth in 0..pass.depth {
        if wave.rays.is_empty() {
            break;
        }
        wave.intersect(RayClass::Diffuse, Keep::All);
        if depth == 0 {
            wave.count_landed();
        }
        wave.arrive();
        wave.keep_vertices(depth);
        wave.connect_to_camera(depth, pass, true);
        if depth + 1 < pass.depth {
            let (mode, delta) = (TransportMode::Importance, DeltaChoice::One);
            wave.scatter_on(Scatter { depth, mode, delta, roulette: Some(ROULETTE) }, pass.factors);
        }
    }
}

/// Camera paths find lights, sample lights, are connected with light paths, and gather photons if there are any.
pub(super) fn follow_camera<T: Unpolarised>(wave: &mut Wavefront<'_, T>, pass: &Pass, map: &LightMap<T>) {
    let mut class = RayClass::Camera;
    for depth in 0..=pass.depth {
        if wave.rays.is_empty() {
            break;
        }
        // The last rays only look for lights.
        let last = depth == pass.depth;
        wave.intersect(class, if last { Keep::Emitters } else { Keep::All });
        if depth == 0 {
            wave.record_first_hits();
        }
        wave.arrive();
        wave.escape_weighted(depth);
        wave.emit_weighted(depth);
        if last {
            break;
        }
        wave.sample_lights_weighted(depth, class, pass);
        wave.connect_to_vertices(depth, pass, map);
        wave.merge_photons(depth, pass, map, Merging::Weighted);
        let (mode, delta) = (TransportMode::Radiance, DeltaChoice::One);
        wave.scatter_on(Scatter { depth, mode, delta, roulette: Some(ROULETTE) }, pass.factors);
        class = RayClass::Diffuse;
    }
}
