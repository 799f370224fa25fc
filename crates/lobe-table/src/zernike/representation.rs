//! [`Representation`] for expansions.

use std::borrow::Cow;
use std::f64::consts::PI;

use super::data::Data;
use crate::bsdf::Bsdf;
use crate::data::{Options, PrepareError, Section};
use crate::{Aspect, Channels, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("Zernike expansion");

/// Polar angles per quarter turn, and azimuths per half turn, at which values are listed.
const STEPS: usize = 18;

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        Data::channels(self).clone()
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::REFLECTION]
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    /// The values every 5 degrees of the polar angles, and every 10 of the azimuth between them.
    fn sections(&self) -> Vec<Section<'_>> {
        let polar: Vec<f64> = (0..STEPS).map(|step| PI / 2.0 * step as f64 / STEPS as f64).collect();
        let azimuths: Vec<f64> = (0..=STEPS).map(|step| PI * step as f64 / STEPS as f64).collect();
        let values = self.on_grid(&polar, &azimuths);
        let section = Section::new(KIND, Aspect::REFLECTION, Data::channels(self).clone(), &[]);
        let section = Section {
            quantity: "f in 1/sr, every 5 degrees",
            values: Cow::Owned(values.into_iter().map(|value| value as f32).collect()),
            bytes: size_of_val(self.terms()),
            ..section
        };
        vec![section.with_fact("terms", format!("{} of radial orders up to {}", self.terms().len(), self.order()))]
    }

    #[cfg(feature = "zernike")]
    fn prepare(&self, _: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self)
    }
}
