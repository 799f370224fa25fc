//! Tables from users' own goniometers: CSV, text or JSON with named columns.
//!
//! Columns of angles are `theta_i`, `phi_i`, `theta_o`, `phi_o`, or in specular coordinates `sigma`, `psi`, `theta`,
//! `phi`; other common names are understood too, and so are tabs, semicolons or blanks between cells, decimal commas,
//! lines above the names and below the rows, and cells without a value. `docs/formats.md` lists everything.
//! [`ReadOptions`] supply facts that a table leaves open, and [`Document::notes`] says how it was understood.
//!
//! A comment `# scatter: transmission` before the names says that the table is a BTDF, and a comment `# rows: samples`,
//! `# rows: nodes of a grid` or `# rows: nodes of a mirrored grid` says what the rows are. JSON files contain an object
//! with a list of numbers per column. Rows may be in any order: if they are all nodes of a grid over more than half a
//! turn, they become a grid, otherwise scattered samples.

mod angles;
mod blocks;
mod build;
mod chosen;
mod claims;
mod directions;
mod facts;
mod grid;
#[cfg(feature = "json")]
mod json;
#[cfg(not(feature = "json"))]
#[path = "goniometer/json_left_out.rs"]
mod json;
mod layout;
mod meaning;
mod names;
mod plane;
mod quantities;
mod raw;
mod rows;
mod samples;
mod sheet;
mod source;
mod start;
mod stated;
mod table;
mod trouble;
mod unit;
mod words;
mod write;

use std::path::Path;

use lobe_table::{Channels, Data, specular};

pub use crate::angle::{Angle, Unit};
pub use write::write;

use crate::reading::ReadOptions;
use crate::spec::{FormatSpec, Writer, commented, either, unfit};
use crate::text::has_words;
use crate::{Document, FormatError, Place, plain};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "table with named columns",
    word: "csv",
    extensions: &["csv", "json", "txt", "tsv", "dat"],
    matches,
    read: Some(read_with),
    read_set: None,
    writer: Some(Writer {
        extensions: &["csv"],
        holds_channels: |channels| !matches!(channels, Channels::Named(_)),
        channels: "one channel, R G B, X Y Z or wavelengths",
        holds: |document| matches!(document.only(), Some(Data::Specular(_) | Data::Spherical(_) | Data::Scattered(_))),
        holds_sheets: false,
        scatter: either,
        resampled_as: Ok(specular::KIND),
        write: |document, path| match document.only() {
            Some(data) => commented("#", document, path, |path| write(data, path)),
            None => Err(unfit(document, path, "one measurement")),
        },
    }),
};

/// The names of the angles in written files.
const SPHERICAL: [&str; 4] = ["theta_i", "phi_i", "theta_o", "phi_o"];
const SPECULAR: [&str; 4] = ["sigma", "psi", "theta", "phi"];

/// The comment, before the names, that distinguishes a BTDF from a BRDF.
const TRANSMISSION: &str = "scatter: transmission";

/// The beginning of the comment, before the names, that says what the rows are.
const ROWS: &str = "rows";

/// The kind of the rows of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rows {
    /// All nodes of a grid, of any range.
    Grid,
    /// All nodes of a grid that is one half of an isotropic material.
    MirroredGrid,
    /// Samples, even if their directions are those of a grid.
    Samples,
}

impl Rows {
    const ALL: [Rows; 3] = [Rows::Grid, Rows::MirroredGrid, Rows::Samples];

    /// Its form in a comment.
    fn word(self) -> &'static str {
        match self {
            Rows::Grid => "nodes of a grid",
            Rows::MirroredGrid => "nodes of a mirrored grid",
            Rows::Samples => "samples",
        }
    }
}

/// The length of the beginning of a file that is enough to recognise it, if it has a few lines.
const HEAD: usize = 1 << 16;

/// The beginning of a text that is enough to recognise it. Names of thousands of columns are longer than that of others.
fn beginning(bytes: &[u8]) -> &[u8] {
    /// More than the line of names and a row; a line may end in two characters.
    const ENDS: usize = 8;
    let ends = bytes.iter().enumerate().filter(|(_, byte)| matches!(byte, b'\n' | b'\r'));
    let few = ends.take(ENDS).nth(ENDS - 1).map_or(bytes.len(), |(at, _)| at + 1);
    &bytes[..bytes.len().min(HEAD.max(few))]
}

/// `true` for a text with names of angle columns and rows of numbers, and for such JSON.
pub fn matches(bytes: &[u8]) -> bool {
    let bytes = plain::text(bytes);
    let head = plain::decoded(beginning(&bytes));
    match head.trim_start().starts_with('{') {
        true => json::matches(&plain::decoded(&bytes[..bytes.len().min(HEAD)])),
        // `def` opens the values in files of Integra, whose lists of angles look like columns.
        false => !head.contains('\0') && !has_words(head.as_bytes(), ";;", &["def"]) && table::is_named_table(&head),
    }
}

/// `true` for a text with rows of numbers, whatever is above them: a table whose contents options have to describe.
pub fn may_be(bytes: &[u8]) -> bool {
    let bytes = plain::text(bytes);
    let head = plain::decoded(beginning(&bytes));
    !head.contains('\0') && table::has_rows(&head)
}

/// Reads a table that needs no options. If it holds both reflection and transmission, it is not a single table but a
/// sheet, which only [`read_with`] reads.
///
/// # Errors
/// See [`read_with`].
pub fn read(bytes: &[u8], file: &Path) -> Result<Data, FormatError> {
    let document = read_with(bytes, file, &ReadOptions::default())?;
    let part = document.parts.into_iter().next().map(|part| part.data);
    part.ok_or_else(|| FormatError::new(file, Place::File, "no rows", "at least one"))
}

/// Reads a table: a grid if all of its nodes are present, otherwise scattered samples, without those in specular
/// coordinates that are below the horizon. `file` is only its name in errors. [`ReadOptions::scale`] is not applied
/// here.
///
/// # Errors
/// [`FormatError`] with the line, or the column of JSON: columns with unclear contents, channels that are neither
/// colours nor wavelengths nor a single one, rows of another length, words that are not finite numbers, angles that may
/// be degrees or radians.
pub fn read_with(bytes: &[u8], file: &Path, options: &ReadOptions) -> Result<Document, FormatError> {
    let bytes = plain::text(bytes);
    let raw = match bytes.trim_ascii_start().starts_with(b"{") {
        true => json::read(&bytes, file, options)?,
        false => table::read(&plain::decoded(&bytes), file, options)?,
    };
    build::document(raw, file, options)
}
