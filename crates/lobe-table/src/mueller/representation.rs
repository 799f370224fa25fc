//! [`Representation`] for Mueller matrices.

use std::borrow::Cow;

use super::data::{AXES, Data, ELEMENTS};
use crate::bsdf::Bsdf;
use crate::data::{Gaps, Options, PrepareError, Section};
use crate::{Aspect, Channels, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("Mueller matrices");

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        Channels::Spectral(self.knots[3].iter().map(|nm| f64::from(*nm)).collect())
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::REFLECTION]
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn sections(&self) -> Vec<Section<'_>> {
        // NaN means that nothing was measured.
        let values: Vec<f32> = self.values.iter().copied().filter(|value| !value.is_nan()).collect();
        // The first element is an amount of light; the others have a sign.
        let measured = self.values.iter().copied().step_by(ELEMENTS).filter(|value| !value.is_nan()).collect();
        let wide = |axis: usize| self.knots[axis].iter().map(|&knot| f64::from(knot)).collect::<Vec<_>>();
        let (all, gaps) = (self.values.len() / ELEMENTS, (self.values.len() - values.len()).div_ceil(ELEMENTS));
        let section = Section::new(KIND, Aspect::REFLECTION, self.channels(), &[]);
        let section = Section {
            quantity: "elements of Mueller matrices in 1/sr",
            bytes: size_of_val(values.as_slice()),
            values: Cow::Owned(values),
            measured: Some(measured),
            ..section
        };
        let section = section.with_axes([AXES[0], AXES[1], AXES[2]], &[wide(0), wide(1), wide(2)]);
        vec![section.with_fact("gaps", format!("{gaps} of {all} matrices were not measured"))]
    }

    fn gaps(&self) -> Option<Gaps> {
        let first = self.values.iter().step_by(ELEMENTS);
        let missing = first.clone().filter(|value| value.is_nan()).count();
        Some(Gaps { missing, all: first.count(), of: "matrices", is_used: true })
    }

    fn is_polarised(&self) -> bool {
        true
    }

    #[cfg(feature = "mueller")]
    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self, options)
    }
}
