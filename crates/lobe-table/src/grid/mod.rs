//! Grids apart from what their axes mean: knots and how cells are found among them, what holds outside, and how texels lie
//! in memory.

pub(crate) mod axis;
pub(crate) mod cells;
pub(crate) mod check;
pub(crate) mod edges;
mod error;
pub(crate) mod function;
pub(crate) mod interpolation;
pub(crate) mod layout;
pub(crate) mod neighbours;
pub(crate) mod search;
mod single;
pub(crate) mod texel;
pub(crate) mod texels;
pub(crate) mod weights;

pub use axis::{Axis, AxisError};
pub use edges::{Edge, Edges};
pub use error::{GridError, TableError};
pub use function::Function;
pub use search::Cell;
pub use texel::Precision;
