//! Integra SDR (mirror reflectance) and SDT (straight-through transmittance).
//!
//! The header has `TypeColorModel` and `sigma`; each block is a name, `def`, one ratio per sigma, `enddef`. Keywords
//! are read in upper or lower case, and written in the case that strict readers require.

use std::fmt::Write as _;
use std::path::Path;

use lobe_table::{Data, Scatter, mirror};

use super::common::{
    Blocks, CHANNELS, COMMENT, ColorModel, block_names, check_extension, holds_channels, keep_comments,
    scatter_of_extension, starts_block,
};
use super::grid::{LIMITS, radians, read_angles};
use crate::spec::{FormatSpec, Writer, unfit};
use crate::text::{Text, Token, has_words, push_row};
use crate::{FormatError, Measured, Place};
use lobe_files::write_whole;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "Integra SDR/SDT",
    word: "sdr",
    extensions: &["sdr", "sdt"],
    matches,
    read: Some(|bytes, path, _| Ok(read(bytes, path, scatter_of_extension(path))?.into())),
    read_set: None,
    writer: Some(Writer {
        extensions: &["sdr", "sdt"],
        holds_channels,
        channels: CHANNELS,
        holds: |document| matches!(document.only(), Some(Data::Mirror(_))),
        holds_sheets: false,
        scatter: |path| Some(scatter_of_extension(path)),
        resampled_as: Err("mirror reflectances"),
        write: |document, path| match document.only() {
            Some(Data::Mirror(data)) => write(data, path),
            _ => Err(unfit(document, path, "mirror reflectances")),
        },
    }),
};

/// Reads a file from its content. The content does not say whether it is reflection or transmission.
///
/// # Errors
/// [`FormatError`] names the line, what was found and what was expected.
pub fn read(bytes: &[u8], file: &Path, scatter: Scatter) -> Result<Measured<mirror::Data>, FormatError> {
    let text = &mut Text::new(file, bytes, COMMENT);
    let mut source = Vec::new();
    let mut model = ColorModel::Rgb;
    let mut degrees = Vec::new();
    while let Some(token) = text.peek().filter(|&token| !starts_block(token)) {
        text.next();
        keep_comments(text, &mut source);
        if token.is("TypeColorModel") {
            model = ColorModel::read(text)?;
            source.push(("TypeColorModel".into(), model.keyword()));
        } else if token.is("sigma") && degrees.is_empty() {
            degrees = read_angles(text, "sigma", LIMITS[0])?;
        } else {
            let known = |token: Token<'_>| starts_block(token) || token.is("TypeColorModel") || token.is("sigma");
            source.push((token.text().into(), text.rest_of_line(token, known)));
        }
    }
    if degrees.is_empty() {
        return Err(text.error(text.line(), "the end of the header", "`sigma` and its angles"));
    }
    let mut blocks = Blocks::new(model, text)?;
    for _ in 0..model.count() {
        let channel = blocks.read_name(text)?;
        text.keyword("def")?;
        let values: Result<_, _> = degrees.iter().map(|_| text.value("a reflectance")).collect();
        blocks.keep(channel, values?);
        text.keyword("enddef")?;
    }
    text.end("nothing after the last block")?;
    let (channels, blocks) = blocks.finish();
    let values = (0..degrees.len()).flat_map(|s| blocks.iter().map(move |block| block[s])).collect();
    let data = mirror::Data::new(scatter, [radians(&degrees), vec![0.0]], channels, values)
        .ok_or_else(|| FormatError::new(file, Place::File, "sigma angles that are equal", "distinct ones"))?;
    Ok(Measured { data, source, tis: Vec::new() })
}

/// Writes `path` whole or not at all, with nine significant digits, which restore the same values when they are read
/// again.
///
/// # Errors
/// [`FormatError`] if the file cannot be written, the channels are not one, RGB or wavelengths, there is more than one
/// psi, or the extension (`.sdr` for reflection, `.sdt` for transmission) would make readers assume the other scatter.
pub fn write(specular: &mirror::Data, path: &Path) -> Result<(), FormatError> {
    check_extension(path, specular.scatter(), ["sdr", "sdt"])?;
    let (model, names) = block_names(path, specular.channels())?;
    let [sigma, psi] = specular.knots();
    if psi.len() > 1 {
        return Err(FormatError::new(path, Place::File, format!("{} psi angles", psi.len()), "one in this format"));
    }
    let mut out = format!("TypeColorModel {}\nsigma {}\n", model.keyword(), sigma.len());
    push_row(&mut out, sigma.iter().map(|angle| f64::from(angle.to_degrees() as f32)));
    for (channel, name) in names.iter().enumerate() {
        let _ = writeln!(out, "{name}\n def");
        push_row(&mut out, specular.values().iter().skip(channel).step_by(names.len()).map(|&value| f64::from(value)));
        out.push_str(" enddef\n");
    }
    write_whole(path, out.as_bytes())
}

fn matches(bytes: &[u8]) -> bool {
    let has = |words: &[&str]| has_words(bytes, COMMENT, words);
    has(&["sigma", "def"]) || has(&["sigma", "TypeColorModel"])
}
