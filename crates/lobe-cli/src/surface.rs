//! A material from a file, as a surface to be measured again.

use lobe::{Channels, Material, Scatter};
use lobe_model::Surface;

/// A material and the sides on which it has values.
pub struct MaterialSurface {
    /// The material.
    pub material: Material,
    /// The only kind of scatter that it holds; `None` if it distinguishes the sides itself.
    pub scatter: Option<Scatter>,
}

impl Surface for MaterialSurface {
    fn channels(&self) -> &Channels {
        self.material.channels()
    }

    fn f(&self, wi: [f64; 3], viewers: &[[f64; 3]], out: &mut [f64]) {
        let narrow = |direction: [f64; 3]| direction.map(|c| c as f32);
        let wo: Vec<_> = viewers.iter().copied().map(narrow).collect();
        let mut values = vec![0.0; out.len()];
        self.material.eval_batch(&vec![narrow(wi); wo.len()], &wo, &mut values);
        let channels = self.material.channel_count();
        for ((texel, values), wo) in out.chunks_exact_mut(channels).zip(values.chunks_exact(channels)).zip(viewers) {
            let passes = (wi[2] > 0.0) != (wo[2] > 0.0);
            let is_held = match self.scatter {
                None => true,
                Some(Scatter::Reflection) => !passes && wi[2] > 0.0,
                Some(Scatter::Transmission) => passes && wi[2] > 0.0,
            };
            texel.iter_mut().zip(values).for_each(|(out, f)| *out = if is_held { f64::from(*f) } else { 0.0 });
        }
    }
}
