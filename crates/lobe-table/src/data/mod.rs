//! The interface to measured data in any representation: the trait [`Representation`], which each representation
//! implements next to its data, and the types of its results.

mod aspect;
mod kind;
mod near;
mod options;
mod prepare;
mod representation;
mod section;

pub use aspect::{Aspect, Side};
pub use kind::Kind;
pub(crate) use near::{Near, SAME, direction, reach, spans};
pub use options::{Options, Uses};
pub use prepare::PrepareError;
pub use representation::{Coverage, Representation, Samples, ValueMap};
pub(crate) use section::pairs;
pub use section::{ANGLE_ROUNDING, Fact, Gaps, Grid, Kinks, Section, SectionAxis, closes_circle};
