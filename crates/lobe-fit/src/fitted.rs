//! A model with its parameters, as a material like any other.

use std::fmt;

use lobe::Backend;
use lobe_colour::Channels;
use lobe_model::Surface;
use lobe_ops::OnBackend;
use lobe_table::{Aspect, Bsdf, Directions};

use crate::geometry::Geometry;
use crate::model::Model;

/// A model with parameters: zero unless the pair of directions is on the sides of its aspect.
#[derive(Clone, PartialEq)]
pub struct Fitted {
    pub(crate) model: Model,
    pub(crate) aspect: Aspect,
    pub(crate) channels: Channels,
    pub(crate) wavelengths: Vec<f64>,
    /// All parameters of each channel, shape first.
    pub(crate) parameters: Vec<Vec<f64>>,
}

impl Fitted {
    /// A model with all of its parameters for each channel, in the order of [`Model::parameters`]. `wavelength` in nm
    /// is for channels without one.
    ///
    /// # Panics
    /// If the number of lists is not the number of channels, or a list does not have one number per parameter.
    pub fn new(model: Model, channels: Channels, wavelength: Option<f64>, parameters: Vec<Vec<f64>>) -> Self {
        assert_eq!(parameters.len(), channels.count(), "parameters of each channel");
        assert!(parameters.iter().all(|list| list.len() == model.parameters().len()), "all parameters of the model");
        let wavelengths = crate::problem::wavelengths(&channels, wavelength);
        Fitted { model, aspect: Aspect::REFLECTION, channels, wavelengths, parameters }
    }

    /// The same for other sides of the surface.
    #[must_use]
    pub fn on(self, aspect: Aspect) -> Self {
        Fitted { aspect, ..self }
    }

    /// The values for a pair of directions, one per channel.
    pub fn f(&self, wi: [f64; 3], wo: [f64; 3], out: &mut [f64]) {
        let (placed_i, placed_o) = self.aspect.place([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
        let (up_i, up_o) = (wi[2] * placed_i[2], wo[2] * placed_o[2]);
        if !(up_i > 0.0 && up_o > 0.0) {
            out.fill(0.0);
            return;
        }
        let geometry = Geometry::new([wi[0], wi[1], up_i], [wo[0], wo[1], up_o]);
        for (channel, out) in out.iter_mut().enumerate() {
            *out = self.model.f(&geometry, self.wavelengths[channel], &self.parameters[channel]);
        }
    }
}

impl fmt::Debug for Fitted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {:?}", self.model.name(), self.parameters)
    }
}

impl Bsdf for Fitted {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn holds(&self, aspect: Aspect) -> bool {
        aspect == self.aspect
    }

    fn is_isotropic(&self) -> bool {
        self.model.is_isotropic()
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        let count = self.channels.count();
        assert_eq!(wi.count(), wo.count(), "as many wi as wo");
        assert_eq!(out.len(), count * wi.count(), "a value per channel and query");
        let mut texel = vec![0.0; count];
        for (query, out) in out.chunks_exact_mut(count).enumerate() {
            self.f(wi.get(query).map(f64::from), wo.get(query).map(f64::from), &mut texel);
            out.iter_mut().zip(&texel).for_each(|(out, value)| *out = *value as f32);
        }
    }
}

impl Surface for Fitted {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn f(&self, wi: [f64; 3], viewers: &[[f64; 3]], out: &mut [f64]) {
        for (texel, &wo) in out.chunks_exact_mut(self.channels.count()).zip(viewers) {
            Fitted::f(self, wi, wo, texel);
        }
    }
}

impl<'a> From<&'a Fitted> for OnBackend<'a> {
    fn from(fitted: &'a Fitted) -> Self {
        OnBackend::new(fitted, Backend::best())
    }
}
