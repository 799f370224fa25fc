//! The EPFL database, in SIMD lanes.

use lobe_table::rgl::{Drawn, RglTable, UniformOrder, Wanted};
use lobe_table::{Channels, Scatter};

use super::evaluator::{Evaluator, Native};
use crate::{Backend, Kind, Sample};

/// Values are indexed by the light, as they were measured; samples, which are drawn for a viewer, by the viewer.
#[derive(Debug)]
pub(super) struct Parametrised {
    pub(super) table: RglTable,
}

impl Evaluator for Parametrised {
    fn kind(&self) -> Kind {
        Kind::Rgl
    }

    fn channels(&self) -> &Channels {
        self.table.channels()
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    fn is_isotropic(&self) -> bool {
        self.table.is_isotropic()
    }

    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        front && scatter == Scatter::Reflection
    }

    fn native(&self) -> Native<'_> {
        Native::Rgl(&self.table)
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        backend.run(self.table.batch(wi, wo, Wanted::Values(out)));
    }

    fn pdf(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3]) -> Option<f32> {
        let mut pdf = [0.0];
        backend.run(self.table.batch([wo].as_slice(), [wi].as_slice(), Wanted::Pdf(&mut pdf)));
        Some(pdf[0])
    }

    fn sample(&self, backend: Backend, wo: [f32; 3], uniform: [f32; 2]) -> Option<Sample> {
        let (mut wi, mut pdf, mut weights) = ([[0.0; 3]], [0.0], vec![0.0; self.table.channel_count()]);
        let drawn = Drawn { wo: &mut wi, pdf: &mut pdf, weights: &mut weights };
        backend.run(self.table.sampling([wo].as_slice(), &[uniform], UniformOrder::default(), drawn));
        Some(Sample { wi: wi[0], pdf: pdf[0] })
    }
}
