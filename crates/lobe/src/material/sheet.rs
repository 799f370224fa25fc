//! Several measurements of one sheet: the sides of the two directions choose which of them answers.

use lobe_table::{Channels, Scatter, Side};

use super::evaluator::Evaluator;
use crate::{Backend, Kind};

/// A measurement, and for which directions it holds.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) scatter: Scatter,
    /// `None` holds for both sides.
    pub(super) side: Option<Side>,
    pub(super) evaluator: Box<dyn Evaluator>,
}

impl Part {
    fn answers(&self, wi: [f32; 3], wo: [f32; 3]) -> bool {
        let opposite = match self.scatter {
            Scatter::Reflection => 1.0,
            Scatter::Transmission => -1.0,
        };
        let is_on_side = match self.side {
            None => true,
            Some(Side::Front) => wi[2] > 0.0,
            Some(Side::Back) => wi[2] < 0.0,
        };
        // Signs, as a product of small numbers may vanish.
        is_on_side && (wi[2] > 0.0 && opposite * wo[2] > 0.0 || wi[2] < 0.0 && opposite * wo[2] < 0.0)
    }
}

/// The same direction where the other side is up.
pub(crate) fn flipped([x, y, z]: [f32; 3]) -> [f32; 3] {
    [x, y, -z]
}

/// At least one part; all have the same channels.
#[derive(Debug)]
pub(super) struct Sheet {
    pub(super) channels: Channels,
    pub(super) parts: Vec<Part>,
}

impl Sheet {
    /// Whether a part was measured with light from that side.
    fn measures(&self, front: bool, scatter: Scatter) -> bool {
        let side = if front { Side::Front } else { Side::Back };
        self.parts.iter().any(|part| part.scatter == scatter && part.side.is_none_or(|of| of == side))
    }
}

impl Evaluator for Sheet {
    fn kind(&self) -> Kind {
        Kind::Sheet
    }

    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn bytes(&self) -> usize {
        self.parts.iter().map(|part| part.evaluator.bytes()).sum()
    }

    fn is_isotropic(&self) -> bool {
        self.parts.iter().all(|part| part.evaluator.is_isotropic())
    }

    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        self.measures(front, scatter) || (scatter == Scatter::Transmission && self.measures(!front, scatter))
    }

    /// Transmission that was measured in one direction only is the same in the other one (Helmholtz reciprocity).
    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        let channels = self.channels.count();
        out.fill(0.0);
        let through = [true, false].map(|front| self.measures(front, Scatter::Transmission));
        for part in &self.parts {
            let (mut queries, mut lights, mut viewers) = (Vec::new(), Vec::new(), Vec::new());
            for query in 0..wi.len() {
                let (mut light, mut viewer) = (wi[query], wo[query]);
                if part.scatter == Scatter::Transmission && !through[usize::from(light[2] < 0.0)] {
                    (light, viewer) = (viewer, light);
                }
                if part.answers(light, viewer) {
                    // What was measured from behind was measured with that side up.
                    if light[2] < 0.0 {
                        (light, viewer) = (flipped(light), flipped(viewer));
                    }
                    queries.push(query);
                    lights.push(light);
                    viewers.push(viewer);
                }
            }
            let mut values = vec![0.0; queries.len() * channels];
            part.evaluator.eval_batch(backend, &lights, &viewers, &mut values);
            for (&query, value) in queries.iter().zip(values.chunks_exact(channels)) {
                out[query * channels..][..channels].copy_from_slice(value);
            }
        }
    }
}
