//! From the channels of a material to those of a format: a linear map.

use lobe::Channels;
use lobe_colour::{RGB_TO_XYZ, WHITE, XYZ_TO_RGB};
use lobe_model::Surface;

use crate::failure::Failure;
use crate::target::Target;

/// A linear map of channels.
pub struct ChannelMap {
    /// The channels of its result.
    pub channels: Channels,
    /// A note about it for the user; `None` if it changes nothing.
    pub note: Option<String>,
    /// A row for each resulting channel.
    rows: Vec<Vec<f64>>,
}

impl ChannelMap {
    /// The map from these channels, or from a chosen one of them, to those of a format.
    pub fn new(from: &Channels, chosen: Option<&str>, target: Target) -> Result<Self, Failure> {
        let count = from.count();
        let unit = |index: usize| (0..count).map(|i| if i == index { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let mut map = ChannelMap { channels: from.clone(), note: None, rows: (0..count).map(unit).collect() };
        let names = from.names();
        if let Some(name) = chosen {
            let index = names.iter().position(|known| known.eq_ignore_ascii_case(name)).ok_or_else(|| {
                Failure::Usage(format!("found no channel {name}; expected one of {}", names.join(", ")))
            })?;
            map = ChannelMap {
                channels: Channels::Mono,
                note: Some(format!("{} only", names[index])),
                rows: vec![unit(index)],
            };
        }
        if let Channels::Named(names) = &map.channels
            && names.len() == 1
            && !target.holds(&map.channels)
        {
            map.channels = Channels::Mono;
        }
        if target.holds(&map.channels) {
            return Ok(map.with_white_of(target));
        }
        let (channels, matrix, note): (_, Vec<&[f64]>, _) = match map.channels {
            Channels::Mono if target.holds(&Channels::Rgb) => {
                (Channels::Rgb, vec![&[1.0][..]; 3], "one channel as equal R, G and B")
            }
            Channels::Rgb if target.holds(&Channels::Xyz) => (
                Channels::Xyz,
                RGB_TO_XYZ.iter().map(|row| &row[..]).collect(),
                "R G B, taken to be linear sRGB, as X Y Z",
            ),
            Channels::Xyz if target.holds(&Channels::Rgb) => {
                (Channels::Rgb, XYZ_TO_RGB.iter().map(|row| &row[..]).collect(), "X Y Z as linear sRGB")
            }
            other => {
                let (found, expected) = (other.names().join(" "), target.channels());
                let message = format!("{target}: found the channels {found}; expected {expected} (or --channel NAME)");
                return Err(Failure::Usage(message));
            }
        };
        let product = |row: &&[f64]| {
            (0..count)
                .map(|i| row.iter().zip(&map.rows).map(|(weight, from)| weight * from[i]).sum::<f64>())
                .collect::<Vec<f64>>()
        };
        let note = map.note.iter().map(String::as_str).chain([note]).collect::<Vec<_>>().join(", ");
        let map = ChannelMap { channels, rows: matrix.iter().map(product).collect(), note: Some(note) };
        Ok(map.with_white_of(target))
    }

    /// XYZ relative to the white that a format has: in window sheets that of equal energy, X = Y = Z.
    fn with_white_of(mut self, target: Target) -> Self {
        if target == Target::Klems && self.channels == Channels::Xyz {
            for (row, white) in self.rows.iter_mut().zip(WHITE) {
                row.iter_mut().for_each(|weight| *weight /= white);
            }
            let white = "relative to a white of X = Y = Z";
            self.note = Some(self.note.map_or_else(|| format!("X Y Z {white}"), |note| format!("{note} {white}")));
        }
        self
    }

    /// Whether nothing changes.
    pub fn is_identity(&self) -> bool {
        self.note.is_none()
    }

    /// Maps texels of the old channels to texels of the new.
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

/// A surface whose channels are mapped.
pub struct Mapped<'a> {
    /// The surface.
    pub surface: &'a dyn Surface,
    /// How its channels are mapped.
    pub map: &'a ChannelMap,
}

impl Surface for Mapped<'_> {
    fn channels(&self) -> &Channels {
        &self.map.channels
    }

    fn f(&self, wi: [f64; 3], viewers: &[[f64; 3]], out: &mut [f64]) {
        let (from, to) = (self.map.rows[0].len(), self.map.rows.len());
        let mut texels = vec![0.0; viewers.len() * from];
        self.surface.f(wi, viewers, &mut texels);
        for (out, texel) in out.chunks_exact_mut(to).zip(texels.chunks_exact(from)) {
            for (out, row) in out.iter_mut().zip(&self.map.rows) {
                *out = row.iter().zip(texel).map(|(weight, f)| weight * f).sum();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neutral_stays_neutral_in_every_format() {
        for from in [Channels::Rgb, Channels::Xyz] {
            for target in [Target::Klems, Target::Zemax, Target::Ddr] {
                let map = ChannelMap::new(&from, None, target).expect("colours");
                let grey = if from == Channels::Xyz { WHITE.map(|c| 0.5 * c as f32) } else { [0.5; 3] };
                let white = match (&map.channels, target) {
                    (Channels::Rgb, _) | (_, Target::Klems) => [1.0; 3],
                    _ => WHITE,
                };
                for (found, white) in map.apply(&grey).iter().zip(white) {
                    assert!((f64::from(*found) - 0.5 * white).abs() < 1e-6, "{found} in {target}");
                }
            }
        }
    }
}
