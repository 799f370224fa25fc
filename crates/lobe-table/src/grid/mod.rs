//! Grids, without the meaning of their axes.
//!
//! An [`Axis`] has knots, a way to find the cell of an angle among them (`search`), and an [`Edge`] rule for angles
//! outside. `layout` and `texel` define how values are stored. The passes of a block go from angles to values:
//!
//! 1. `cells`: the cell and the fraction on each axis; the cells add up to the index of a texel;
//! 2. `weights`: from the fractions to the weights of the corners;
//! 3. `texels`: the corners of each query, weighted and summed.
//!
//! `interpolation` combines these for four axes, and `single` does the same for one query. `neighbours` finds cells in
//! `f64`, for the references.

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
