//! The error for columns that do not form a table.

/// What a table lacks: what was found, and what was expected.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Trouble {
    pub found: String,
    pub expected: String,
}

impl Trouble {
    pub fn new(found: impl Into<String>, expected: impl Into<String>) -> Self {
        Trouble { found: found.into(), expected: expected.into() }
    }
}
