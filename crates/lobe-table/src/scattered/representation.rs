//! What programs need from scattered samples.

use std::borrow::Cow;

use super::Data;
use crate::bsdf::Bsdf;
use crate::data::{Options, PrepareError, Section};
use crate::{Aspect, Channels, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("scattered samples");

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        self.channels.clone()
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::front(self.scatter)]
    }

    fn is_isotropic(&self) -> bool {
        Data::is_isotropic(self)
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let values: Vec<f32> = self.samples().flat_map(|(_, texel)| texel.to_vec()).collect();
        let section = Section::new(KIND, Aspect::front(self.scatter), self.channels.clone(), &[]);
        let mut thetas: Vec<f32> = Data::incidences(self).map(|[theta, _]| theta.to_degrees() as f32).collect();
        thetas.dedup();
        let thetas: Vec<String> = thetas.iter().map(f32::to_string).collect();
        let symmetry = if self.is_isotropic { "isotropic" } else { "anisotropic" };
        let incidences = match self.incidences.len() {
            1 => "1 direction".into(),
            n => format!("{n} directions"),
        };
        let section = Section { bytes: size_of_val(values.as_slice()), values: Cow::Owned(values), ..section };
        let section =
            section.with_fact("samples", format!("{} pairs of directions, {symmetry}", self.samples().count()));
        vec![section.with_fact("light", format!("{incidences}, at {} degrees", thetas.join(" ")))]
    }

    fn incidences(&self, _: Aspect) -> Vec<[f64; 2]> {
        Data::incidences(self).collect()
    }

    fn prepare(&self, _: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        Ok(Box::new(self.clone()))
    }
}
