//! [`Representation`] for the grid of the UTIA database.

use std::borrow::Cow;

use super::data::{Data, PHIS, STEPS, THETAS};
use crate::bsdf::Bsdf;
use crate::data::{Coverage, Options, PrepareError, SAME, Section, Uses, direction, pairs};
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

    fn uses(&self) -> Uses {
        Uses { decode: true, ..Uses::default() }
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

    fn outgoing(&self, _: [f64; 2]) -> Vec<[f64; 3]> {
        self.incidences(Aspect::REFLECTION).into_iter().map(|[theta, phi]| direction(theta, phi)).collect()
    }

    fn coverage(&self, [theta, _]: [f64; 2]) -> Coverage<'_> {
        let last = (STEPS[0] * (THETAS - 1) as f64).to_radians() + SAME;
        let is_between = theta <= last;
        Box::new(move |wo| is_between && wo[0].hypot(wo[1]).atan2(wo[2]) <= last)
    }

    #[cfg(feature = "utia")]
    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self, options)
    }
}
