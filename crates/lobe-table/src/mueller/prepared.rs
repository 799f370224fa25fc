//! Mueller matrices, ready to be evaluated: the value of a pair of directions is that for unpolarised light. Whole
//! matrices are laid out when they are first needed, because they take sixteen times the memory.

use std::sync::OnceLock;

use lobe_backend::Backend;

use super::data::ELEMENTS;
use super::{Data, Matrices, Matrix, Table};
use crate::bsdf::{Bsdf, unit};
use crate::data::PrepareError;
use crate::{Channels, Directions, Representation};

/// Lays the data out.
pub(super) fn prepare(data: &Data, _: &crate::data::Options) -> Result<Box<dyn Bsdf>, PrepareError> {
    let (table, channels) = (Table::new(data)?, data.channels());
    Ok(Box::new(Prepared { data: data.clone(), table, matrices: OnceLock::new(), channels }))
}

/// The matrices, and their element for unpolarised light.
#[derive(Debug)]
pub(crate) struct Prepared {
    pub(crate) data: Data,
    pub(crate) table: Table,
    /// `None` if there are more elements than lanes can index.
    pub(crate) matrices: OnceLock<Option<Matrices>>,
    pub(crate) channels: Channels,
}

impl Prepared {
    fn matrices(&self) -> Option<&Matrices> {
        self.matrices.get_or_init(|| Matrices::new(&self.data).ok()).as_ref()
    }

    fn one_by_one(&self, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        let wavelengths = &self.data.knots()[3];
        assert_eq!(wi.count(), wo.count(), "as many wi as wo");
        assert_eq!(out.len(), wi.count() * wavelengths.len() * ELEMENTS, "one matrix per query and wavelength");
        let (matrices, _) = out.as_chunks_mut::<ELEMENTS>();
        for (at, matrix) in matrices.iter_mut().enumerate() {
            let (query, nm) = (at / wavelengths.len(), f64::from(wavelengths[at % wavelengths.len()]));
            let exact = self.mueller(wi.get(query), wo.get(query), nm).unwrap_or_default();
            matrix.iter_mut().zip(exact.as_flattened()).for_each(|(out, element)| *out = *element as f32);
        }
    }
}

impl Bsdf for Prepared {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn bytes(&self) -> usize {
        let matrices = self.matrices.get().and_then(Option::as_ref).map_or(0, Matrices::bytes);
        size_of_val(self.data.values()) + self.table.bytes() + matrices
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.table.eval_batch(backend, wi, wo, out);
    }

    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        Some(unit(wi).zip(unit(wo)).map_or([[0.0; 4]; 4], |(wi, wo)| self.data.eval(wi, wo, nm)))
    }

    fn is_polarised(&self) -> bool {
        true
    }

    fn mueller_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
        match self.matrices() {
            Some(matrices) => matrices.eval_batch(backend, wi, wo, out),
            None => self.one_by_one(wi, wo, out),
        }
        true
    }
}
