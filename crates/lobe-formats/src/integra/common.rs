//! Code shared by DDR, DDT, SDR and SDT files: comments, the colour model, and blocks of values by channel name.

use std::collections::HashSet;
use std::path::Path;

use lobe_table::{Channels, Scatter};

use crate::text::{Text, Token, nine_digits};
use crate::{FormatError, Place};

/// The beginning of a comment.
pub(crate) const COMMENT: &str = ";;";

const RGB: [[&str; 2]; 3] = [["red", "red"], ["gre", "green"], ["blu", "blue"]];

/// `TypeColorModel`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ColorModel {
    Mono,
    Rgb,
    Spectral(usize),
}

impl ColorModel {
    /// Reads the value of `TypeColorModel`.
    pub fn read(text: &mut Text<'_>) -> Result<Self, FormatError> {
        const EXPECTED: &str = "a colour model: RGB, BW, or spectral and a count";
        let token = text.expect(EXPECTED)?;
        if token.is("RGB") {
            Ok(ColorModel::Rgb)
        } else if token.is("BW") {
            Ok(ColorModel::Mono)
        } else if token.is("spectral") {
            Ok(ColorModel::Spectral(text.count("wavelengths")?))
        } else {
            Err(text.unexpected(token, EXPECTED))
        }
    }

    pub fn count(self) -> usize {
        match self {
            ColorModel::Mono => 1,
            ColorModel::Rgb => 3,
            ColorModel::Spectral(count) => count,
        }
    }

    /// The value of `TypeColorModel`.
    pub fn keyword(self) -> String {
        match self {
            ColorModel::Mono => "BW".into(),
            ColorModel::Rgb => "RGB".into(),
            ColorModel::Spectral(count) => format!("spectral {count}"),
        }
    }
}

/// `true` for the first word of a block, which ends the header.
pub(crate) fn starts_block(token: Token<'_>) -> bool {
    ["wl", "bw"].iter().chain(RGB.iter().flatten()).any(|name| token.is(name))
}

/// Collects blocks in any order: each channel exactly once.
pub(crate) struct Blocks {
    model: ColorModel,
    wavelengths: Vec<f64>,
    seen: HashSet<u64>,
    values: Vec<Option<Vec<f32>>>,
}

impl Blocks {
    /// No block yet. The rest of the file must have room for at least one value in each block.
    pub fn new(model: ColorModel, text: &Text<'_>) -> Result<Self, FormatError> {
        text.room(Some(model.count()), "blocks", text.line())?;
        Ok(Blocks { model, wavelengths: Vec::new(), seen: HashSet::new(), values: vec![None; model.count()] })
    }

    /// Reads the name of a block, with the wavelength of a spectral one, and returns its channel.
    pub fn read_name(&mut self, text: &mut Text<'_>) -> Result<usize, FormatError> {
        let missing: Vec<&str> =
            (0..self.values.len().min(3)).filter(|&c| self.values[c].is_none()).map(|c| self.name(c)).collect();
        let expected = format!("a block `{}`", missing.first().unwrap_or(&"wl"));
        let token = text.expect(&expected)?;
        let channel = match self.model {
            ColorModel::Mono => token.is("bw").then_some(0),
            ColorModel::Rgb => RGB.iter().position(|names| names.iter().any(|name| token.is(name))),
            ColorModel::Spectral(_) => token.is("wl").then_some(self.wavelengths.len()),
        };
        let channel = channel.ok_or_else(|| text.unexpected(token, &*expected))?;
        if let ColorModel::Spectral(_) = self.model {
            let wavelength = text.number("a wavelength in nm")?;
            if wavelength <= 0.0 {
                return Err(text.error(text.line(), wavelength.to_string(), "a wavelength in nm, above 0"));
            }
            if !self.seen.insert(wavelength.to_bits()) {
                return Err(text.error(
                    text.line(),
                    format!("a second block for {wavelength} nm"),
                    "one per wavelength",
                ));
            }
            self.wavelengths.push(wavelength);
        }
        if self.values[channel].is_some() {
            return Err(text.unexpected(token, &*expected));
        }
        Ok(channel)
    }

    fn name(&self, channel: usize) -> &'static str {
        match self.model {
            ColorModel::Mono => "bw",
            ColorModel::Rgb => RGB[channel][0],
            ColorModel::Spectral(_) => "wl",
        }
    }

    /// Stores the values of a channel.
    pub fn keep(&mut self, channel: usize, values: Vec<f32>) {
        self.values[channel] = Some(values);
    }

    /// The channels and their values, after as many blocks as the model has channels.
    pub fn finish(self) -> (Channels, Vec<Vec<f32>>) {
        let channels = match self.model {
            ColorModel::Mono => Channels::Mono,
            ColorModel::Rgb => Channels::Rgb,
            ColorModel::Spectral(_) => Channels::Spectral(self.wavelengths),
        };
        (channels, self.values.into_iter().flatten().collect())
    }
}

/// The colour model to write, and the first line of each block.
pub(crate) fn block_names(file: &Path, channels: &Channels) -> Result<(ColorModel, Vec<String>), FormatError> {
    match channels {
        Channels::Mono => Ok((ColorModel::Mono, vec!["bw".into()])),
        Channels::Rgb => Ok((ColorModel::Rgb, RGB.map(|names| names[0].to_string()).into())),
        Channels::Spectral(wavelengths) => {
            let names = wavelengths.iter().map(|&nm| format!("wl {}", nine_digits(nm))).collect();
            Ok((ColorModel::Spectral(wavelengths.len()), names))
        }
        Channels::Xyz | Channels::Named(_) => {
            let found = format!("the channels {}", channels.names().join(" "));
            Err(FormatError::new(file, Place::File, found, "one channel, RGB or wavelengths in this format"))
        }
    }
}

/// Adds the comments read so far to the header facts, except for rulers.
pub(crate) fn keep_comments(text: &mut Text<'_>, source: &mut Vec<(String, String)>) {
    let worded = |comment: &String| comment.chars().any(char::is_alphanumeric);
    source.extend(text.take_comments().into_iter().filter(worded).map(|comment| ("comment".to_string(), comment)));
}

/// Integra's extensions: a `t` at the end is transmission.
pub(super) fn scatter_of_extension(path: &Path) -> Scatter {
    let is = |extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
    if is("ddt") || is("sdt") { Scatter::Transmission } else { Scatter::Reflection }
}

/// In this family, only the extension distinguishes reflection and transmission, so misleading ones are refused.
pub(super) fn check_extension(path: &Path, scatter: Scatter, names: [&str; 2]) -> Result<(), FormatError> {
    if scatter_of_extension(path) == scatter {
        return Ok(());
    }
    let (what, name) = match scatter {
        Scatter::Reflection => ("reflection", names[0]),
        Scatter::Transmission => ("transmission", names[1]),
    };
    Err(FormatError::new(
        path,
        Place::File,
        format!("{what} data for this extension"),
        format!("the extension .{name}"),
    ))
}

/// The channels that these files may have.
pub(super) fn holds_channels(channels: &Channels) -> bool {
    matches!(channels, Channels::Mono | Channels::Rgb | Channels::Spectral(_))
}

/// The channels, described for people.
pub(super) const CHANNELS: &str = "one channel, R G B or wavelengths";
