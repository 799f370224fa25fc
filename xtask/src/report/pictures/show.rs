//! The section on the terminal and on the page.

use std::fmt::Write;

use comfy_table::{CellAlignment, Table, presets};

use super::Pictures;
use crate::report::rows::{nanoseconds, times};
use crate::report::svg::escape;

/// Prints the section.
pub fn print(pictures: &Pictures) {
    println!("\nPictures\n{}", pictures.sentence());
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(pictures.head());
    pictures.lines().into_iter().for_each(|line| {
        table.add_row(line);
    });
    table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    println!("{table}");
    pictures.notes().iter().for_each(|note| println!("{note}"));
}

/// The section of the page.
pub fn html(pictures: &Pictures) -> String {
    let cells = |tag: &str, cells: Vec<String>| -> String {
        cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect()
    };
    let mut text = format!("<h2>Pictures</h2><p>{}</p>", escape(&pictures.sentence()));
    let head = cells("th", pictures.head());
    let lines: String = pictures.lines().into_iter().map(|line| format!("<tr>{}</tr>", cells("td", line))).collect();
    write!(text, r#"<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{lines}</tbody></table></div>"#)
        .expect("a string");
    let notes: String = pictures.notes().iter().map(|note| format!("<p>{}</p>", escape(note))).collect();
    text + &notes
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

impl Pictures {
    fn sentence(&self) -> String {
        format!(
            "Frames of {} triangles in {} materials, a measured table of 17 × 7 × 17 × 13 each, on one thread. Hits are \
             queued by material, so that lanes are in use also where neighbouring rays hit different things: the last \
             columns. After a bounce a material takes that long for a pair of directions or a drawing.",
            self.triangles, self.materials
        )
    }

    /// As many depths as any backend has met.
    fn depths(&self) -> usize {
        self.frames.iter().map(|frame| frame.lanes_in_use.len()).max().unwrap_or(0)
    }

    fn head(&self) -> Vec<String> {
        let mut head: Vec<String> =
            ["", "frame, ms", "× scalar", "in materials", "after a bounce, ns", "× scalar"].map(Into::into).into();
        head.extend((0..self.depths()).map(|depth| match depth {
            0 => "lanes, first hit".to_owned(),
            depth => format!("bounce {depth}"),
        }));
        head
    }

    fn lines(&self) -> Vec<Vec<String>> {
        let line = |frame: &super::Frame| {
            let scalar = &self.frames[0];
            let mut line = vec![
                frame.backend.to_owned(),
                nanoseconds(frame.milliseconds),
                times(scalar.milliseconds / frame.milliseconds),
                percent(frame.material_share),
                nanoseconds(frame.bounced_nanoseconds),
                times(scalar.bounced_nanoseconds / frame.bounced_nanoseconds),
            ];
            line.extend(frame.lanes_in_use.iter().map(|share| percent(*share)));
            line.resize(6 + self.depths(), String::new());
            line
        };
        self.frames.iter().map(line).collect()
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if let (Some(threads), Some(frame)) = (self.threads, self.frames.last()) {
            notes.push(format!(
                "Two threads render the frame in {} the speed of one ({}).",
                times(threads),
                frame.backend
            ));
        }
        for packets in &self.packets {
            notes.push(format!(
                "Packets of four {} rays with SSE2: {:.1} million rays a second, {} the scalar instance of the same code.",
                packets.rays,
                packets.sse2,
                times(packets.sse2 / packets.scalar)
            ));
        }
        notes
    }
}
