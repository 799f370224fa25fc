//! OpenEXR: what was seen, and for parts of pictures the exact sums.
//!
//! Channels: `R G B` (mean radiance, linear sRGB), `albedo.R G B`, `normal.X Y Z`, `depth.Z` (distance to the nearest
//! surface in the pixel, infinite where there is none), `material.id` (the material there, counted from 1) and
//! `samples`. A part of a picture also has `sum.*`: the words of the integers that [`Pixel`] sums in, low word first.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, IntegerBounds, Layer, LayerAttributes,
    ReadChannels, ReadLayers, Text, Vec2, WritableImage,
};

use super::{Meta, PictureError, replace};
use crate::film::{Film, Pixel};

/// The attribute that holds the [`Meta`].
const ATTRIBUTE: &str = "lobe";
const RGB: [&str; 3] = ["R", "G", "B"];
const XYZ: [&str; 3] = ["X", "Y", "Z"];

/// Writes a film; with `partial` the exact sums as well, from which [`read_partial`] reads it back.
///
/// The bytes depend on the film and on `meta`, and on nothing else.
///
/// # Errors
/// Where the system refuses.
pub fn write_exr(path: &Path, film: &Film<3>, meta: &Meta, partial: bool) -> Result<(), PictureError> {
    replace(path, &encode(film, meta, partial).map_err(|error| content(path, error, "a picture that EXR can hold"))?)
}

fn encode(film: &Film<3>, meta: &Meta, partial: bool) -> exr::error::Result<Vec<u8>> {
    let mut channels = Vec::new();
    let pixels = film.pixels();
    let mut float = |name: String, value: &dyn Fn(&Pixel<3>) -> f32| {
        channels.push(AnyChannel::new(name.as_str(), FlatSamples::F32(pixels.iter().map(value).collect())));
    };
    for k in 0..3 {
        float(RGB[k].into(), &|pixel| pixel.mean_radiance()[k]);
        float(format!("albedo.{}", RGB[k]), &|pixel| pixel.mean_albedo()[k]);
        float(format!("normal.{}", XYZ[k]), &|pixel| pixel.mean_normal()[k]);
    }
    float("depth.Z".into(), &Pixel::depth);
    let mut whole = |name: String, value: &dyn Fn(&Pixel<3>) -> u32| {
        channels.push(AnyChannel::new(name.as_str(), FlatSamples::U32(pixels.iter().map(value).collect())));
    };
    whole("material.id".into(), &|pixel| pixel.material);
    whole("samples".into(), &|pixel| pixel.samples);
    if partial {
        for (name, word, value) in words() {
            whole(name, &|pixel| (value(pixel) >> (32 * word)) as u32);
        }
    }
    let window = film.window();
    let mut attributes =
        LayerAttributes { layer_position: Vec2(window.x as i32, window.y as i32), ..LayerAttributes::default() };
    // One attribute only: the library writes those that it does not know in any order.
    attributes.other.insert(Text::from(ATTRIBUTE), AttributeValue::Text(Text::from(meta.to_string().as_str())));
    // Parts are written often and read once.
    let encoding = if partial { Encoding::FAST_LOSSLESS } else { Encoding::SMALL_LOSSLESS };
    let size = Vec2(window.width as usize, window.height as usize);
    let layer = Layer::new(size, attributes, encoding, AnyChannels::sort(channels.into()));
    let mut image = Image::from_layer(layer);
    image.attributes.display_window =
        IntegerBounds::from_dimensions(Vec2(meta.size[0] as usize, meta.size[1] as usize));
    let mut bytes = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// What the `sum.*` channels hold: a name, which word of 32 bits, and the sum.
type Word = (String, u32, Box<dyn Fn(&Pixel<3>) -> i128>);

fn words() -> Vec<Word> {
    let mut words: Vec<Word> = Vec::new();
    for k in 0..3 {
        for word in 0..4 {
            words.push((format!("sum.{}.{word}", RGB[k]), word, Box::new(move |pixel| pixel.radiance[k])));
        }
        for word in 0..2 {
            let (albedo, normal) = (format!("sum.albedo.{}.{word}", RGB[k]), format!("sum.normal.{}.{word}", XYZ[k]));
            words.push((albedo, word, Box::new(move |pixel| pixel.albedo[k].into())));
            words.push((normal, word, Box::new(move |pixel| pixel.normal[k].into())));
        }
    }
    words
}

/// Reads a part of a picture as [`write_exr`] has written it.
///
/// # Errors
/// Where the file cannot be read, is damaged, or is not a part of a picture.
pub fn read_partial(path: &Path) -> Result<(Film<3>, Meta), PictureError> {
    const EXPECTED: &str = "a part of a picture that lobe has written";
    let wrong = |found: String| content(path, found, EXPECTED);
    let bytes = std::fs::read(path).map_err(|error| PictureError::Io { file: path.into(), error })?;
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
    let mut film = Film::new(meta.window);
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
            return Err(wrong(format!("{samples} samples of a pixel where {:?} were rendered", meta.samples)));
        }
        film.pixels_mut()[at].samples = samples;
    }
    for k in 0..3 {
        let word = |name: String| -> Result<&Vec<u32>, PictureError> { whole(&name) };
        for low in 0..4 {
            let values = word(format!("sum.{}.{low}", RGB[k]))?;
            for (pixel, &value) in film.pixels_mut().iter_mut().zip(values) {
                // The top word brings the sign, as all bits of an `i128` are written.
                pixel.radiance[k] |= i128::from(value) << (32 * low);
            }
        }
        for low in 0..2 {
            let albedo = word(format!("sum.albedo.{}.{low}", RGB[k]))?;
            let normal = word(format!("sum.normal.{}.{low}", XYZ[k]))?;
            for (at, pixel) in film.pixels_mut().iter_mut().enumerate() {
                pixel.albedo[k] |= i64::from(albedo[at]) << (32 * low);
                pixel.normal[k] |= i64::from(normal[at]) << (32 * low);
            }
        }
    }
    Ok((film, meta))
}

/// Refuses files whose header promises far more pixels than their bytes can hold.
pub(crate) fn check_size(path: &Path, bytes: &[u8]) -> Result<(), PictureError> {
    /// Zip, the strongest of the compressions, makes a thousandth of zeros.
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
    }
    Ok(())
}

pub(crate) fn content(path: &Path, found: impl ToString, expected: &'static str) -> PictureError {
    PictureError::Content { file: path.into(), found: found.to_string(), expected }
}
