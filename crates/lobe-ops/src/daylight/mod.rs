//! Matrices of views, transmission, daylight and skies, as the three-phase and five-phase methods multiply them.
//!
//! A view matrix states what each sensor receives from each patch of directions in which light leaves a window; a
//! transmission matrix, how light from each incident patch leaves in each outgoing patch; a daylight matrix, what
//! arrives in each incident patch from each patch of the sky; and a sky vector, or a matrix with a column per hour, how
//! bright the patches of the sky are. Their product is what the sensors receive. Files are Radiance matrix files; the
//! transmission may also be a WINDOW file with Klems matrices.

mod file;
mod product;
mod transmission;

pub use file::{Format, read, to_bytes, write};
pub use product::{Shapes, product};
pub use transmission::{Unfit, transmission};

use nalgebra::DMatrix;

/// A matrix whose elements all have the same components, such as red, green and blue.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    components: Vec<DMatrix<f64>>,
}

impl Matrix {
    /// A matrix of `elements`, `[row][column][component]`.
    ///
    /// # Panics
    /// If there are no components, or the number of `elements` does not match the shape.
    pub fn new([rows, columns, components]: [usize; 3], elements: &[f64]) -> Self {
        assert!(components > 0, "at least one component");
        assert_eq!(elements.len(), rows * columns * components, "rows times columns times components");
        let of_component = |component: usize| {
            let elements = elements.iter().skip(component).step_by(components).copied();
            DMatrix::from_row_iterator(rows, columns, elements)
        };
        Matrix { components: (0..components).map(of_component).collect() }
    }

    /// The numbers of rows, columns and components.
    pub fn shape(&self) -> [usize; 3] {
        [self.components[0].nrows(), self.components[0].ncols(), self.components.len()]
    }

    /// The component of an element.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn at(&self, row: usize, column: usize, component: usize) -> f64 {
        self.components[component][(row, column)]
    }

    /// The sum of two matrices of the same shape, the second multiplied by a factor; `None` if their shapes differ.
    pub fn plus(&self, other: &Matrix, factor: f64) -> Option<Matrix> {
        if self.shape() != other.shape() {
            return None;
        }
        let pairs = self.components.iter().zip(&other.components);
        Some(Matrix { components: pairs.map(|(a, b)| a + b * factor).collect() })
    }
}
