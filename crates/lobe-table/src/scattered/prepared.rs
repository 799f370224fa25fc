//! Scattered samples, evaluated in `f64`, pair by pair.

use lobe_backend::Backend;

use super::Data;
use crate::bsdf::{Bsdf, pair_by_pair};
use crate::{Aspect, Channels, Directions, Scatter, Side};

impl Bsdf for Data {
    fn channels(&self) -> &Channels {
        Data::channels(self)
    }

    /// Values of transmission take light from either side.
    fn holds(&self, aspect: Aspect) -> bool {
        self.scatter == aspect.scatter && (aspect.light == Side::Front || aspect.scatter == Scatter::Transmission)
    }

    fn is_isotropic(&self) -> bool {
        Data::is_isotropic(self)
    }

    fn bytes(&self) -> usize {
        Data::samples(self).map(|(angles, values)| size_of_val(&angles) + size_of_val(values)).sum()
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        let channels = Data::channels(self);
        let mut sum = vec![0.0; channels.count()];
        pair_by_pair(channels, wi, wo, out, |wi, wo, texel| self.eval_into(wi, wo, &mut sum, texel));
    }
}
