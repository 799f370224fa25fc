//! Spherical coordinates, on a grid or scattered, in `f64`.

use lobe_table::scattered::Scattered;
use lobe_table::spherical_grid::SphericalGrid;
use lobe_table::{Channels, Scatter};

use super::evaluator::{Evaluator, pair_by_pair};
use crate::{Backend, Kind};

impl Evaluator for SphericalGrid {
    fn kind(&self) -> Kind {
        Kind::SphericalGrid
    }

    fn channels(&self) -> &Channels {
        SphericalGrid::channels(self)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.values())
    }

    fn is_isotropic(&self) -> bool {
        SphericalGrid::is_isotropic(self)
    }

    /// Values of transmission take light from either side.
    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        self.scatter() == scatter && (front || scatter == Scatter::Transmission)
    }

    fn eval_batch(&self, _: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        let mut sum = vec![0.0; self.channels().count()];
        pair_by_pair(wi, wo, out, |wi, wo, texel| self.eval_into(wi, wo, &mut sum, texel));
    }
}

impl Evaluator for Scattered {
    fn kind(&self) -> Kind {
        Kind::Scattered
    }

    fn channels(&self) -> &Channels {
        Scattered::channels(self)
    }

    fn bytes(&self) -> usize {
        self.samples().map(|(angles, values)| size_of_val(&angles) + size_of_val(values)).sum()
    }

    fn is_isotropic(&self) -> bool {
        Scattered::is_isotropic(self)
    }

    /// Values of transmission take light from either side.
    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        self.scatter() == scatter && (front || scatter == Scatter::Transmission)
    }

    fn eval_batch(&self, _: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        let mut sum = vec![0.0; self.channels().count()];
        pair_by_pair(wi, wo, out, |wi, wo, texel| self.eval_into(wi, wo, &mut sum, texel));
    }
}
