//! Tables of figures that are not ratios of speeds, as text in cells, for both the terminal and pages.

use comfy_table::{CellAlignment, Table, presets};

use super::svg::escape;

/// A heading, an explanation, and rows of cells; the first column names the row.
#[derive(Clone, Debug)]
pub struct Grid {
    title: &'static str,
    reading: String,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
    notes: Vec<String>,
}

impl Grid {
    /// A table with a heading and an explanation. If there are no rows, the explanation says why.
    pub fn new(
        title: &'static str,
        reading: impl Into<String>,
        header: impl IntoIterator<Item: Into<String>>,
        rows: Vec<Vec<String>>,
    ) -> Self {
        let header = header.into_iter().map(Into::into).collect();
        Grid { title, reading: reading.into(), header, rows, notes: Vec::new() }
    }

    /// Adds notes below the table, one line or paragraph each.
    pub fn with_notes(self, notes: Vec<String>) -> Self {
        Grid { notes, ..self }
    }

    /// Prints it on the terminal.
    pub fn print(&self) {
        println!("\n{}\n{}", self.title, self.reading);
        if !self.rows.is_empty() {
            let mut table = Table::new();
            table.load_style(presets::UTF8_HORIZONTAL_ONLY);
            table.set_header(&self.header);
            table.add_rows(&self.rows);
            for column in table.column_iter_mut().skip(1) {
                column.set_cell_alignment(CellAlignment::Right);
            }
            println!("{table}");
        }
        self.notes.iter().for_each(|note| println!("{note}"));
    }

    /// Formats it as a section of a page of the documentation.
    pub fn markdown(&self) -> String {
        let line = |cells: &Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut text = format!("\n## {}\n\n{}\n", self.title, self.reading);
        if !self.rows.is_empty() {
            let columns = "|--:".repeat(self.header.len() - 1);
            text += &format!("\n{}|---{columns}|\n", line(&self.header));
            text.extend(self.rows.iter().map(line));
        }
        text.extend(self.notes.iter().map(|note| format!("\n{note}\n")));
        text
    }

    /// Formats it as a section of the report's page.
    pub fn html(&self) -> String {
        let cells = |tag: &str, texts: &[String]| -> String {
            texts.iter().map(|text| format!("<{tag}>{}</{tag}>", escape(text))).collect()
        };
        let mut text = format!("<h2>{}</h2><p>{}</p>", escape(self.title), escape(&self.reading));
        if !self.rows.is_empty() {
            let head = cells("th", &self.header);
            let lines: String = self.rows.iter().map(|row| format!("<tr>{}</tr>", cells("td", row))).collect();
            text += &format!(
                r#"<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table></div>"#
            );
        }
        text.extend(self.notes.iter().map(|note| format!("<p>{}</p>", escape(note))));
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_of_markdown_has_the_table_between_reading_and_notes() {
        let rows = vec![vec!["paper".into(), "0.5".into()], vec!["gold".into(), "0.9".into()]];
        let grid = Grid::new("Albedo", "Of a few.", ["material", "albedo"], rows).with_notes(vec!["The end.".into()]);
        let table = "| material | albedo |\n|---|--:|\n| paper | 0.5 |\n| gold | 0.9 |\n";
        assert_eq!(grid.markdown(), format!("\n## Albedo\n\nOf a few.\n\n{table}\nThe end.\n"));
        let empty = Grid::new("Albedo", "There are no files.", ["material"], Vec::new());
        assert_eq!(empty.markdown(), "\n## Albedo\n\nThere are no files.\n");
    }
}
