//! Grids of half and difference angles, by their `f64` reference.

use lobe_table::half_diff::HalfDiff;
use lobe_table::{Channels, Scatter};

use super::evaluator::{Evaluator, pair_by_pair, round};
use crate::{Kind, Lookup};

#[derive(Debug)]
pub(super) struct HalfDifference {
    pub(super) data: HalfDiff,
    pub(super) lookup: Lookup,
}

impl Evaluator for HalfDifference {
    fn kind(&self) -> Kind {
        Kind::HalfDifference
    }

    fn channels(&self) -> &Channels {
        &Channels::Rgb
    }

    fn bytes(&self) -> usize {
        size_of_val(self.data.values())
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        front && scatter == Scatter::Reflection
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        pair_by_pair(wi, wo, out, |wi, wo, texel| {
            let value = match self.lookup {
                Lookup::Nearest => self.data.eval_nearest(wi, wo),
                Lookup::Linear => self.data.eval_linear(wi, wo),
            };
            round(texel, &value);
        });
    }
}
