//! Specular tables, in SIMD lanes.

use lobe_table::{Channels, Scatter};

use super::evaluator::{Evaluator, Native};
use crate::{Backend, Brdf, Kind};

impl Evaluator for Brdf {
    fn kind(&self) -> Kind {
        Kind::Specular
    }

    fn channels(&self) -> &Channels {
        self.table().channels()
    }

    fn bytes(&self) -> usize {
        self.table().bytes()
    }

    fn is_isotropic(&self) -> bool {
        !self.table().is_anisotropic()
    }

    /// Tables of transmission take light from either side.
    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        self.table().scatter() == scatter && (front || scatter == Scatter::Transmission)
    }

    fn native(&self) -> Native<'_> {
        Native::Table(self)
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        Brdf::eval_batch(&self.clone().with_backend(backend), wi, wo, out);
    }
}
