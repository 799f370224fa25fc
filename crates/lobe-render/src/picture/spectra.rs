//! Reads pictures of spectra and of polarised light, of any program that writes the published [layout](super::layout).

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{AnyChannel, AttributeValue, FlatSamples, Layer, ReadChannels, ReadLayers};
use lobe_colour::{LUMINANCE, Reduction};

use super::PictureError;
use super::exr_file::{ATTRIBUTE, check_size, content};
use super::layout::Name;

/// The meaning of the values of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Radiance: channels `S0.*` to `S3.*`, or `R G B`.
    Radiance,
    /// Shares of light that a surface reflects or transmits: channels `T.*`.
    Shares,
}

/// A picture of spectra, or of red, green and blue, possibly of polarised light.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralPicture {
    /// Columns and rows of the window with data.
    pub size: [usize; 2],
    /// The position of its upper left corner.
    pub origin: [i32; 2],
    /// The meaning of the values.
    pub quantity: Quantity,
    /// The wavelengths, ascending, or red, green and blue.
    pub channels: lobe::Channels,
    /// The Stokes components, each `[pixel][channel]`, with rows from the top: only S0 if light was not followed as
    /// polarised, and S0 to S2 if circular light was not.
    pub stokes: Vec<Vec<f32>>,
    /// Linear sRGB: the channels `R G B` of the file, or the colours of the spectra. Shares are seen under D65.
    pub colours: Vec<[f32; 3]>,
    /// Whether the file has the colours.
    pub has_colours: bool,
    /// The names of other channels, and of attributes with their texts.
    pub others: Vec<String>,
    /// Texts of the file, by the names of their attributes.
    pub attributes: Vec<(String, String)>,
    /// The weight of each channel in the luminance; equal weights if none is visible.
    luminance: Vec<f32>,
}

const EXPECTED: &str = "a picture with wavelengths (S0.550nm and so on), Stokes components, or R, G and B";

/// Reads an OpenEXR picture: the first layer that has spectra, or else the first with `R G B`.
///
/// # Errors
/// If the file cannot be read or is damaged, has neither spectra nor colours, describes fluorescence, has the same
/// wavelength twice, Stokes components of different wavelengths, or an incomplete set of them.
pub fn read_spectral(path: &Path) -> Result<SpectralPicture, PictureError> {
    let bytes = lobe_files::bytes(path).map_err(|error| PictureError::Io { file: path.into(), error })?;
    check_size(path, &bytes)?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(&bytes))
        .map_err(|error| content(path, error, "an OpenEXR picture of flat channels"))?;
    let list = |layer: &Layer<_>| layer_names(layer);
    let has =
        |wanted: &dyn Fn(&str) -> bool| image.layer_data.iter().position(|layer| list(layer).iter().any(|n| wanted(n)));
    let spectral =
        has(&|name| matches!(Name::of(name), Some(Name::Stokes(0, _) | Name::Colour(0, _) | Name::Share(_))));
    let Some(layer) = spectral.or_else(|| has(&|name| name == "R")).map(|at| &image.layer_data[at]) else {
        let names: Vec<String> = image.layer_data.iter().flat_map(list).collect();
        if names.iter().any(|name| Name::of(name) == Some(Name::Fluorescence)) {
            return Err(content(path, "channels of fluorescence", EXPECTED));
        }
        let found = format!("the channels {}", lobe_files::excerpt(&names.join(", "), 200));
        return Err(content(path, found, EXPECTED));
    };
    let attributes = image.attributes.other.iter().chain(&layer.attributes.other);
    let text = |(name, value): (&exr::prelude::Text, &AttributeValue)| match value {
        AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
        AttributeValue::F32(number) => Some((name.to_string(), number.to_string())),
        _ => None,
    };
    let mut attributes: Vec<(String, String)> = attributes.filter_map(text).collect();
    attributes.retain(|(name, _)| name != ATTRIBUTE);
    attributes.sort();
    let position = layer.attributes.layer_position;
    let picture = of_channels(&layer.channel_data.list, path)?;
    Ok(SpectralPicture { size: [layer.size.0, layer.size.1], origin: [position.0, position.1], attributes, ..picture })
}

fn layer_names(layer: &Layer<exr::prelude::AnyChannels<FlatSamples>>) -> Vec<String> {
    layer.channel_data.list.iter().map(|channel| channel.name.to_string()).collect()
}

/// The picture of a list of channels, without its size and attributes.
fn of_channels(list: &[AnyChannel<FlatSamples>], path: &Path) -> Result<SpectralPicture, PictureError> {
    let wrong = |found: String| Err(content(path, found, EXPECTED));
    let mut rows: [Vec<(f64, usize)>; 4] = Default::default();
    let mut colours: [[Option<usize>; 3]; 4] = Default::default();
    let (mut shares, mut plain, mut others) = (Vec::new(), [None; 3], Vec::new());
    for (index, channel) in list.iter().enumerate() {
        let name = channel.name.to_string();
        match Name::of(&name) {
            Some(Name::Stokes(component, nm)) => rows[component].push((nm, index)),
            Some(Name::Colour(component, colour)) => colours[component][colour] = Some(index),
            Some(Name::Share(nm)) => shares.push((nm, index)),
            Some(Name::Fluorescence) => others.push(name),
            None => match ["R", "G", "B"].into_iter().position(|known| known == name) {
                Some(colour) => plain[colour] = Some(index),
                None => others.push(name),
            },
        }
    }
    let all = |three: [Option<usize>; 3]| {
        let [r, g, b] = three;
        Some([r?, g?, b?])
    };
    let (mut stokes, quantity, channels) = if !rows[0].is_empty() {
        others.extend(shares.iter().map(|(_, index)| list[*index].name.to_string()));
        let wavelengths = sorted(&mut rows[0], path)?;
        let mut stokes = vec![indices(&rows[0])];
        for (component, row) in rows.iter_mut().enumerate().skip(1) {
            let found = sorted(row, path)?;
            if !found.is_empty() && found != wavelengths {
                return wrong(format!("other wavelengths of S{component} than of S0"));
            }
            stokes.push(indices(row));
        }
        (stokes, Quantity::Radiance, lobe::Channels::Spectral(wavelengths))
    } else if let Some(first) = all(colours[0]) {
        let row = |three: [Option<usize>; 3]| all(three).map_or_else(Vec::new, Vec::from);
        let rest = colours[1..].iter().map(|three| row(*three));
        (std::iter::once(first.to_vec()).chain(rest).collect(), Quantity::Radiance, lobe::Channels::Rgb)
    } else if !shares.is_empty() {
        let wavelengths = sorted(&mut shares, path)?;
        (vec![indices(&shares)], Quantity::Shares, lobe::Channels::Spectral(wavelengths))
    } else if let Some(colour) = all(plain) {
        (vec![colour.to_vec()], Quantity::Radiance, lobe::Channels::Rgb)
    } else {
        return wrong("an incomplete set of R, G and B".into());
    };
    while stokes.len() > 1 && stokes.last().is_some_and(Vec::is_empty) {
        stokes.pop();
    }
    if stokes.len() == 2 || stokes.iter().any(Vec::is_empty) {
        return wrong("Stokes components without S1 and S2".into());
    }
    let column = |index: usize| list[index].sample_data.values_as_f32().collect::<Vec<f32>>();
    let stokes: Vec<Vec<f32>> =
        stokes.iter().map(|row| interleaved(&row.iter().map(|i| column(*i)).collect::<Vec<_>>())).collect();
    let weights = weights(&channels, quantity, path)?;
    let count = weights.len();
    let colours: Vec<[f32; 3]> = match all(plain).filter(|_| quantity == Quantity::Radiance) {
        Some(rgb) => {
            let [r, g, b] = rgb.map(column);
            r.into_iter().zip(g).zip(b).map(|((r, g), b)| [r, g, b]).collect()
        }
        None => stokes[0].chunks_exact(count).map(|texel| reduced(texel, &weights)).collect(),
    };
    let luminance: Vec<f32> = weights.iter().map(|w| w.iter().zip(LUMINANCE).map(|(c, y)| c * y).sum()).collect();
    let is_dark = luminance.iter().all(|weight| *weight == 0.0);
    let luminance = if is_dark { vec![1.0 / count as f32; count] } else { luminance };
    let has_colours = all(plain).is_some();
    Ok(SpectralPicture {
        size: [0; 2],
        origin: [0; 2],
        quantity,
        channels,
        stokes,
        colours,
        has_colours,
        others,
        attributes: Vec::new(),
        luminance,
    })
}

/// Sorts channels by their wavelengths, which must differ, and returns those.
fn sorted(row: &mut [(f64, usize)], path: &Path) -> Result<Vec<f64>, PictureError> {
    row.sort_by(|a, b| a.0.total_cmp(&b.0));
    match row.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        Some(pair) => Err(content(path, format!("two channels at {} nm", pair[0].0), "one channel per wavelength")),
        None => Ok(row.iter().map(|(nm, _)| *nm).collect()),
    }
}

fn indices(row: &[(f64, usize)]) -> Vec<usize> {
    row.iter().map(|(_, index)| *index).collect()
}

/// Columns of channels as texels.
fn interleaved(columns: &[Vec<f32>]) -> Vec<f32> {
    let pixels = columns.first().map_or(0, Vec::len);
    (0..pixels).flat_map(|pixel| columns.iter().map(move |column| column[pixel])).collect()
}

/// Linear sRGB of the value 1 of each channel.
fn weights(channels: &lobe::Channels, quantity: Quantity, path: &Path) -> Result<Vec<[f32; 3]>, PictureError> {
    let narrow = |weights: &[[f64; 3]]| weights.iter().map(|w| w.map(|x| x as f32)).collect();
    match (channels, quantity) {
        (lobe::Channels::Spectral(wavelengths), Quantity::Radiance) => lobe_spectrum::colours(wavelengths)
            .map(|colours| narrow(&colours))
            .map_err(|error| content(path, error, EXPECTED)),
        _ => Ok(narrow(Reduction::for_display(channels).weights())),
    }
}

fn reduced(texel: &[f32], weights: &[[f32; 3]]) -> [f32; 3] {
    let mut colour = [0.0; 3];
    for (value, weights) in texel.iter().zip(weights) {
        colour.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += value * weight);
    }
    colour
}

impl SpectralPicture {
    /// The number of channels of a Stokes component.
    pub fn channel_count(&self) -> usize {
        self.luminance.len()
    }

    /// The luminance of a Stokes component of a pixel, or the mean of its channels if none is visible.
    ///
    /// # Panics
    /// If there is no such component or pixel.
    pub fn luminance(&self, component: usize, pixel: usize) -> f32 {
        let texel = &self.stokes[component][pixel * self.channel_count()..][..self.channel_count()];
        texel.iter().zip(&self.luminance).map(|(value, weight)| value * weight).sum()
    }

    /// The degree of linear polarisation, from 0 to 1, and the angle in radians from 0 to pi, of the luminance of each
    /// pixel. The degree is 0 where there is no light; `None` if light was not followed as polarised.
    pub fn linear_polarisation(&self) -> Option<Vec<[f32; 2]>> {
        if self.stokes.len() < 3 {
            return None;
        }
        let of = |pixel: usize| {
            let [s0, s1, s2] = [0, 1, 2].map(|component| self.luminance(component, pixel));
            let degree = if s0 > 0.0 { libm::hypotf(s1, s2) / s0 } else { 0.0 };
            let angle = 0.5 * libm::atan2f(s2, s1);
            let angle = if angle < 0.0 { angle + std::f32::consts::PI } else { angle };
            if degree.is_finite() { [degree, angle] } else { [0.0; 2] }
        };
        Some((0..self.size[0] * self.size[1]).map(of).collect())
    }

    /// The mean of S0 over all pixels, of each channel. Values that are not finite are left out.
    pub fn mean(&self) -> Vec<f64> {
        let count = self.channel_count();
        let mut sums = vec![(0.0, 0_u64); count];
        for texel in self.stokes[0].chunks_exact(count) {
            for ((sum, n), value) in sums.iter_mut().zip(texel).filter(|(_, value)| value.is_finite()) {
                (*sum, *n) = (*sum + f64::from(*value), *n + 1);
            }
        }
        sums.into_iter().map(|(sum, n)| sum / n.max(1) as f64).collect()
    }

    /// The number of values of all Stokes components that are infinite or not numbers.
    pub fn not_finite(&self) -> usize {
        self.stokes.iter().flatten().filter(|value| !value.is_finite()).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(name: &str, values: [f32; 2]) -> AnyChannel<FlatSamples> {
        AnyChannel::new(name, FlatSamples::F32(values.into()))
    }

    fn picture(list: &[AnyChannel<FlatSamples>]) -> Result<SpectralPicture, PictureError> {
        Ok(SpectralPicture { size: [2, 1], ..of_channels(list, Path::new("x.exr"))? })
    }

    #[test]
    fn wavelengths_are_sorted_and_stokes_components_belong_together() {
        let unpolarised =
            picture(&[channel("S0.600nm", [3.0, 6.0]), channel("S0.500nm", [1.0, 2.0]), channel("depth.Z", [0.0; 2])]);
        let unpolarised = unpolarised.expect("a picture");
        assert_eq!(unpolarised.channels, lobe::Channels::Spectral(vec![500.0, 600.0]));
        assert_eq!(unpolarised.stokes, [vec![1.0, 3.0, 2.0, 6.0]]);
        assert_eq!((unpolarised.linear_polarisation(), unpolarised.mean()), (None, vec![1.5, 4.5]));
        assert_eq!(unpolarised.others, ["depth.Z"]);
        // Without circular light; in the infrared, channels count equally.
        let mut list = Vec::new();
        for (component, values) in [[2.0, 0.0], [0.0, 0.0], [-1.0, 0.0]].into_iter().enumerate() {
            list.push(channel(&format!("S{component}.900nm"), values));
            list.push(channel(&format!("S{component}.1,1um"), values));
        }
        let infrared = picture(&list).expect("a picture");
        let found = infrared.linear_polarisation().expect("polarised");
        assert!((found[0][0] - 0.5).abs() < 1e-6 && (found[0][1].to_degrees() - 135.0).abs() < 1e-3, "{found:?}");
        assert_eq!(found[1][0], 0.0);
        for (name, wanted) in [("S1.500nm", "without S1 and S2"), ("S0.0,5um", "two channels at 500 nm")] {
            let list = [channel("S0.500nm", [1.0; 2]), channel(name, [1.0; 2])];
            let error = picture(&list).expect_err(wanted).to_string();
            assert!(error.contains(wanted), "{error}");
        }
        let list = ["S0.500nm", "S1.500nm", "S2.510nm"].map(|name| channel(name, [1.0; 2]));
        assert!(picture(&list).expect_err("wavelengths").to_string().contains("other wavelengths of S2"));
    }

    #[test]
    fn colours_are_those_of_the_file_or_of_the_spectra() {
        let list = ["S0.R", "S0.G", "S0.B"].map(|name| channel(name, [0.25, f32::NAN]));
        let colours = picture(&list).expect("a picture");
        assert_eq!(
            (colours.channels.clone(), colours.colours[0], colours.not_finite()),
            (lobe::Channels::Rgb, [0.25; 3], 3)
        );
        // Shares are white under D65.
        let white: Vec<_> = (0..31).map(|k| channel(&format!("T.{}nm", 400 + 10 * k), [1.0, 0.5])).collect();
        let white = picture(&white).expect("a picture");
        assert_eq!(white.quantity, Quantity::Shares);
        assert!(white.colours[0].iter().all(|c| (c - 1.0).abs() < 1e-3), "{:?}", white.colours);
    }
}
