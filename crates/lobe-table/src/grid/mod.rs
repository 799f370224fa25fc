//! Grids apart from what their axes mean.
//!
//! An [`Axis`] has knots, a way to find the cell of an angle among them (`search`), and an [`Edge`] rule for what is
//! outside. `layout` and `texel` say how values lie in memory. The passes of a block go from angles to values:
//!
//! 1. `cells`: for each axis the cell and the fraction, summed up to the index of a texel;
//! 2. `weights`: fractions to the weights of the corners;
//! 3. `texels`: the corners of each query, weighted and summed.
//!
//! `interpolation` is all of it for four axes, and `single` the same for one query. `neighbours` finds cells in `f64`,
//! for the references.

pub(crate) mod axis;
pub(crate) mod cells;
pub(crate) mod check;
mod descend;
pub(crate) mod edges;
mod error;
pub(crate) mod find;
pub(crate) mod function;
pub(crate) mod interpolation;
pub(crate) mod layout;
pub(crate) mod neighbours;
pub(crate) mod search;
mod single;
pub(crate) mod texel;
pub(crate) mod texels;
pub(crate) mod tree;
pub(crate) mod weights;

pub use axis::{Axis, AxisError};
pub use edges::{Edge, Edges};
pub use error::{GridError, TableError};
pub use find::Cell;
pub use function::Function;
pub use texel::Precision;
