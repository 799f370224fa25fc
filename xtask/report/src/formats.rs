//! Compares the values of every format with the programs that define it.

use lobe::Backend;

use xtask_common::Grid;

use crate::golden::{self, Comparison};

/// The name by which it can be selected.
pub const ID: &str = "formats";

/// Compares all files for which there are answers, in the lanes of the best backend.
///
/// # Errors
/// The same as for [`golden::compare`].
pub fn compare() -> anyhow::Result<Vec<Comparison>> {
    golden::compare(Backend::best().fused())
}

/// The table; `None` if it was not requested.
pub fn grids(comparisons: Option<&[Comparison]>) -> Vec<Grid> {
    let grid = |comparisons: &[Comparison]| {
        Grid::new(
            "Formats",
            reading(comparisons),
            ["file", "reader", "pairs", "largest error", "allowed", "against"],
            comparisons.iter().map(row).collect(),
        )
    };
    comparisons.map(grid).into_iter().collect()
}

fn reading(comparisons: &[Comparison]) -> String {
    if comparisons.is_empty() {
        return format!("Skipped: no answers of other programs in {}; set LOBE_SHARED.", golden::folder().display());
    }
    let pairs: usize = comparisons.iter().map(|comparison| comparison.pairs).sum();
    let wrong = comparisons.iter().filter(|comparison| !comparison.ok()).count();
    let verdict = if wrong == 0 { "all of them agree".to_owned() } else { format!("{wrong} DO NOT AGREE") };
    format!(
        "Values in lanes compared with the answers of the programs that define the formats: {} files, {pairs} pairs of \
         directions, {verdict}.",
        comparisons.len()
    )
}

fn row(comparison: &Comparison) -> Vec<String> {
    let Comparison { file, reader, against, pairs, error, of, bound } = comparison;
    vec![
        file.clone(),
        reader.clone(),
        pairs.to_string(),
        if *error == 0.0 { "none".into() } else { format!("{error:.1e} {}", of.name()) },
        if *bound == 0.0 { "none".into() } else { format!("{bound:.1e}") },
        (*against).to_owned(),
    ]
}
