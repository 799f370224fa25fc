//! [`Representation`] for grids of half and difference angles.

use super::data::Data;
use crate::bsdf::Bsdf;
use crate::data::{Coverage, Gaps, Options, PrepareError, Section, Uses, direction};
use crate::{Aspect, Channels, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("half-difference grid");

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
        true
    }

    fn uses(&self) -> Uses {
        Uses { lookup: true, ..Uses::default() }
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let [h, d, p] = self.bins;
        let turn = self.period().to_degrees();
        // A negative number in any channel is a gap, not a value.
        let measured = self.each_bin().filter(|&bin| self.is_measured(bin)).flat_map(|bin| self.texel(bin)).collect();
        let missing = h * d * p - self.each_bin().filter(|&bin| self.is_measured(bin)).count();
        let section = Section::new(KIND, Aspect::REFLECTION, Channels::Rgb, &self.values);
        let section = Section { measured: Some(measured), ..section };
        let section =
            section.with_fact("bins", format!("{h} of theta_h, {d} of theta_d, {p} of phi_d over {turn} degrees"));
        vec![section.with_fact("gaps", format!("{missing} of {} bins were not measured", h * d * p))]
    }

    fn gaps(&self) -> Option<Gaps> {
        let missing = self.each_bin().filter(|&bin| !self.is_measured(bin)).count();
        Some(Gaps { missing, all: self.bins.iter().product(), of: "bins", is_used: true })
    }

    fn coverage(&self, [theta, phi]: [f64; 2]) -> Coverage<'_> {
        let wi = direction(theta, phi);
        Box::new(move |wo| self.is_measured(self.bin(wi, wo)))
    }

    #[cfg(feature = "half-diff")]
    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self, options)
    }
}
