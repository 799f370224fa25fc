//! Klems matrices and tensor trees, in SIMD lanes. Each band of wavelengths is a channel.

use lobe_table::window::klems::KlemsMatrix;
use lobe_table::window::tensor_tree::Rank;
use lobe_table::window::{self, Block, Component, Data};
use lobe_table::{Channels, Invalid, Scatter};

use super::evaluator::{Evaluator, Native};
use crate::{Backend, Kind};

#[derive(Debug)]
pub(super) struct Bands {
    table: window::Table,
    channels: Channels,
    kind: Kind,
}

impl Bands {
    pub(super) fn new(data: Data) -> Result<Self, Invalid> {
        let (names, windows) = data.bands.into_iter().map(|band| (band.wavelength, band.window)).unzip();
        let table = window::Table::new(windows)?;
        let mut bands = Bands { table, channels: Channels::Named(names), kind: Kind::Klems };
        if bands.components().any(|component| matches!(component, Component::Tree(_))) {
            bands.kind = Kind::TensorTree;
        }
        Ok(bands)
    }
}

/// The matrices of every band, where light is scattered by patches.
#[derive(Clone, Copy)]
pub(crate) struct Patches<'a>(&'a Bands);

impl<'a> Patches<'a> {
    /// The matrices of one block, a band after the other; `None` where a band does not have it.
    pub(crate) fn block(&self, front: bool, scatter: Scatter) -> Option<Vec<&'a KlemsMatrix>> {
        let block = block(front, scatter);
        self.0.table.bands().iter().map(|band| band.block(block).and_then(as_matrix)).collect()
    }
}

fn as_matrix(component: &Component) -> Option<&KlemsMatrix> {
    match component {
        Component::Klems(matrix) => Some(matrix),
        Component::Tree(_) => None,
    }
}

/// The block for light from the side of z > 0, or from the other one.
fn block(front: bool, scatter: Scatter) -> Block {
    match (front, scatter) {
        (true, Scatter::Reflection) => Block::ReflectionBack,
        (true, Scatter::Transmission) => Block::TransmissionBack,
        (false, Scatter::Reflection) => Block::ReflectionFront,
        (false, Scatter::Transmission) => Block::TransmissionFront,
    }
}

impl Bands {
    fn components(&self) -> impl Iterator<Item = &Component> {
        self.table.bands().iter().flat_map(|band| Block::ALL.into_iter().filter_map(|block| band.block(block)))
    }
}

impl Evaluator for Bands {
    fn kind(&self) -> Kind {
        self.kind
    }

    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    fn is_isotropic(&self) -> bool {
        self.components().all(|component| match component {
            Component::Klems(_) => false,
            Component::Tree(tree) => tree.rank() == Rank::Three,
        })
    }

    /// One block of transmission stands for the other one too.
    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        let has = |front| self.table.bands().iter().any(|band| band.block(block(front, scatter)).is_some());
        has(front) || (scatter == Scatter::Transmission && has(!front))
    }

    fn native(&self) -> Native<'_> {
        match self.kind {
            Kind::Klems => Native::Klems(Patches(self)),
            _ => Native::None,
        }
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        self.table.eval_batch(backend, wi.into(), wo.into(), out);
    }
}
