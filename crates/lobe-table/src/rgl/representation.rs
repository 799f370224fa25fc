//! [`Representation`] for materials of the EPFL database.

use super::data::Data;
use crate::bsdf::Bsdf;
use crate::data::{Gaps, Options, PrepareError, Section, Uses, pairs};
use crate::{Aspect, Channels, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("RGL");

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        self.parts.channels.clone()
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::REFLECTION]
    }

    fn is_isotropic(&self) -> bool {
        Data::is_isotropic(self)
    }

    fn uses(&self) -> Uses {
        Uses { indexed_by: true, ..Uses::default() }
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let parts = &self.parts;
        let size = |[height, width]: [usize; 2]| format!("{height} x {width}");
        let symmetry = match self.reduction {
            _ if Data::is_isotropic(self) => "isotropic".into(),
            1 => "none".into(),
            n => format!("one of {n} equal parts of the azimuths is stored"),
        };
        let section = Section::new(KIND, Aspect::REFLECTION, parts.channels.clone(), parts.spectra.texels());
        let section = section
            .with_axes(["phi_i", "theta_i"], &[wide(&parts.phi_i), wide(&parts.theta_i)])
            .with_fact("symmetry", symmetry)
            .with_fact("spectra", format!("{} texels per channel and incident direction", size(parts.spectra.size())))
            .with_fact("vndf", format!("{} texels per incident direction", size(parts.vndf.size())))
            .with_fact("ndf", format!("{} texels", size(parts.ndf.size())));
        let quantity = match parts.jacobian {
            true => "f cos(theta_o) without the microfacet factor",
            false => "f cos(theta_o) in 1/sr",
        };
        vec![Section { quantity, ..section }]
    }

    #[cfg(feature = "rgl")]
    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self, options)
    }

    fn incidences(&self, _: Aspect) -> Vec<[f64; 2]> {
        let phis = if Data::is_isotropic(self) { vec![0.0] } else { wide(&self.parts.phi_i) };
        pairs(&wide(&self.parts.theta_i), &phis)
    }

    fn gaps(&self) -> Option<Gaps> {
        let valid = self.parts.valid.as_ref()?;
        let set: usize = valid.iter().map(|byte| byte.count_ones() as usize).sum();
        Some(Gaps { missing: 8 * valid.len() - set, all: 8 * valid.len(), of: "texels", is_used: false })
    }
}

fn wide(knots: &[f32]) -> Vec<f64> {
    knots.iter().map(|&knot| f64::from(knot)).collect()
}
