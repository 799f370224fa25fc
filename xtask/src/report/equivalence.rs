//! Whether all backends give the same bits, as one table of the page.

use serde::Serialize;

/// What the equivalence check found.
#[derive(Clone, Debug, Serialize)]
pub struct EquivalenceSummary {
    /// One line a check: what was compared, and what came out.
    pub rows: Vec<[String; 2]>,
    /// `true` where everything held.
    pub ok: bool,
}

/// Runs the check and sums it up.
pub fn summary() -> EquivalenceSummary {
    let (rows, ok) = crate::equivalence::summary();
    EquivalenceSummary { rows, ok }
}
