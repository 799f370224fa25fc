//! Spherical coordinates: on a grid in SIMD lanes, scattered in `f64`.

use lobe_table::{Channels, Scatter, scattered, spherical};

use super::evaluator::{Evaluator, pair_by_pair};
use crate::{Backend, Kind};

impl Evaluator for spherical::Table {
    fn kind(&self) -> Kind {
        Kind::Spherical
    }

    fn channels(&self) -> &Channels {
        spherical::Table::channels(self)
    }

    fn bytes(&self) -> usize {
        spherical::Table::bytes(self)
    }

    fn is_isotropic(&self) -> bool {
        spherical::Table::is_isotropic(self)
    }

    /// Values of transmission take light from either side.
    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        self.scatter() == scatter && (front || scatter == Scatter::Transmission)
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        spherical::Table::eval_batch(self, backend, wi.into(), wo.into(), out);
    }
}

impl Evaluator for scattered::Data {
    fn kind(&self) -> Kind {
        Kind::Scattered
    }

    fn channels(&self) -> &Channels {
        scattered::Data::channels(self)
    }

    fn bytes(&self) -> usize {
        self.samples().map(|(angles, values)| size_of_val(&angles) + size_of_val(values)).sum()
    }

    fn is_isotropic(&self) -> bool {
        scattered::Data::is_isotropic(self)
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
