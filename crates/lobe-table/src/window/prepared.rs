//! Klems matrices and tensor trees, ready to be evaluated. Each band of wavelengths is a channel.

use lobe_backend::Backend;

use super::klems::KlemsMatrix;
use super::{Block, Component, Data, Table};
use crate::bsdf::Bsdf;
use crate::data::PrepareError;
use crate::{Aspect, Channels, Directions, DistributionError, Invalid, PatchSampler, Representation, Scatter};

/// Lays the data out.
pub(super) fn prepare(data: &Data, _: &crate::data::Options) -> Result<Box<dyn Bsdf>, PrepareError> {
    Ok(Box::new(Prepared::new(data)?))
}

#[derive(Debug)]
pub(crate) struct Prepared {
    table: Table,
    channels: Channels,
    is_isotropic: bool,
}

impl Prepared {
    pub(crate) fn new(data: &Data) -> Result<Self, Invalid> {
        let blocks = data.bands.iter().map(|band| band.window.clone()).collect();
        Ok(Prepared { table: Table::new(blocks)?, channels: data.channels(), is_isotropic: data.is_isotropic() })
    }
}

impl Bsdf for Prepared {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    /// One transmission block also serves for the other direction.
    fn holds(&self, aspect: Aspect) -> bool {
        let has = |aspect| self.table.bands().iter().any(|band| band.block(Block::of_aspect(aspect)).is_some());
        has(aspect) || (aspect.scatter == Scatter::Transmission && has(aspect.reversed()))
    }

    fn is_isotropic(&self) -> bool {
        self.is_isotropic
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.table.eval_batch(backend, wi, wo, out);
    }

    /// The matrices, if every band has one.
    fn patches(
        &self,
        aspect: Aspect,
        luminance: &[f32],
        defensive: f32,
    ) -> Result<Option<PatchSampler>, DistributionError> {
        let blocks = self.table.bands().iter().map(|band| band.block(Block::of_aspect(aspect)));
        let Some(matrices) = blocks.map(as_matrix).collect::<Option<Vec<&KlemsMatrix>>>() else { return Ok(None) };
        let channels: Vec<_> = matrices.into_iter().zip(luminance.iter().copied()).collect();
        PatchSampler::new(aspect.scatter, &channels, defensive)
    }
}

fn as_matrix(component: Option<&Component>) -> Option<&KlemsMatrix> {
    match component? {
        Component::Klems(matrix) => Some(matrix),
        Component::Tree(_) => None,
    }
}
