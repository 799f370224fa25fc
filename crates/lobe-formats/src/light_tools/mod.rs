//! LightTools `.bsdf`: tables on a grid in ordinary spherical coordinates, from the program itself and from
//! instruments.
//!
//! `#` comments and words. The head has `Symmetry` (`PlaneSymmetrical` or `Asymmetric`), `SpectralContent`
//! (`Monochrome` or `XYZ`), `ScatterAzimuth n ...` and `ScatterRadial n ...` in degrees, and `DataBegin`; lines that
//! start with another word are facts for people. Then follow, in any order, tables for each incident direction and
//! channel: `AOI`, `POI`, `Side`, `Wavelength` in nm, `ScatterType`, `TristimulusValue`, and `TIS t`, after which the
//! values in 1/sr follow, radial angle fastest; Last is `DataEnd`, which instruments leave out. A statement stays in
//! force until it is replaced.
//!
//! The light is at azimuth 90 + `POI` in these files; here it is at `POI`. Several wavelengths of a `Monochrome` file
//! are its channels.

mod grid;
mod head;
mod tables;
mod write;

use std::path::Path;

use lobe_table::{Channels, Data, Scatter, spherical};

use crate::spec::{FormatSpec, Writer, either};
use crate::text::{Text, has_words};
use crate::{Document, FormatError, Part};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "LightTools BSDF",
    word: "lighttools",
    extensions: &["bsdf"],
    matches,
    read: Some(|bytes, path, _| read(bytes, path)),
    read_set: None,
    writer: Some(Writer {
        extensions: &["bsdf"],
        holds_channels: |channels| matches!(channels, Channels::Mono | Channels::Xyz | Channels::Spectral(_)),
        channels: "one channel, X Y Z or wavelengths",
        holds: |document| write::grids(document).is_some(),
        holds_sheets: true,
        scatter: either,
        resampled_as: Ok(spherical::KIND),
        write: write::write,
    }),
};

/// `true` for a text with the words `ScatterRadial` and `AOI`.
pub fn matches(bytes: &[u8]) -> bool {
    has_words(bytes, "#", &["ScatterRadial", "AOI"])
}

/// Reads a file: up to four parts, and the facts of its head. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: a number in place of a word, counts for which the rest of the file is too short, a
/// second table of the same kind, a combination of incident angles and channels without a table, azimuths that leave
/// half a turn without a value, or a file without `DataEnd` that does not end after a whole table.
pub fn read(bytes: &[u8], file: &Path) -> Result<Document, FormatError> {
    let text = &mut Text::new(file, bytes, "#");
    let mut head = head::read(text)?;
    let read = tables::read(text, &head)?;
    if read.tables.is_empty() {
        return Err(text.error(text.line(), "no table", "at least one"));
    }
    // A truncated number may still be a number.
    if !read.has_end && !bytes.ends_with(b"\n") && !bytes.ends_with(b"\r") && !bytes.ends_with(b"\x1a") {
        return Err(text.error(text.line(), "the end of the file within a line", "a whole line, or `DataEnd`"));
    }
    head.source.extend(read.source);
    if !read.has_end {
        head.source.push(("DataEnd".into(), "missing".into()));
    }
    let mut parts = Vec::new();
    for ((side, is_btdf), by_incidence) in read.tables {
        let scatter = if is_btdf { Scatter::Transmission } else { Scatter::Reflection };
        let grid = grid::part(text, &head, scatter, &by_incidence)?;
        parts.push(Part { name: String::new(), side: Some(side), data: Data::Spherical(grid) });
    }
    let mut document = Document::of_parts(parts);
    document.source.extend(head.source);
    document.tis = read.tis;
    Ok(document)
}
