//! Spherical coordinates, on a grid or scattered, by their `f64` references.

use lobe_table::Channels;
use lobe_table::scattered::Scattered;
use lobe_table::spherical_grid::SphericalGrid;

use super::evaluator::{Evaluator, pair_by_pair};
use crate::Kind;

impl Evaluator for SphericalGrid {
    fn kind(&self) -> Kind {
        Kind::SphericalGrid
    }

    fn channels(&self) -> &Channels {
        SphericalGrid::channels(self)
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        pair_by_pair(wi, wo, out, |wi, wo, texel| texel.copy_from_slice(&self.eval(wi, wo)));
    }
}

impl Evaluator for Scattered {
    fn kind(&self) -> Kind {
        Kind::Scattered
    }

    fn channels(&self) -> &Channels {
        Scattered::channels(self)
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        pair_by_pair(wi, wo, out, |wi, wo, texel| texel.copy_from_slice(&self.eval(wi, wo)));
    }
}
