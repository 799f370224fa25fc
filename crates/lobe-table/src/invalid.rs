//! The error for parts of a measured table that do not fit together.

use thiserror::Error;

/// An unusable part of a table: its name, what was found, and what was expected.
///
/// The parts have the names that the file format gives them, so a reader can say where they are in its file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{part}: found {found}; expected {expected}")]
pub struct Invalid {
    /// Name of the part, for example `theta_i`.
    pub part: &'static str,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
}

impl Invalid {
    /// An error in `part`.
    pub fn new(part: &'static str, found: impl Into<String>, expected: impl Into<String>) -> Self {
        Invalid { part, found: found.into(), expected: expected.into() }
    }
}

/// Checks that all values are finite.
pub(crate) fn finite(part: &'static str, values: &[f32]) -> Result<(), Invalid> {
    match values.iter().position(|v| !v.is_finite()) {
        Some(at) => Err(Invalid::new(part, format!("{} at index {at}", values[at]), "finite numbers")),
        None => Ok(()),
    }
}

/// Checks that there is at least one knot, and that they are finite and ascend strictly.
pub(crate) fn ascending(part: &'static str, knots: &[f32]) -> Result<(), Invalid> {
    if knots.is_empty() {
        return Err(Invalid::new(part, "no knots", "at least one"));
    }
    finite(part, knots)?;
    match knots.windows(2).position(|pair| pair[0] >= pair[1]) {
        Some(at) => {
            let found = format!("{} after {} at index {}", knots[at + 1], knots[at], at + 1);
            Err(Invalid::new(part, found, "strictly ascending knots"))
        }
        None => Ok(()),
    }
}

/// Checks that there are as many values as the dimensions require.
pub(crate) fn count(part: &'static str, found: usize, shape: &[usize]) -> Result<(), Invalid> {
    let expected = shape.iter().try_fold(1usize, |product, &n| product.checked_mul(n));
    if expected == Some(found) {
        return Ok(());
    }
    Err(Invalid::new(part, format!("{found} values"), format!("as many as the shape {shape:?} requires")))
}
