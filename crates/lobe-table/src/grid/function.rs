//! Functions of one variable, straight from the search of their knots.
//!
//! These are the specialised searches of the paper (section 2.2): a caller seldom wants the index of a cell, but rather
//! the interpolation weights there ([`Axis::weights`]), or the value of a function.

use lobe_lane::{Floats, Lanes};

use super::neighbours::Neighbours;
use crate::grid::axis::Axis;
use crate::grid::find::Cell;
use crate::{AxisError, Edge};

/// A piecewise linear function of an angle, evaluated in lanes.
#[derive(Clone, Debug)]
pub struct Function {
    axis: Axis,
    /// `[value at the cell's first knot, difference to that at its second]`.
    cells: Vec<[f32; 2]>,
}

impl Function {
    /// A function with a value at each knot. Knots are in radians, strictly ascending.
    ///
    /// # Errors
    /// If knots and values do not match, or the knots are not finite and strictly ascending.
    pub fn new(knots: &[f64], values: &[f64], edge: Edge) -> Result<Self, AxisError> {
        let axis = Axis::new(knots, edge)?;
        if values.len() != knots.len() {
            return Err(AxisError::Values { knots: knots.len(), values: values.len() });
        }
        let at = |knot: usize| values[axis.source()[knot]];
        let cells = if axis.cells().is_empty() {
            vec![[at(0) as f32, 0.0]]
        } else {
            (0..axis.cells().len()).map(|i| [at(i) as f32, (at(i + 1) - at(i)) as f32]).collect()
        };
        Ok(Function { axis, cells })
    }

    /// The axis that is searched.
    pub fn axis(&self) -> &Axis {
        &self.axis
    }

    /// The value at one `x`, in radians, in `f64`.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let edge = if self.axis.edge() == Edge::Extrapolate { Edge::Extrapolate } else { Edge::Clamp };
        let at = Neighbours::find(self.axis.knots(), edge, x).unwrap_or(Neighbours::ONLY);
        let [value, difference] = self.cells[at.nodes[0]].map(f64::from);
        value + at.weights[1] * difference
    }

    /// The value at `x`, in radians.
    #[inline(always)]
    pub fn eval<L: Lanes>(&self, lanes: L, x: L::F) -> L::F {
        let inside = self.axis.contains(lanes, x);
        let Cell { index, fraction } = self.axis.cell(lanes, self.axis.bring_inside(lanes, x));
        let [value, slope] = lanes.gather_pair(&self.cells, index);
        lanes.mul_add(fraction, slope, value).masked(inside)
    }
}
