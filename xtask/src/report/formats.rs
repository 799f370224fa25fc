//! How far the values of every format are from those of the programs that define it.

use comfy_table::{CellAlignment, Table, presets};
use lobe::Backend;

use super::svg::escape;
use crate::golden::{self, Comparison};

const TITLE: &str = "Formats";

/// Compares all files that there are answers for, in the lanes of the best backend.
///
/// # Errors
/// As [`golden::compare`].
pub fn compare() -> anyhow::Result<Vec<Comparison>> {
    golden::compare(Backend::best().fused())
}

/// What was compared, in a sentence.
fn summary(comparisons: &[Comparison]) -> String {
    if comparisons.is_empty() {
        return format!("Skipped: no answers of other programs in {}; set LOBE_SHARED.", golden::folder().display());
    }
    let pairs: usize = comparisons.iter().map(|comparison| comparison.pairs).sum();
    let wrong = comparisons.iter().filter(|comparison| !comparison.ok()).count();
    let verdict = if wrong == 0 { "all agree".to_owned() } else { format!("{wrong} DO NOT AGREE") };
    format!("{} files, {pairs} pairs of directions, in lanes: {verdict}.", comparisons.len())
}

const HEAD: [&str; 6] = ["file", "reader", "pairs", "largest error", "allowed", "against"];

fn cells(comparison: &Comparison) -> [String; 6] {
    let Comparison { file, reader, against, pairs, error, of, bound } = comparison;
    [
        file.clone(),
        reader.clone(),
        pairs.to_string(),
        if *error == 0.0 { "none".into() } else { format!("{error:.1e} {}", of.name()) },
        if *bound == 0.0 { "none".into() } else { format!("{bound:.1e}") },
        (*against).to_owned(),
    ]
}

/// The table for the terminal.
pub fn terminal(comparisons: &[Comparison]) -> String {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(HEAD);
    for comparison in comparisons {
        table.add_row(cells(comparison));
    }
    for column in [2, 4] {
        table.column_mut(column).expect("a column").set_cell_alignment(CellAlignment::Right);
    }
    let table = if comparisons.is_empty() { String::new() } else { format!("\n{table}") };
    format!("{TITLE}\n{}{table}", summary(comparisons))
}

/// The section of the page.
pub fn html(comparisons: &[Comparison]) -> String {
    let row = |comparison: &Comparison| {
        let cells: String = cells(comparison).iter().map(|cell| format!("<td>{}</td>", escape(cell))).collect();
        format!("<tr>{cells}</tr>")
    };
    let rows: String = comparisons.iter().map(row).collect();
    let class = if comparisons.iter().all(Comparison::ok) { "good" } else { "bad" };
    let class = if comparisons.is_empty() { "note" } else { class };
    let head: String = HEAD.iter().map(|name| format!("<th>{name}</th>")).collect();
    let table =
        format!(r#"<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>"#);
    let table = if comparisons.is_empty() { String::new() } else { table };
    format!(r#"<h2>{TITLE}</h2><p class="{class}">{}</p>{table}"#, escape(&summary(comparisons)))
}
