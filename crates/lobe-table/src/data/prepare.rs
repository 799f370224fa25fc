//! The error for data that cannot be evaluated.

use thiserror::Error;

use super::Kind;
use crate::{Invalid, TableError};

/// Measured data cannot be prepared for evaluation.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// They have no values for pairs of directions.
    #[error("found {0}; expected a BRDF or BTDF")]
    NoValues(Kind),
    /// This program was built without the feature that evaluates them.
    #[error("found {0}; this program was built without the feature for it")]
    LeftOut(Kind),
    /// They are too large for a table.
    #[error(transparent)]
    Table(#[from] TableError),
    /// They have more values than lanes can index.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}
