//! The lines before `DataBegin`.

use lobe_table::Channels;

use crate::FormatError;
use crate::text::{Text, Token};

/// The contents of the head of a file.
pub(super) struct Head {
    /// In degrees, in the order of the columns.
    pub azimuths: Vec<f64>,
    /// In degrees, in the order of the rows.
    pub radials: Vec<f64>,
    /// `Xyz`, or `Mono` for one table per wavelength.
    pub channels: Channels,
    /// Half of the azimuths are the mirror image of the other half.
    pub is_symmetric: bool,
    /// Lines and comments for people.
    pub source: Vec<(String, String)>,
}

/// Reads up to `DataBegin`.
pub(super) fn read(text: &mut Text<'_>) -> Result<Head, FormatError> {
    let mut head = Head {
        azimuths: Vec::new(),
        radials: Vec::new(),
        channels: Channels::Mono,
        is_symmetric: false,
        source: Vec::new(),
    };
    loop {
        let key = text.expect("`DataBegin`")?;
        keep_comments(text, &mut head.source);
        if key.is("Symmetry") {
            head.is_symmetric = symmetry(text)?;
        } else if key.is("SpectralContent") {
            let value = text.expect("a spectral content")?;
            head.channels = match () {
                () if value.is("Monochrome") => Channels::Mono,
                () if value.is("XYZ") => Channels::Xyz,
                () => return Err(text.unexpected(value, "Monochrome or XYZ")),
            };
        } else if key.is("ScatterAzimuth") {
            head.azimuths = angles(text, "azimuths", 360.0)?;
        } else if key.is("ScatterRadial") {
            head.radials = angles(text, "radial angles", 90.0)?;
        } else if key.is("DataBegin") {
            break;
        } else {
            let fact = fact(text, key, "a keyword of the head, or `DataBegin`")?;
            head.source.push(fact);
        }
    }
    if head.azimuths.is_empty() || head.radials.is_empty() {
        return Err(text.error(text.line(), "`DataBegin`", "ScatterAzimuth and ScatterRadial first"));
    }
    Ok(head)
}

/// `true` if half of the azimuths are the mirror image of the other half.
fn symmetry(text: &mut Text<'_>) -> Result<bool, FormatError> {
    let value = text.expect("a symmetry")?;
    let is_symmetric = ["PlaneSymmetrical", "PlaneSymmetric"].iter().any(|word| value.is(word));
    let names = ["Asymmetric", "Asymmetrical", "Asymmetric4D", "Asymmetrical4D"];
    if !is_symmetric && !names.iter().any(|word| value.is(word)) {
        return Err(text.unexpected(value, "PlaneSymmetrical or Asymmetric"));
    }
    if text.peek().is_some_and(|next| next.line == value.line && next.is("4D")) {
        text.next();
    }
    Ok(is_symmetric)
}

fn angles(text: &mut Text<'_>, what: &str, limit: f64) -> Result<Vec<f64>, FormatError> {
    let count = text.count(what)?;
    let mut angles = Vec::with_capacity(count);
    for _ in 0..count {
        let angle = text.number("an angle in degrees")?;
        if !(0.0..=limit).contains(&angle) {
            return Err(text.error(text.line(), format!("{angle} of the {what}"), format!("0 to {limit} degrees")));
        }
        angles.push(angle);
    }
    Ok(angles)
}

/// The line of an unknown word, as a name and a value. A number is not a word: it means that a list is longer than its
/// count.
pub(super) fn fact(text: &mut Text<'_>, key: Token<'_>, expected: &str) -> Result<(String, String), FormatError> {
    if key.is_number() {
        return Err(text.unexpected(key, expected));
    }
    let line = format!("{}{}", key.text(), text.raw_rest_of_line());
    let colon = line.char_indices().find(|&(at, c)| c == ':' && line[at + 1..].starts_with(char::is_whitespace));
    let (name, value) = match (colon, line.split_once(char::is_whitespace)) {
        (Some((at, _)), _) => (&line[..at], &line[at + 1..]),
        (None, Some((name, value))) => (name, value),
        (None, None) => (line.trim_end_matches(':'), ""),
    };
    Ok((name.trim().into(), value.trim().into()))
}

/// The comments read so far are also facts.
pub(super) fn keep_comments(text: &mut Text<'_>, source: &mut Vec<(String, String)>) {
    let comments = text.take_comments().into_iter().filter(|comment| !comment.is_empty());
    source.extend(comments.map(|comment| ("comment".into(), comment)));
}
