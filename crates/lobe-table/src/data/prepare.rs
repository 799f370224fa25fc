//! Why data cannot be evaluated.

use thiserror::Error;

use super::Kind;
use crate::{Invalid, TableError};

/// Why measured data have no form in which they can be evaluated.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// They have no value for a pair of directions.
    #[error("found {0}; expected a BRDF or BTDF")]
    NoValues(Kind),
    /// This program was built without the feature that evaluates them.
    #[error("found {0}, whose feature this program was built without")]
    LeftOut(Kind),
    /// They are too large for a table.
    #[error(transparent)]
    Table(#[from] TableError),
    /// They are more than lanes can index.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}
