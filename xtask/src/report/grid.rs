//! Tables of figures that are no ratios of speeds, as text in cells: the same on the terminal and on the page.

use std::fmt::Write;

use comfy_table::{CellAlignment, Table, presets};

use super::svg::escape;

/// A heading, what there is to know, and rows of cells; the first column names the row.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Heading.
    pub title: &'static str,
    /// How to read it.
    pub reading: String,
    /// The heads of the columns.
    pub header: &'static [&'static str],
    /// One cell a column; where there are no rows, the reading says why.
    pub rows: Vec<Vec<String>>,
}

impl Grid {
    /// On the terminal.
    pub fn print(&self) {
        if self.rows.is_empty() {
            return println!("\n{}\n{}", self.title, self.reading);
        }
        let mut table = Table::new();
        table.load_style(presets::UTF8_HORIZONTAL_ONLY);
        table.set_header(self.header);
        table.add_rows(&self.rows);
        for column in table.column_iter_mut().skip(1) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        println!("\n{}\n{table}", self.title);
    }

    /// As a section of the page.
    pub fn html(&self) -> String {
        let cells = |tag: &str, texts: &mut dyn Iterator<Item = &str>| -> String {
            texts.map(|text| format!("<{tag}>{}</{tag}>", escape(text))).collect()
        };
        let head = cells("th", &mut self.header.iter().copied());
        let mut lines = String::new();
        for row in &self.rows {
            let row = cells("td", &mut row.iter().map(String::as_str));
            write!(lines, "<tr>{row}</tr>").expect("a string");
        }
        if self.rows.is_empty() {
            return format!(r#"<h2>{}</h2><p class="note">{}</p>"#, escape(self.title), escape(&self.reading));
        }
        format!(
            r#"<h2>{}</h2><p>{}</p><div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table></div>"#,
            escape(self.title),
            escape(&self.reading)
        )
    }
}
