//! Direct light, mirrors and glass.

use lobe_trace::RayClass;

use super::Stages;
use crate::scene::node::{Node, SceneError};
use crate::transport::{Transport, TransportMode};
use crate::wavefront::{DeltaChoice, Keep, LightChoice, NextEvent, Scatter, Wavefront};

/// Direct light with shadows, and all mirrored and refracted rays: Whitted 1980, "An Improved Illumination Model for
/// Shaded Display".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitted {
    /// The largest number of surfaces that a ray may hit.
    pub depth: u32,
}

impl Default for Whitted {
    fn default() -> Self {
        Whitted { depth: 8 }
    }
}

/// A ray that carries less than this is not followed.
const NEGLIGIBLE: f32 = 1e-3;

impl Stages for Whitted {
    const NAME: &'static str = "whitted";
    const SUMMARY: &'static str = "Direct light, and all mirrored and refracted rays";

    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError> {
        Ok(Whitted { depth: table.whole("depth", 1..=32)?.unwrap_or(Whitted::default().depth) })
    }

    fn follow<T: Transport>(&self, wave: &mut Wavefront<'_, T>) {
        let mut class = RayClass::Camera;
        let limit = f32::INFINITY;
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
            wave.escape(limit);
            wave.emit(limit);
            if last {
                break;
            }
            wave.next_event(NextEvent { class, depth, lights: LightChoice::Each, weighted: false, limit });
            let (mode, delta) = (TransportMode::Radiance, DeltaChoice::Branch(NEGLIGIBLE));
            let specular = wave.scatter(Scatter { depth, mode, delta, roulette: None });
            class = class.bounce(specular);
        }
    }
}
