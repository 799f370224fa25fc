//! The values of one band of wavelengths, with their evaluation in `f64`.

use super::klems::KlemsMatrix;
use super::tensor_tree::TensorTree;
use crate::{Aspect, Scatter, Side};

/// The values of one block, in the form of its file.
#[derive(Clone, Debug, PartialEq)]
pub enum Component {
    /// Constant on pairs of patches.
    Klems(KlemsMatrix),
    /// Constant on the leaves of a tree.
    Tree(TensorTree),
}

impl Component {
    /// `f` in 1/sr for light from `wi` to `wo`, unit vectors that point away from the surface, on any sides.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        match self {
            Component::Klems(matrix) => matrix.eval(wi, wo),
            Component::Tree(tree) => tree.eval(wi, wo),
        }
    }

    /// All values that [`eval`](Self::eval) may have in the lanes: if directions are within rounding of the border of
    /// two patches or cells, those of both.
    pub fn candidates(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f64> {
        match self {
            Component::Klems(matrix) => matrix.candidates(wi, wo),
            Component::Tree(tree) => tree.candidates(wi, wo),
        }
    }
}

/// The four blocks of a sheet, with their names in WINDOW files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Block {
    /// Light arrives from z < 0 and leaves to z > 0.
    TransmissionFront,
    /// Light arrives from z > 0 and leaves to z < 0.
    TransmissionBack,
    /// Light arrives from z < 0 and leaves to z < 0.
    ReflectionFront,
    /// Light arrives from z > 0 and leaves to z > 0.
    ReflectionBack,
}

impl Block {
    /// All blocks, in the order in which [`Blocks`] stores them.
    pub const ALL: [Block; 4] =
        [Block::TransmissionFront, Block::TransmissionBack, Block::ReflectionFront, Block::ReflectionBack];

    /// The block that has the values of this one for exchanged directions (Helmholtz reciprocity).
    pub(super) fn reverse(self) -> Option<Block> {
        match self {
            Block::TransmissionFront => Some(Block::TransmissionBack),
            Block::TransmissionBack => Some(Block::TransmissionFront),
            Block::ReflectionFront | Block::ReflectionBack => None,
        }
    }

    /// Its name in WINDOW files, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Block::TransmissionFront => "transmission front",
            Block::TransmissionBack => "transmission back",
            Block::ReflectionFront => "reflection front",
            Block::ReflectionBack => "reflection back",
        }
    }

    /// The aspect of this block. The front of a WINDOW file is the side of z < 0.
    pub fn aspect(self) -> Aspect {
        let (scatter, light) = match self {
            Block::TransmissionFront => (Scatter::Transmission, Side::Back),
            Block::TransmissionBack => (Scatter::Transmission, Side::Front),
            Block::ReflectionFront => (Scatter::Reflection, Side::Back),
            Block::ReflectionBack => (Scatter::Reflection, Side::Front),
        };
        Aspect { scatter, light }
    }

    /// The block of an aspect.
    pub fn of_aspect(aspect: Aspect) -> Block {
        match (aspect.scatter, aspect.light) {
            (Scatter::Transmission, Side::Back) => Block::TransmissionFront,
            (Scatter::Transmission, Side::Front) => Block::TransmissionBack,
            (Scatter::Reflection, Side::Back) => Block::ReflectionFront,
            (Scatter::Reflection, Side::Front) => Block::ReflectionBack,
        }
    }

    /// The block for light from `wi` to `wo`; `None` if either grazes the surface.
    ///
    /// The front of a WINDOW file is the side of z < 0: WINDOW's names of the sides are the opposite of Radiance's,
    /// whose front is +z.
    pub fn of(wi: [f64; 3], wo: [f64; 3]) -> Option<Block> {
        let above = |direction: [f64; 3]| (direction[2] != 0.0).then_some(direction[2] > 0.0);
        Some(match (above(wi)?, above(wo)?) {
            (false, true) => Block::TransmissionFront,
            (true, false) => Block::TransmissionBack,
            (false, false) => Block::ReflectionFront,
            (true, true) => Block::ReflectionBack,
        })
    }
}

/// A sheet of material with two sides, in one band of wavelengths: up to four blocks of values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Blocks {
    blocks: [Option<Component>; 4],
}

impl Blocks {
    /// The values of a block, if the file has it.
    pub fn block(&self, block: Block) -> Option<&Component> {
        self.blocks[block as usize].as_ref()
    }

    /// Sets a block and returns its previous value.
    pub fn set(&mut self, block: Block, component: Component) -> Option<Component> {
        self.blocks[block as usize].replace(component)
    }

    /// `f` in 1/sr for light from `wi` to `wo`, unit vectors that point away from the surface.
    ///
    /// A missing transmission block is replaced by the other one with the directions exchanged (Helmholtz reciprocity).
    /// A side without values, and light that grazes the surface, give 0.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        self.answer(wi, wo).map_or(0.0, |(component, wi, wo)| component.eval(wi, wo))
    }

    /// All values that [`eval`](Self::eval) may have in the lanes of a [`Table`](super::Table): if directions are
    /// within rounding of the border of two patches or cells, those of both.
    pub fn candidates(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f64> {
        self.answer(wi, wo).map_or(vec![0.0], |(component, wi, wo)| component.candidates(wi, wo))
    }

    /// The block for light from `wi` to `wo`, and the directions with which to evaluate it.
    fn answer(&self, wi: [f64; 3], wo: [f64; 3]) -> Option<(&Component, [f64; 3], [f64; 3])> {
        let block = Block::of(wi, wo)?;
        let own = self.block(block).map(|component| (component, wi, wo));
        own.or_else(|| Some((self.block(block.reverse()?)?, wo, wi)))
    }
}
