//! A sheet of material with two sides: which block of values answers for which pair of directions.

use crate::klems::KlemsMatrix;
use crate::tensor_tree::TensorTree;

/// The values of one block, in the form its file has them.
#[derive(Clone, Debug, PartialEq)]
pub enum Component {
    /// Constant on pairs of patches.
    Klems(KlemsMatrix),
    /// Constant on the leaves of a tree.
    Tree(TensorTree),
}

impl Component {
    /// `f` in 1/sr for light from `wi` to `wo`, unit vectors that point away from the surface, whatever their sides.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        match self {
            Component::Klems(matrix) => matrix.eval(wi, wo),
            Component::Tree(tree) => tree.eval(wi, wo),
        }
    }
}

/// The four blocks of a sheet, by the names that WINDOW files give them.
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
    /// All blocks, in the order in which [`Window`] keeps them.
    pub const ALL: [Block; 4] =
        [Block::TransmissionFront, Block::TransmissionBack, Block::ReflectionFront, Block::ReflectionBack];

    /// The block for light from `wi` to `wo`; `None` where either grazes the surface.
    ///
    /// The front of a WINDOW file is the side of z < 0: Radiance, whose front is +z, and WINDOW call the sides by each
    /// other's names.
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
pub struct Window {
    blocks: [Option<Component>; 4],
}

impl Window {
    /// The values of a block, where the file has it.
    pub fn block(&self, block: Block) -> Option<&Component> {
        self.blocks[block as usize].as_ref()
    }

    /// Sets a block and returns what it was before.
    pub fn set(&mut self, block: Block, component: Component) -> Option<Component> {
        self.blocks[block as usize].replace(component)
    }

    /// `f` in 1/sr for light from `wi` to `wo`, unit vectors that point away from the surface.
    ///
    /// A transmission block that is missing is the other one with the directions exchanged (Helmholtz reciprocity). A
    /// side without values, and light that grazes the surface, give 0.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        let Some(block) = Block::of(wi, wo) else { return 0.0 };
        if let Some(component) = self.block(block) {
            return component.eval(wi, wo);
        }
        let reverse = match block {
            Block::TransmissionFront => self.block(Block::TransmissionBack),
            Block::TransmissionBack => self.block(Block::TransmissionFront),
            Block::ReflectionFront | Block::ReflectionBack => None,
        };
        reverse.map_or(0.0, |component| component.eval(wo, wi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::klems::AngleBasis;

    #[test]
    fn the_sides_choose_the_block() {
        let (up, down) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
        let basis = AngleBasis::quarter();
        let mut window = Window::default();
        for (index, block) in Block::ALL.into_iter().enumerate() {
            let values = vec![index as f32 + 1.0; basis.patches().pow(2)];
            let matrix = KlemsMatrix::new(basis.clone(), basis.clone(), values).expect("a square matrix");
            assert_eq!(window.set(block, Component::Klems(matrix)), None);
        }
        let found = [(down, up), (up, down), (down, down), (up, up)].map(|(wi, wo)| window.eval(wi, wo));
        assert_eq!(found, [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(window.eval([1.0, 0.0, 0.0], up), 0.0);
    }

    #[test]
    fn one_transmission_block_serves_both_ways() {
        let basis = AngleBasis::quarter();
        let n = basis.patches();
        let values = (0..n * n).map(|at| at as f32).collect();
        let matrix = KlemsMatrix::new(basis.clone(), basis, values).expect("a square matrix");
        let mut window = Window::default();
        window.set(Block::TransmissionBack, Component::Klems(matrix.clone()));
        let (above, below) = ([0.6, 0.0, 0.8], [0.0, 0.28, -0.96]);
        assert_eq!(window.eval(above, below), matrix.eval(above, below));
        assert_eq!(window.eval(below, above), matrix.eval(above, below));
        assert_eq!(window.eval(above, above), 0.0);
    }
}
