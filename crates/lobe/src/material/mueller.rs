//! Mueller matrices, by their `f64` reference. The value of a pair of directions is that of unpolarised light.

use lobe_table::mueller::{Matrix, Mueller};
use lobe_table::{Channels, Scatter};

use super::evaluator::{Evaluator, pair_by_pair, unit};
use crate::Kind;

#[derive(Debug)]
pub(super) struct Polarised {
    data: Mueller,
    channels: Channels,
}

impl Polarised {
    pub(super) fn new(data: Mueller) -> Self {
        let channels = Channels::Spectral(data.knots()[3].iter().map(|nm| f64::from(*nm)).collect());
        Polarised { data, channels }
    }
}

impl Evaluator for Polarised {
    fn kind(&self) -> Kind {
        Kind::Mueller
    }

    fn channels(&self) -> &Channels {
        &self.channels
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
        let wavelengths = &self.data.knots()[3];
        pair_by_pair(wi, wo, out, |wi, wo, texel| {
            for (out, nm) in texel.iter_mut().zip(wavelengths) {
                let matrix = self.data.in_plane(wi, wo, f64::from(*nm));
                *out = matrix.map_or(0.0, |matrix| matrix[0][0] as f32);
            }
        });
    }

    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        Some(unit(wi).zip(unit(wo)).map_or([[0.0; 4]; 4], |(wi, wo)| self.data.eval(wi, wo, nm)))
    }
}
