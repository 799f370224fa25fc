//! Several measurements of one sheet: the sides of the two directions choose which of them answers.

use lobe_formats::sheet::Side;
use lobe_table::{Channels, Scatter};

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

/// At least one part; all have the same channels.
#[derive(Debug)]
pub(super) struct Sheet {
    pub(super) channels: Channels,
    pub(super) parts: Vec<Part>,
}

impl Evaluator for Sheet {
    fn kind(&self) -> Kind {
        Kind::Sheet
    }

    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn set_backend(&mut self, backend: Backend) {
        self.parts.iter_mut().for_each(|part| part.evaluator.set_backend(backend));
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        let channels = self.channels.count();
        out.fill(0.0);
        for part in &self.parts {
            let queries: Vec<usize> = (0..wi.len()).filter(|&query| part.answers(wi[query], wo[query])).collect();
            let pick = |from: &[[f32; 3]]| queries.iter().map(|&query| from[query]).collect::<Vec<_>>();
            let mut values = vec![0.0; queries.len() * channels];
            part.evaluator.eval_batch(&pick(wi), &pick(wo), &mut values);
            for (&query, value) in queries.iter().zip(values.chunks_exact(channels)) {
                out[query * channels..][..channels].copy_from_slice(value);
            }
        }
    }
}
