//! [`Representation`] for Mueller matrices in specular coordinates.

use std::borrow::Cow;

use super::data::Data;
use crate::bsdf::Bsdf;
use crate::data::{Coverage, Kinks, Options, PrepareError, Section, Uses};
use crate::specular::AXIS_NAMES;
use crate::{Aspect, Channels, Edges, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("specular Mueller matrices");

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        self.first.channels().clone()
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::REFLECTION]
    }

    fn is_isotropic(&self) -> bool {
        self.first.is_isotropic()
    }

    fn uses(&self) -> Uses {
        Uses { edges: true, ..Uses::default() }
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let section = Section::new(KIND, Aspect::REFLECTION, self.channels(), &self.values);
        let section = Section {
            quantity: "elements of Mueller matrices in 1/sr",
            values: Cow::Borrowed(&self.values),
            // The first element is an amount of light; the others have a sign.
            measured: Some(self.first.values().to_vec()),
            ..section
        };
        vec![section.with_axes(AXIS_NAMES, self.knots())]
    }

    fn incidences(&self, aspect: Aspect) -> Vec<[f64; 2]> {
        self.first.incidences(aspect)
    }

    fn azimuth(&self) -> f64 {
        self.first.azimuth()
    }

    fn outgoing(&self, light: [f64; 2]) -> Vec<[f64; 3]> {
        self.first.outgoing(light)
    }

    fn coverage(&self, light: [f64; 2]) -> Coverage<'_> {
        self.first.coverage(light)
    }

    fn kinks(&self, edges: &Edges, light: [f64; 2]) -> Option<Kinks> {
        self.first.kinks(edges, light)
    }

    fn is_polarised(&self) -> bool {
        true
    }

    #[cfg(feature = "mueller")]
    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self, options)
    }
}
