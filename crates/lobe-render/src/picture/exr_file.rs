//! OpenEXR files with pictures and, for parts of pictures, the exact sums.
//!
//! Channels: `R G B` (mean radiance, linear sRGB), `albedo.R G B`, `normal.X Y Z`, `depth.Z` (distance to the nearest
//! surface in the pixel, infinite if there is none), `material.id` (the material there, counted from 1) and `samples`.
//! A picture of wavelengths also has `S0.<nm>nm`, with a comma in place of the decimal point, and one of polarised
//! light `S1` to `S3`, as in A. Fichet, R. Pacanowski, A. Wilkie, "An OpenEXR Layout for Spectral Images", JCGT 10(3),
//! 2021; polarised light without wavelengths has `S0.R` and so on, and both have `dolp.Y` and `aolp.Y`, the degree and
//! the angle of linear polarisation. A part of a picture also has `sum.*`, the words of the integer sums of [`Pixel`],
//! low word first, and `splat.*`, the same for splats of light paths, if there are any.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, IntegerBounds, Layer, LayerAttributes,
    ReadChannels, ReadLayers, Text, Vec2, WritableImage,
};

use super::{Meta, PictureError, replace};
use crate::film::{BRIGHTEST_UNITS, Film, Pixel, SURFACE_UNITS, Splat};
use crate::transport::Transport;

/// The attribute that holds the [`Meta`].
pub(super) const ATTRIBUTE: &str = "lobe";
const RGB: [&str; 3] = ["R", "G", "B"];
const XYZ: [&str; 3] = ["X", "Y", "Z"];

/// Writes a film; with `partial` also the exact sums, from which [`read_partial`] reads it back.
///
/// The bytes depend only on the film and on `meta`.
///
/// # Errors
/// If the file cannot be written.
pub fn write_exr(path: &Path, film: &Film, meta: &Meta, partial: bool) -> Result<(), PictureError> {
    write_exr_in(path, film, &(), meta, partial)
}

/// Like [`write_exr`], for a film in these channels.
///
/// # Errors
/// The same as for [`write_exr`].
pub fn write_exr_in<T: Transport>(
    path: &Path,
    film: &Film<T>,
    basis: &T::Basis,
    meta: &Meta,
    partial: bool,
) -> Result<(), PictureError> {
    let bytes = encode(film, basis, meta, partial);
    replace(path, &bytes.map_err(|error| content(path, error, "a picture that EXR can hold"))?)
}

/// A channel of radiance.
struct Named {
    index: usize,
    name: String,
}

/// The channels of radiance that are in use, by their names in sums.
fn named<T: Transport>(basis: &T::Basis) -> Vec<Named> {
    let mut names = T::names(basis);
    if names.is_empty() {
        names = RGB.map(String::from).into();
    }
    let named = names.into_iter().enumerate().map(|(index, name)| Named { index, name });
    named.filter(|channel| !channel.name.is_empty()).collect()
}

fn encode<T: Transport>(film: &Film<T>, basis: &T::Basis, meta: &Meta, partial: bool) -> exr::error::Result<Vec<u8>> {
    let mut channels = Vec::new();
    let pixels = film.pixels();
    for (k, name) in RGB.into_iter().enumerate() {
        let colours = film.colours_in(basis).map(|colour| colour[k]).collect();
        channels.push(AnyChannel::new(name, FlatSamples::F32(colours)));
    }
    let is_spectral = !T::names(basis).is_empty();
    if is_spectral {
        for Named { index, name } in named::<T>(basis) {
            let values = (0..pixels.len()).map(|pixel| film.radiance(pixel).as_ref()[index]).collect();
            channels.push(AnyChannel::new(name.as_str(), FlatSamples::F32(values)));
        }
    }
    if T::SHOWS_POLARISATION {
        for (k, name) in ["dolp.Y", "aolp.Y"].into_iter().enumerate() {
            let of = |pixel| T::linear_polarisation(basis, film.radiance(pixel)).map_or(0.0, |found| found[k]);
            channels.push(AnyChannel::new(name, FlatSamples::F32((0..pixels.len()).map(of).collect())));
        }
    }
    let mut float = |name: String, value: &dyn Fn(&Pixel<T>) -> f32| {
        channels.push(AnyChannel::new(name.as_str(), FlatSamples::F32(pixels.iter().map(value).collect())));
    };
    for k in 0..3 {
        float(format!("albedo.{}", RGB[k]), &|pixel| pixel.mean_albedo()[k]);
        float(format!("normal.{}", XYZ[k]), &|pixel| pixel.mean_normal()[k]);
    }
    float("depth.Z".into(), &Pixel::depth);
    let mut whole = |name: String, value: &dyn Fn(&Pixel<T>) -> u32| {
        channels.push(AnyChannel::new(name.as_str(), FlatSamples::U32(pixels.iter().map(value).collect())));
    };
    whole("material.id".into(), &|pixel| pixel.material);
    whole("samples".into(), &|pixel| pixel.samples);
    if partial {
        for (name, word, value) in words::<T>(basis) {
            whole(name, &|pixel| (value(pixel) >> (32 * word)) as u32);
        }
        for (name, word, value) in splat_words::<T>(basis) {
            let words: Vec<u32> = film.splats().iter().map(|splat| (value(splat) >> (32 * word)) as u32).collect();
            if !words.is_empty() {
                channels.push(AnyChannel::new(name.as_str(), FlatSamples::U32(words)));
            }
        }
    }
    let window = film.window();
    let mut attributes =
        LayerAttributes { layer_position: Vec2(window.x as i32, window.y as i32), ..LayerAttributes::default() };
    // Only one attribute, because the library writes attributes that it does not know in any order.
    attributes.other.insert(Text::from(ATTRIBUTE), AttributeValue::Text(Text::from(meta.to_string().as_str())));
    // Parts are written often and read once.
    let encoding = if partial { Encoding::FAST_LOSSLESS } else { Encoding::SMALL_LOSSLESS };
    let size = Vec2(window.width as usize, window.height as usize);
    let layer = Layer::new(size, attributes, encoding, AnyChannels::sort(channels.into()));
    let mut image = Image::from_layer(layer);
    if is_spectral {
        let version = AttributeValue::Text(Text::from("1.0"));
        image.attributes.other.insert(Text::from("spectralLayoutVersion"), version);
    }
    image.attributes.display_window =
        IntegerBounds::from_dimensions(Vec2(meta.size[0] as usize, meta.size[1] as usize));
    let mut bytes = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// The contents of the `sum.*` channels: a name, the index of a word of 32 bits, and the sum.
type Word<T> = (String, u32, Box<dyn Fn(&Pixel<T>) -> i128>);

fn words<T: Transport>(basis: &T::Basis) -> Vec<Word<T>> {
    let mut words: Vec<Word<T>> = Vec::new();
    for Named { index, name } in named::<T>(basis) {
        for word in 0..4 {
            words.push((format!("sum.{name}.{word}"), word, Box::new(move |pixel| pixel.radiance.as_ref()[index])));
        }
    }
    for k in 0..3 {
        for word in 0..2 {
            let (albedo, normal) = (format!("sum.albedo.{}.{word}", RGB[k]), format!("sum.normal.{}.{word}", XYZ[k]));
            words.push((albedo, word, Box::new(move |pixel| pixel.albedo[k].into())));
            words.push((normal, word, Box::new(move |pixel| pixel.normal[k].into())));
        }
    }
    words
}

/// The contents of the `splat.*` channels, which are written only if light paths were added.
type SplatWord<T> = (String, u32, Box<dyn Fn(&Splat<T>) -> i128>);

fn splat_words<T: Transport>(basis: &T::Basis) -> Vec<SplatWord<T>> {
    let mut words: Vec<SplatWord<T>> = Vec::new();
    for Named { index, name } in named::<T>(basis) {
        for word in 0..4 {
            words.push((format!("splat.{name}.{word}"), word, Box::new(move |splat| splat.sums.as_ref()[index])));
        }
    }
    for word in 0..2 {
        words.push((format!("splat.paths.{word}"), word, Box::new(|splat| splat.paths.into())));
    }
    words
}

/// Reads a part of a picture written by [`write_exr`].
///
/// # Errors
/// If the file cannot be read, is damaged, or is not a part of a picture.
pub fn read_partial(path: &Path) -> Result<(Film, Meta), PictureError> {
    read_partial_in(path, &())
}

/// Like [`read_partial`], for a film in these channels.
///
/// # Errors
/// The same as for [`read_partial`].
pub fn read_partial_in<T: Transport>(path: &Path, basis: &T::Basis) -> Result<(Film<T>, Meta), PictureError> {
    const EXPECTED: &str = "a part of a picture written by lobe";
    let wrong = |found: String| content(path, found, EXPECTED);
    let bytes = lobe_files::bytes(path).map_err(|error| PictureError::Io { file: path.into(), error })?;
    check_size(path, &bytes)?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(&bytes))
        .map_err(|error| content(path, error, EXPECTED))?;
    let layer = image.layer_data;
    let Some(AttributeValue::Text(text)) = layer.attributes.other.get(&Text::from(ATTRIBUTE)) else {
        return Err(wrong(format!("no attribute `{ATTRIBUTE}`")));
    };
    let text = text.to_string();
    let meta = Meta::parse(&text).ok_or_else(|| wrong(format!("the attribute `{ATTRIBUTE}` with `{text}`")))?;
    if layer.size != Vec2(meta.window.width as usize, meta.window.height as usize) {
        return Err(wrong(format!("{} x {} pixels of the window {:?}", layer.size.0, layer.size.1, meta.window)));
    }
    let column = |name: &str| {
        let found = layer.channel_data.list.iter().find(|channel| channel.name.eq(name));
        found.map(|channel| &channel.sample_data).ok_or_else(|| wrong(format!("no channel `{name}`")))
    };
    let whole = |name: &str| match column(name)? {
        FlatSamples::U32(values) => Ok(values),
        _ => Err(wrong(format!("floats in the channel `{name}`"))),
    };
    let mut film: Film<T> = Film::try_new(meta.window, 0).map_err(|no_room| wrong(format!("pixels of {no_room}")))?;
    let FlatSamples::F32(depth) = column("depth.Z")? else { return Err(wrong("integers in `depth.Z`".into())) };
    for (at, pixel) in film.pixels_mut().iter_mut().enumerate() {
        pixel.depth = depth[at].to_bits();
    }
    for (at, &material) in whole("material.id")?.iter().enumerate() {
        film.pixels_mut()[at].material = material;
    }
    let most = meta.samples.end - meta.samples.start;
    for (at, &samples) in whole("samples")?.iter().enumerate() {
        if samples > most {
            return Err(wrong(format!("{samples} samples of a pixel, but {:?} were rendered", meta.samples)));
        }
        film.pixels_mut()[at].samples = samples;
    }
    let named = named::<T>(basis);
    for Named { index, name } in &named {
        for low in 0..4 {
            let values = whole(&format!("sum.{name}.{low}"))?;
            for (pixel, &value) in film.pixels_mut().iter_mut().zip(values) {
                // The top word contains the sign, because all bits of an `i128` are written.
                pixel.radiance.as_mut()[*index] |= i128::from(value) << (32 * low);
            }
        }
    }
    for k in 0..3 {
        for low in 0..2 {
            let albedo = whole(&format!("sum.albedo.{}.{low}", RGB[k]))?;
            let normal = whole(&format!("sum.normal.{}.{low}", XYZ[k]))?;
            for (at, pixel) in film.pixels_mut().iter_mut().enumerate() {
                pixel.albedo[k] |= i64::from(albedo[at]) << (32 * low);
                pixel.normal[k] |= i64::from(normal[at]) << (32 * low);
            }
        }
    }
    // A part of a picture to which no light path was added has no such channels.
    if column("splat.paths.0").is_ok() {
        let splats = film.splats_mut();
        for Named { index, name } in &named {
            for low in 0..4 {
                let values = whole(&format!("splat.{name}.{low}"))?;
                for (splat, &value) in splats.iter_mut().zip(values) {
                    splat.sums.as_mut()[*index] |= i128::from(value) << (32 * low);
                }
            }
        }
        for low in 0..2 {
            for (splat, &value) in splats.iter_mut().zip(whole(&format!("splat.paths.{low}"))?) {
                splat.paths |= u64::from(value) << (32 * low);
            }
        }
    }
    if let Some(found) = impossible(&film) {
        return Err(wrong(found));
    }
    Ok((film, meta))
}

/// A sum in the film that no rendering can have, or to which samples could not be added; `None` if all sums are valid.
fn impossible<T: Transport>(film: &Film<T>) -> Option<String> {
    for Pixel { radiance, albedo, normal, samples, .. } in film.pixels() {
        let (samples, found) = (u128::from(*samples), format!("a sum of more than {samples} samples"));
        if radiance.as_ref().iter().any(|sum| sum.unsigned_abs() > samples * BRIGHTEST_UNITS) {
            return Some(format!("{found} of radiance"));
        }
        let surface = samples * SURFACE_UNITS;
        if albedo.iter().chain(normal).any(|sum| u128::from(sum.unsigned_abs()) > surface) {
            return Some(format!("{found} of a surface"));
        }
    }
    // How many splats a light path makes is not counted; these bounds leave room for as many again.
    const MOST: u128 = BRIGHTEST_UNITS << 32;
    let too_large =
        |splat: &&Splat<T>| splat.paths > 1 << 62 || splat.sums.as_ref().iter().any(|sum| sum.unsigned_abs() > MOST);
    film.splats().iter().find(too_large).map(|splat| format!("sums of {} light paths that overflow", splat.paths))
}

/// Refuses files whose header claims far more pixels than their bytes can hold.
pub(crate) fn check_size(path: &Path, bytes: &[u8]) -> Result<(), PictureError> {
    /// Zip, the strongest compression, shrinks zeros to a thousandth.
    const RATIO: u64 = 2048;
    let expected = "an EXR file";
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false)
        .map_err(|error| content(path, error, expected))?;
    for header in &meta.headers {
        let pixels = header.layer_size.0 as u64 * header.layer_size.1 as u64;
        let promised = pixels.saturating_mul(header.channels.bytes_per_pixel as u64);
        if promised > RATIO.saturating_mul(bytes.len() as u64) {
            let found = format!("{} x {} pixels in {} bytes", header.layer_size.0, header.layer_size.1, bytes.len());
            return Err(content(path, found, expected));
        }
        // As stored, and as used.
        if let Err(no_room) = lobe_memory::require(promised.saturating_mul(2)) {
            let found = format!("{} x {} pixels, which take {no_room}", header.layer_size.0, header.layer_size.1);
            return Err(content(path, found, "a picture that fits into memory"));
        }
    }
    Ok(())
}

pub(crate) fn content(path: &Path, found: impl ToString, expected: &'static str) -> PictureError {
    PictureError::Content { file: path.into(), found: found.to_string(), expected }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Filter;
    use crate::film::{Rect, Sample};
    use crate::merge;
    use crate::picture::{Inspected, Light, inspect};

    #[test]
    #[cfg_attr(target_os = "wasi", ignore = "WASI has no folder for temporary files")]
    fn splats_are_written_read_and_merged_exactly_if_there_are_any() {
        let folder = tempfile::tempdir().unwrap();
        let window = Rect { x: 0, y: 0, width: 5, height: 4 };
        let meta = |samples| Meta {
            scene: "ab12".into(),
            size: [5, 4],
            window,
            samples,
            total: 2,
            timed: false,
            exposure: 0.0,
            version: Meta::VERSION.into(),
            arithmetic: "strict".into(),
        };
        let part = |step: f32| {
            let mut film = Film::new(window);
            film.pixels_mut().iter_mut().for_each(|pixel| {
                pixel.add(&Sample { radiance: [step, 0.5, 1e-7], ..Sample::EMPTY });
            });
            film
        };
        let splatted = |step: f32| {
            let mut film = part(step);
            film.add_light_paths(1 << 40);
            for i in 0..20 {
                let at = (i as f32 * step).fract();
                assert!(film.splat([5.0 * at, 4.0 * at], [-at, 1e9 * at, 1e-3], Filter::Tent));
            }
            film
        };
        let path = |name: &str| folder.path().join(name);
        let films = [splatted(0.618_034), splatted(0.754_878)];
        for (k, film) in films.iter().enumerate() {
            write_exr(&path(&format!("{k}.exr")), film, &meta(k as u32..k as u32 + 1), true).unwrap();
            assert!(read_partial(&path(&format!("{k}.exr"))).unwrap().0 == *film);
        }
        let merged = merge(&[path("0.exr"), path("1.exr")], false).unwrap().0;
        let mut expected = films[0].clone();
        expected.merge(&films[1]);
        assert!(merged == expected);
        // Without light paths, the file has no channels for them.
        write_exr(&path("none.exr"), &part(0.3), &meta(0..1), true).unwrap();
        let bytes = std::fs::read(path("none.exr")).unwrap();
        assert!(!bytes.windows(6).any(|six| six == b"splat."));
        assert!(read_partial(&path("none.exr")).unwrap().0.splats().is_empty());
        assert_eq!(
            inspect(&path("none.exr")).unwrap(),
            Inspected { meta: meta(0..1), has_sums: true, light: Light::default() }
        );
        write_exr(&path("done.exr"), &part(0.3), &meta(0..1), false).unwrap();
        assert_eq!(
            inspect(&path("done.exr")).unwrap(),
            Inspected { meta: meta(0..1), has_sums: false, light: Light::default() }
        );
    }
}
