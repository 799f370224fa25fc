//! Path tracing with multiple importance sampling.

use lobe_trace::RayClass;

use super::Stages;
use crate::scene::node::{Node, SceneError};
use crate::transport::{Transport, TransportMode};
use crate::wavefront::{DeltaChoice, Keep, LightChoice, NextEvent, Scatter, Wavefront};

/// Follows light over many surfaces, without bias: lights and materials are sampled together (multiple importance
/// sampling), and paths that carry little light end by chance (Russian roulette).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// The largest number of surfaces that a path may hit.
    pub depth: u32,
    /// The most that one sample may add after the first surface, per channel; infinite for no limit. A limit removes
    /// bright dots, and a little light with them.
    pub limit: f32,
}

impl Default for Path {
    fn default() -> Self {
        Path { depth: 8, limit: f32::INFINITY }
    }
}

/// From this depth on, paths end by Russian roulette.
const ROULETTE: u32 = 3;

impl Path {
    /// The most that light may add that reaches the viewer over this many surfaces.
    fn limit(&self, surfaces: u32) -> f32 {
        if surfaces > 1 { self.limit } else { f32::INFINITY }
    }
}

impl Stages for Path {
    const NAME: &'static str = "path";
    const SUMMARY: &'static str = "Light over many surfaces; unbiased";

    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError> {
        let default = Path::default();
        Ok(Path {
            depth: table.whole("depth", 1..=1000)?.unwrap_or(default.depth),
            limit: table.positive("limit")?.unwrap_or(default.limit),
        })
    }

    fn follow<T: Transport>(&self, wave: &mut Wavefront<'_, T>) {
        let mut class = RayClass::Camera;
        for depth in 0..=self.depth {
            if wave.rays.is_empty() {
                break;
            }
            // The last rays only look for lights.
            let last = depth == self.depth;
            wave.intersect(class, if last { Keep::Emitters } else { Keep::All });
            if depth == 0 {
                wave.record_first_hits();
            }
            wave.escape(self.limit(depth));
            wave.emit(self.limit(depth));
            if last {
                break;
            }
            let limit = self.limit(depth + 1);
            wave.next_event(NextEvent { class, depth, lights: LightChoice::One, weighted: true, limit });
            let (mode, delta) = (TransportMode::Radiance, DeltaChoice::One);
            let specular = wave.scatter(Scatter { depth, mode, delta, roulette: Some(ROULETTE) });
            class = class.bounce(specular);
        }
    }
}
