//! Zemax (Radiant Imaging) tabular `.bsdf`.
//!
//! A header of keywords, then one block per channel between `DataBegin` and `DataEnd`; in it, for each rotation of the
//! sample and each angle of incidence, a line `TIS x` and the values, radial angle fastest. `f` in 1/sr, unchanged. The
//! axes are the specular coordinates: AngleOfIncidence is sigma, SampleRotation psi, ScatterRadial theta,
//! ScatterAzimuth phi. The details and the policies are in `docs/formats.md`.

mod write;

use std::path::Path;

use lobe_table::{Channels, Data, Scatter, specular};

pub use write::write;

use crate::integra::grid::{Axes, Grid};
use crate::integra::keep_comments;
use crate::spec::{FormatSpec, Writer, commented, either, unfit};
use crate::text::{Text, Token, has_words};
use crate::{FormatError, Measured};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "Zemax BSDF",
    word: "zemax",
    extensions: &["bsdf"],
    matches: |bytes| has_words(bytes, "#", &["ScatterRadial", "AngleOfIncidence"]),
    read: Some(|bytes, path, _| Ok(read(bytes, path)?.into())),
    read_set: None,
    writer: Some(Writer {
        extensions: &["bsdf"],
        holds_channels: |channels| matches!(channels, Channels::Mono | Channels::Xyz),
        channels: "one channel or X Y Z",
        holds: |document| matches!(document.only(), Some(Data::Specular(samples)) if samples.refraction().is_none()),
        holds_sheets: false,
        scatter: either,
        resampled_as: Ok(specular::KIND),
        write: |document, path| match document.only() {
            Some(Data::Specular(data)) => commented("#", document, path, |path| write(data, path)),
            _ => Err(unfit(document, path, "a table of specular coordinates")),
        },
    }),
};

const AXES: [&str; 4] = ["AngleOfIncidence", "SampleRotation", "ScatterRadial", "ScatterAzimuth"];
const XYZ: [&str; 3] = ["TristimulusX", "TristimulusY", "TristimulusZ"];

/// The contents of the header.
struct Header {
    grid: Grid,
    scatter: Scatter,
    channels: Channels,
    source: Vec<(String, String)>,
}

/// Reads a file from its content.
///
/// # Errors
/// [`FormatError`] names the line, what was found and what was expected.
pub fn read(bytes: &[u8], file: &Path) -> Result<Measured<specular::Data>, FormatError> {
    let text = &mut Text::new(file, bytes, "#");
    let header = read_header(text)?;
    let names: &[&str] = if header.channels == Channels::Mono { &["Monochrome"] } else { &XYZ };
    text.room(header.grid.block_len().checked_mul(names.len()), "values", text.line())?;

    let mut blocks = vec![None; names.len()];
    let mut tis = vec![Vec::new(); names.len()];
    for _ in names {
        let missing = blocks.iter().position(Option::is_none).map_or("", |channel| names[channel]);
        let token = text.expect(&format!("the block `{missing}`"))?;
        let channel = names
            .iter()
            .position(|name| token.is(name))
            .filter(|&channel| blocks[channel].is_none())
            .ok_or_else(|| text.unexpected(token, format!("the block `{missing}`")))?;
        let (values, totals) = read_block(text, &header.grid)?;
        blocks[channel] = Some(values);
        tis[channel] = totals;
    }
    text.end("nothing after the last block")?;
    let blocks: Vec<Vec<f32>> = blocks.into_iter().flatten().collect();
    let data = header.grid.samples(file, header.scatter, header.channels, &blocks)?;
    Ok(Measured { data, source: header.source, tis: tis.concat() })
}

fn read_header(text: &mut Text<'_>) -> Result<Header, FormatError> {
    let mut source = Vec::new();
    let mut axes = Axes::new(AXES);
    let (mut mirrored, mut scatter, mut channels) = (None, None, None);
    let starts_block = |token: Token<'_>| token.is("Monochrome") || XYZ.iter().any(|name| token.is(name));
    while let Some(token) = text.peek().filter(|&token| !starts_block(token)) {
        text.next();
        keep_comments(text, &mut source);
        if let Some(axis) = axes.find(token) {
            axes.read(axis, text)?;
            continue;
        }
        let stated = text.rest_of_line(token, |next| axes.find(next).is_some());
        // The values of these keywords are one word, except that some writers put a space before 4D.
        let word: String = stated.split_whitespace().collect::<String>().to_ascii_lowercase();
        let unknown = |expected| Err(text.error(token.line, format!("{} `{stated}`", token.text()), expected));
        if token.is("Symmetry") {
            mirrored = Some(match word.as_str() {
                "planesymmetrical" => true,
                "asymmetrical" | "asymmetrical4d" => false,
                _ => return unknown("PlaneSymmetrical, Asymmetrical or Asymmetrical4D"),
            });
        } else if token.is("SpectralContent") {
            channels = Some(match word.as_str() {
                "monochrome" => Channels::Mono,
                "xyz" => Channels::Xyz,
                _ => return unknown("Monochrome or XYZ"),
            });
        } else if token.is("ScatterType") {
            scatter = Some(match word.as_str() {
                "brdf" => Scatter::Reflection,
                "btdf" => Scatter::Transmission,
                _ => return unknown("BRDF or BTDF"),
            });
        }
        source.push((token.text().into(), stated));
    }
    let missing = |what: &str| text.error(text.line(), "the end of the header", format!("`{what}` before the values"));
    let mirrored = mirrored.ok_or_else(|| missing("Symmetry"))?;
    let channels = channels.ok_or_else(|| missing("SpectralContent"))?;
    let scatter = scatter.ok_or_else(|| missing("ScatterType"))?;
    Ok(Header { grid: axes.finish(text, mirrored)?, scatter, channels, source })
}

/// The values of a block, `[psi][sigma][phi][theta]`, and its TIS numbers, `[psi][sigma]`.
fn read_block(text: &mut Text<'_>, grid: &Grid) -> Result<(Vec<f32>, Vec<f32>), FormatError> {
    text.keyword("DataBegin")?;
    let slice_len = grid.block_len() / grid.incidences();
    let mut values = Vec::with_capacity(grid.block_len());
    let mut tis = Vec::with_capacity(grid.incidences());
    for _ in 0..grid.incidences() {
        text.keyword("TIS")?;
        tis.push(text.value("the total integrated scatter")?);
        for _ in 0..slice_len {
            values.push(text.value("a value in 1/sr")?);
        }
    }
    text.keyword("DataEnd")?;
    Ok((values, tis))
}
