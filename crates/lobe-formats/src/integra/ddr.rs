//! Integra (Lumicept) DDR, a BRDF, and DDT, a BTDF, in the dialect of the libbsdf library.
//!
//! Words and numbers are separated by white space; line breaks have no meaning. A header names the symmetry, the colour
//! model, the quantity and the angles of the four axes; then each channel has a block of values, theta fastest, then
//! phi, sigma, psi. The details and the policies are in `docs/formats.md`.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use lobe_table::{Data, Scatter, specular};

use super::common::{
    Blocks, CHANNELS, COMMENT, ColorModel, block_names, check_extension, holds_channels, keep_comments,
    scatter_of_extension, starts_block,
};
use super::grid::{Axes, Grid, LIMITS, from_samples, read_angle};
use super::units::{divide_by_cosine, scale_slices};
use crate::spec::{FormatSpec, Writer, commented, unfit};
use crate::text::{Text, Token, has_words, push_row};
use crate::{FormatError, Measured, Place};
use lobe_files::write_whole;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "Integra DDR/DDT",
    word: "ddr",
    extensions: &["ddr", "ddt"],
    matches,
    read: Some(|bytes, path, _| Ok(read(bytes, path, scatter_of_extension(path))?.into())),
    read_set: None,
    writer: Some(Writer {
        extensions: &["ddr", "ddt"],
        holds_channels,
        channels: CHANNELS,
        holds: |document| matches!(document.only(), Some(Data::Specular(_))),
        holds_sheets: false,
        scatter: |path| Some(scatter_of_extension(path)),
        resampled_as: Ok(specular::KIND),
        write: |document, path| match document.only() {
            Some(Data::Specular(data)) => commented(COMMENT, document, path, |path| write(data, path)),
            _ => Err(unfit(document, path, "a table of specular coordinates")),
        },
    }),
};

/// The contents of the header besides its angles.
struct Header {
    grid: Grid,
    model: ColorModel,
    intensity: bool,
    relative: bool,
    sigmat: Option<Vec<f32>>,
    source: Vec<(String, String)>,
}

/// Reads a file from its content. The content does not say whether it is reflection (`.ddr`) or transmission (`.ddt`).
///
/// # Errors
/// [`FormatError`] names the line, what was found and what was expected.
pub fn read(bytes: &[u8], file: &Path, scatter: Scatter) -> Result<Measured<specular::Data>, FormatError> {
    let text = &mut Text::new(file, bytes, COMMENT);
    let header = read_header(text)?;
    let grid = &header.grid;
    let zeniths: Vec<f64> =
        header.sigmat.as_ref().unwrap_or(&grid.degrees[0]).iter().map(|&angle| f64::from(angle).to_radians()).collect();

    let mut blocks = Blocks::new(header.model, text)?;
    let mut targets = vec![Vec::new(); header.model.count()];
    for _ in 0..header.model.count() {
        let channel = blocks.read_name(text)?;
        let line = text.line();
        let kbdf = read_kbdf(text, &header)?;
        let mut block = read_block(text, grid)?;
        if header.intensity {
            divide_by_cosine(grid, &zeniths, &mut block);
        }
        let unit = if header.intensity { 1.0 } else { PI };
        let slice_len = grid.block_len() / grid.incidences();
        let mut values = Vec::with_capacity(block.len());
        for (slice, &factor) in block.chunks_exact(slice_len).zip(&kbdf) {
            let factor = if header.relative { 1.0 } else { factor };
            values.extend(slice.iter().map(|value| (value * factor / unit) as f32));
        }
        if let Some(bad) = values.iter().find(|value| !value.is_finite()) {
            return Err(text.error(line, format!("a value that becomes {bad} with its kbdf"), "one that f32 can hold"));
        }
        blocks.keep(channel, values);
        targets[channel] = kbdf;
    }
    text.end("nothing after the last block")?;

    let (channels, blocks) = blocks.finish();
    let mut data = grid.samples(file, scatter, channels, &blocks)?;
    if header.sigmat.is_some() {
        let offsets = zeniths.iter().zip(&data.knots()[0]).map(|(zenith, sigma)| zenith - sigma).collect();
        data = data.with_refraction(offsets).map_err(|error| from_samples(file, &error))?;
    }
    if header.relative {
        data = scale_slices(file, &data, &targets, "kbdf")?;
    }
    Ok(Measured { data, source: header.source, tis: Vec::new() })
}

fn read_header(text: &mut Text<'_>) -> Result<Header, FormatError> {
    let mut source = Vec::new();
    let mut axes = Axes::new(["sigma", "psi", "theta", "phi"]);
    // Defaults are those of the programs of this family.
    let (mut mirrored, mut intensity, mut relative) = (true, false, false);
    let mut model = ColorModel::Rgb;
    let mut sigmat = None;
    while let Some(token) = text.peek().filter(|&token| !starts_block(token)) {
        text.next();
        keep_comments(text, &mut source);
        if let Some(axis) = axes.find(token) {
            axes.read(axis, text)?;
        } else if token.is("sigmat") {
            sigmat = Some(read_sigmat(text, token, axes.sigma().len())?);
        } else if token.is("TypeSym") {
            let symmetry = read_symmetry(text)?;
            mirrored = symmetry == "PlaneSymmetrical";
            source.push(("TypeSym".into(), symmetry.into()));
        } else if token.is("TypeColorModel") {
            model = ColorModel::read(text)?;
            source.push(("TypeColorModel".into(), model.keyword()));
        } else if token.is("TypeData") {
            let quantity = read_one_of(text, ["Luminance", "Intensity"])?;
            let scale = read_one_of(text, ["Absolute", "Relative"])?;
            (intensity, relative) = (quantity == "Intensity", scale == "Relative");
            source.push(("TypeData".into(), format!("{quantity} {scale}")));
        } else {
            let known = |next: Token<'_>| {
                let words = ["sigmat", "TypeSym", "TypeColorModel", "TypeData", "Source"];
                starts_block(next) || axes.find(next).is_some() || words.iter().any(|word| next.is(word))
            };
            source.push((token.text().into(), text.rest_of_line(token, known)));
        }
    }
    let grid = axes.finish(text, mirrored)?;
    Ok(Header { grid, model, intensity, relative, sigmat, source })
}

fn read_one_of<const N: usize>(text: &mut Text<'_>, words: [&'static str; N]) -> Result<&'static str, FormatError> {
    let expected = words.join(" or ");
    let token = text.expect(&expected)?;
    words.into_iter().find(|word| token.is(word)).ok_or_else(|| text.unexpected(token, expected))
}

/// Only the plane symmetry changes how the values are read; the others repeat what the lists of angles show.
fn read_symmetry(text: &mut Text<'_>) -> Result<&'static str, FormatError> {
    let words = ["PlaneSymmetrical", "AxiSymmetrical", "DirSymmetrical", "ASymmetrical", "ASymmetrical4D"];
    let word = read_one_of(text, words)?;
    if word == "ASymmetrical" && text.peek().is_some_and(|next| next.is("4D")) {
        text.next();
        return Ok("ASymmetrical 4D");
    }
    Ok(if word == "ASymmetrical4D" { "ASymmetrical 4D" } else { word })
}

/// The polar angles of the refracted light, one per sigma and without a count.
fn read_sigmat(text: &mut Text<'_>, token: Token<'_>, sigmas: usize) -> Result<Vec<f32>, FormatError> {
    if sigmas == 0 {
        return Err(text.unexpected(token, "`sigma` and its angles before `sigmat`"));
    }
    (0..sigmas).map(|_| read_angle(text, "sigmat", LIMITS[0])).collect()
}

/// The factors of the slices, `[psi][sigma]`: 1 if an absolute block has none.
fn read_kbdf(text: &mut Text<'_>, header: &Header) -> Result<Vec<f64>, FormatError> {
    let count = header.grid.incidences();
    match text.peek() {
        Some(token) if token.is("kbdf") => {
            text.next();
            (0..count).map(|_| text.number("a kbdf factor")).collect()
        }
        Some(token) if header.relative => Err(text.unexpected(token, "`kbdf`, the reflectances of relative values")),
        _ => Ok(vec![1.0; count]),
    }
}

fn read_block(text: &mut Text<'_>, grid: &Grid) -> Result<Vec<f64>, FormatError> {
    let line = text.keyword("def")?.line;
    let count = grid.block_len();
    text.room(Some(count), "values", line)?;
    let block = (0..count).map(|_| text.number("a value")).collect::<Result<_, _>>()?;
    text.keyword("enddef")?;
    Ok(block)
}

/// Writes `path` whole or not at all: `Luminance Absolute` over the full circle of phi with every kbdf equal to 1, and
/// `sigmat` if the table has refraction offsets.
///
/// Values have nine significant digits and are restored exactly when they are read again. The format stores angles as
/// `f32` degrees: knots that came from such a file are restored exactly, others within 2e-5 degrees.
///
/// # Errors
/// [`FormatError`] if the file cannot be written, the channels are XYZ, two knots are equal in `f32` degrees, or the
/// extension (`.ddr` for reflection, `.ddt` for transmission) would make readers assume the other scatter.
pub fn write(samples: &specular::Data, path: &Path) -> Result<(), FormatError> {
    write_whole(path, text(samples, path)?.as_bytes())
}

/// The content that [`write()`] writes.
///
/// # Errors
/// The same as for [`write()`] to `path`.
pub fn text(samples: &specular::Data, path: &Path) -> Result<String, FormatError> {
    check_extension(path, samples.scatter(), ["ddr", "ddt"])?;
    let (model, names) = block_names(path, samples.channels())?;
    let degrees =
        samples.knots().each_ref().map(|knots| knots.iter().map(|a| a.to_degrees() as f32).collect::<Vec<_>>());
    if degrees.iter().any(|list| list.windows(2).any(|pair| pair[0] >= pair[1])) {
        return Err(FormatError::new(path, Place::File, "knots that are equal in f32 degrees", "distinct ones"));
    }
    let symmetry = if samples.is_isotropic() { "ASymmetrical" } else { "ASymmetrical 4D" };
    let mut out = format!("TypeSym {symmetry}\nTypeColorModel {}\nTypeData Luminance Absolute\n", model.keyword());
    for (axis, keyword) in [(1, "psi"), (0, "sigma"), (3, "phi"), (2, "theta")] {
        let _ = writeln!(out, "{keyword} {}", degrees[axis].len());
        push_row(&mut out, degrees[axis].iter().map(|&angle| f64::from(angle)));
        if let (0, Some(offsets)) = (axis, samples.refraction()) {
            out.push_str("sigmat\n");
            let zeniths = samples.knots()[0].iter().zip(offsets).map(|(sigma, offset)| (sigma + offset).to_degrees());
            push_row(&mut out, zeniths.map(|zenith| f64::from(zenith.clamp(0.0, 90.0) as f32)));
        }
    }
    let [sigmas, psis, thetas, phis] = samples.knots().each_ref().map(Vec::len);
    for (channel, name) in names.iter().enumerate() {
        let _ = writeln!(out, "{name}\n kbdf");
        for _ in 0..psis {
            push_row(&mut out, std::iter::repeat_n(1.0, sigmas));
        }
        out.push_str(" def\n");
        for p in 0..psis {
            for s in 0..sigmas {
                for h in 0..phis {
                    push_row(&mut out, (0..thetas).map(|t| f64::from(samples.texel([s, p, t, h])[channel]) * PI));
                }
            }
        }
        out.push_str(" enddef\n");
    }
    Ok(out)
}

fn matches(bytes: &[u8]) -> bool {
    let has = |words: &[&str]| has_words(bytes, COMMENT, words);
    has(&["TypeSym"]) || has(&["kbdf"]) || has(&["TypeData"]) || has(&["sigma", "theta", "phi"])
}
