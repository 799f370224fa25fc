//! What programs need from the grid of the UTIA database.

use std::borrow::Cow;

use super::{Data, PHIS, STEPS, THETAS};
use crate::bsdf::Bsdf;
use crate::data::{Options, PrepareError, Section, pairs};
use crate::{Aspect, Channels, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("UTIA grid");

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        Channels::Rgb
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::REFLECTION]
    }

    fn is_isotropic(&self) -> bool {
        false
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let values = self.values.iter().map(|&value| value as f32).collect();
        let section = Section::new(KIND, Aspect::REFLECTION, Channels::Rgb, &[]);
        let section = Section {
            quantity: "no documented unit",
            values: Cow::Owned(values),
            bytes: size_of_val(self.values.as_slice()),
            ..section
        };
        let grid = format!("{THETAS} polar angles to 75 degrees and {PHIS} azimuths of both directions");
        vec![section.with_fact("grid", grid)]
    }

    fn incidences(&self, _: Aspect) -> Vec<[f64; 2]> {
        let angles =
            |count: usize, step: f64| -> Vec<f64> { (0..count).map(|i| (step * i as f64).to_radians()).collect() };
        pairs(&angles(THETAS, STEPS[0]), &angles(PHIS, STEPS[1]))
    }

    fn has_known_unit(&self) -> bool {
        false
    }

    fn extent(&self) -> Option<&'static str> {
        Some("both directions from 0 to 75 degrees; beyond, values are extrapolated")
    }

    #[cfg(feature = "utia")]
    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self, options)
    }
}
