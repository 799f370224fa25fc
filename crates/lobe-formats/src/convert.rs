//! Writing a document in another format: unchanged, or with its channels mapped. Nothing is resampled.

use std::path::Path;

use lobe_colour::{RGB_TO_XYZ, WHITE, XYZ_TO_RGB};
use lobe_table::window::{self, klems};
use lobe_table::{Channels, Data};
use thiserror::Error;

use crate::averages::averages;
use crate::{Document, Format, FormatError, Place};

/// A document could not be written.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ConvertError {
    /// The format does not support these channels.
    #[error("{0}")]
    Channels(String),
    /// The file cannot be written, or the document does not fit.
    #[error(transparent)]
    Write(#[from] FormatError),
}

/// The wavelengths in nm, the ends of the visible range, at which a single channel is written, with equal values, in
/// formats that have nothing but wavelengths.
pub const ENDS: [f64; 2] = [360.0, 830.0];

/// A linear map of channels.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelMap {
    /// The resulting channels.
    pub channels: Channels,
    /// A description for the user; `None` if it changes nothing.
    pub note: Option<String>,
    /// One row per resulting channel: the weights of the old channels.
    pub rows: Vec<Vec<f64>>,
}

impl ChannelMap {
    /// The map from these channels, or from a chosen one, to a format.
    ///
    /// # Errors
    /// [`ConvertError::Channels`] if there is no such channel, or the format does not support these channels.
    pub fn new(from: &Channels, chosen: Option<&str>, format: Format) -> Result<Self, ConvertError> {
        let writer = format.writer().ok_or_else(|| ConvertError::Channels(format!("{format}: it is only read")))?;
        let (holds, count) = (writer.holds_channels, from.count());
        let unit = |index: usize| (0..count).map(|i| if i == index { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let mut map = ChannelMap { channels: from.clone(), note: None, rows: (0..count).map(unit).collect() };
        let names = from.names();
        if let Some(name) = chosen {
            let index = names.iter().position(|known| known.eq_ignore_ascii_case(name)).ok_or_else(|| {
                ConvertError::Channels(format!("found no channel {name}; expected one of {}", names.join(", ")))
            })?;
            // A band keeps its name where the format has names. Other channels become the visible band of a sheet.
            let band = Channels::Named(vec![names[index].clone()]);
            let keeps_name = matches!(from, Channels::Named(_)) && holds(&band);
            let band_of_sheet = if is_of_window(format) && !keeps_name { ", as the band Visible" } else { "" };
            map = ChannelMap {
                channels: if keeps_name { band } else { Channels::Mono },
                note: Some(format!("{} only{band_of_sheet}", names[index])),
                rows: vec![unit(index)],
            };
        }
        if let Channels::Spectral(wavelengths) = &map.channels
            && is_of_window(format)
            && let Some(averages) = averages(wavelengths)
        {
            let channels = Channels::Named(averages.names);
            return Ok(ChannelMap { channels, note: Some(averages.note), rows: averages.rows });
        }
        if let Channels::Named(names) = &map.channels
            && names.len() == 1
            && !holds(&map.channels)
        {
            map.channels = Channels::Mono;
        }
        if holds(&map.channels) {
            return Ok(map.with_white_of(format));
        }
        let (channels, matrix, note): (_, Vec<&[f64]>, _) = match map.channels {
            Channels::Mono if holds(&Channels::Rgb) => {
                (Channels::Rgb, vec![&[1.0][..]; 3], "one channel as equal R, G and B")
            }
            // The format has only wavelengths: writes the ends of the visible range, and so every wavelength between.
            Channels::Mono if holds(&Channels::Spectral(ENDS.into())) => {
                (Channels::Spectral(ENDS.into()), vec![&[1.0][..]; 2], "one channel as equal values at 360 and 830 nm")
            }
            Channels::Rgb if holds(&Channels::Xyz) => (
                Channels::Xyz,
                RGB_TO_XYZ.iter().map(|row| &row[..]).collect(),
                "R G B, assumed to be linear sRGB, as X Y Z",
            ),
            Channels::Xyz if holds(&Channels::Rgb) => {
                (Channels::Rgb, XYZ_TO_RGB.iter().map(|row| &row[..]).collect(), "X Y Z as linear sRGB")
            }
            other => {
                let (found, expected) = (other.names().join(" "), writer.channels);
                let message = format!("{format}: found the channels {found}; expected {expected} (or --channel NAME)");
                return Err(ConvertError::Channels(message));
            }
        };
        let product = |row: &&[f64]| {
            (0..count)
                .map(|i| row.iter().zip(&map.rows).map(|(weight, from)| weight * from[i]).sum::<f64>())
                .collect::<Vec<f64>>()
        };
        let note = map.note.iter().map(String::as_str).chain([note]).collect::<Vec<_>>().join(", ");
        let map = ChannelMap { channels, rows: matrix.iter().map(product).collect(), note: Some(note) };
        Ok(map.with_white_of(format))
    }

    /// XYZ relative to the white of a format: in window sheets, equal energy, X = Y = Z.
    fn with_white_of(mut self, format: Format) -> Self {
        if is_of_window(format) && self.channels == Channels::Xyz {
            for (row, white) in self.rows.iter_mut().zip(WHITE) {
                row.iter_mut().for_each(|weight| *weight /= white);
            }
            let white = "relative to a white of X = Y = Z";
            self.note = Some(self.note.map_or_else(|| format!("X Y Z {white}"), |note| format!("{note} {white}")));
        }
        self
    }

    /// `true` if nothing changes.
    pub fn is_identity(&self) -> bool {
        self.note.is_none()
    }

    /// Maps texels of the old channels to texels of the new ones.
    pub fn apply(&self, texels: &[f32]) -> Vec<f32> {
        if self.is_identity() {
            return texels.to_vec();
        }
        let mut mapped = Vec::new();
        for texel in texels.chunks_exact(self.rows[0].len()) {
            let dot = |row: &Vec<f64>| row.iter().zip(texel).map(|(weight, f)| weight * f64::from(*f)).sum::<f64>();
            mapped.extend(self.rows.iter().map(|row| dot(row) as f32));
        }
        mapped
    }
}

/// `true` for files of window sheets.
fn is_of_window(format: Format) -> bool {
    format.writer().is_some_and(|writer| writer.resampled_as == Ok(klems::KIND))
}

/// A summary of the written file.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// A description of the change of channels; `None` if they are unchanged.
    pub note: Option<String>,
}

/// Writes the document if the format has its representation, whole or not at all: all of its channels, or the named
/// one. `None` if the values would have to be resampled; then nothing is written.
///
/// # Errors
/// [`ConvertError`] if the format does not support the channels, or the file cannot be written.
pub fn convert(
    document: &Document,
    format: Format,
    channel: Option<&str>,
    path: &Path,
) -> Result<Option<Written>, ConvertError> {
    let Some(writer) = format.writer().filter(|writer| (writer.holds)(document)) else { return Ok(None) };
    let Some(data) = document.only() else {
        if channel.is_some() {
            return Ok(None);
        }
        (writer.write)(document, path)?;
        return Ok(Some(Written { note: None }));
    };
    let channels = data.representation().channels();
    if channel.is_none() && (writer.holds_channels)(&channels) {
        (writer.write)(document, path)?;
        return Ok(Some(Written { note: None }));
    }
    let map = ChannelMap::new(&channels, channel, format)?;
    let Some(mapped) = mapped(data, &map, path)? else { return Ok(None) };
    (writer.write)(&Document { parts: Document::new(mapped).parts, ..document.clone() }, path)?;
    Ok(Some(Written { note: map.note }))
}

/// The same nodes with other channels, or some of the bands of a sheet; `None` if the representation does not support them.
fn mapped(data: &Data, map: &ChannelMap, path: &Path) -> Result<Option<Data>, FormatError> {
    if let (Data::Window(sheet), Channels::Named(names)) = (data, &map.channels) {
        let bands = sheet.bands.iter().filter(|band| names.contains(&band.wavelength)).cloned().collect();
        return Ok(Some(window::Data { bands }.into()));
    }
    let mut mapped = data.clone();
    let changed = mapped.representation_mut().map_channels(map.channels.clone(), &|values| map.apply(values));
    match changed {
        Ok(changed) => Ok(changed.then_some(mapped)),
        Err(error) => Err(FormatError::new(path, Place::File, error.found, error.expected)),
    }
}
