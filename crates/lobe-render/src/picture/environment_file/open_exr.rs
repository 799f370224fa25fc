//! Reads OpenEXR images of environments: finds the channels of radiance, and their place in the picture.

use std::io::Cursor;
use std::path::Path;

use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Chromaticities, EnvironmentMap, Text};
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel};
use lobe_colour::Primaries;

use super::super::PictureError;
use super::super::exr_file::{check_size, content};
use super::{Picture, check_shape};

/// Names of the channels that make up one colour.
#[derive(Clone, Debug, PartialEq)]
enum Colour {
    Rgb([String; 3]),
    /// Luminance, for grey images.
    Grey(String),
}

pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Picture, PictureError> {
    const EXPECTED: &str = "an OpenEXR image of flat channels with one value per texel";
    check_size(path, bytes)?;
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|e| content(path, e, EXPECTED))?;
    let (part, colour) = choose(path, &meta.headers)?;
    let header = &meta.headers[part];
    if header.own_attributes.environment_map == Some(EnvironmentMap::Cube) {
        return Err(content(path, "six sides of a cube (envmap)", "an image of longitude and latitude"));
    }
    // Some programs write this attribute of other formats. The value 1 changes nothing.
    let is_turned = |name: &str| {
        let attribute = header.own_attributes.other.get(&Text::from(name));
        attribute.is_some_and(|value| !matches!(value, AttributeValue::I32(1)))
    };
    if let Some(name) = ["Orientation", "orientation"].into_iter().find(|name| is_turned(name)) {
        return Err(content(path, format!("an attribute {name} other than 1"), "an image stored upright"));
    }
    let window = header.shared_attributes.display_window;
    check_shape(path, [window.size.0, window.size.1], f64::from(header.shared_attributes.pixel_aspect))?;

    let (columns, stored) = texels(bytes, &colour).map_err(|error| content(path, error, EXPECTED))?;
    let picture = placed(path, bytes, header, columns, &stored)?;
    match header.shared_attributes.chromaticities {
        Some(Chromaticities { red, green, blue, white }) => {
            let [red, green, blue, white] = [red, green, blue, white].map(|c| [f64::from(c.0), f64::from(c.1)]);
            picture.of_primaries(path, &Primaries { red, green, blue, white })
        }
        None => Ok(picture),
    }
}

/// The part with the radiance, and its channels: R, G and B, or Y, or those of the only layer that has them.
fn choose(path: &Path, headers: &[Header]) -> Result<(usize, Colour), PictureError> {
    let names = |header: &Header| header.channels.list.iter().map(|c| c.name.to_string()).collect::<Vec<String>>();
    let mut plain: Vec<(usize, Colour)> = Vec::new();
    let mut layers: Vec<(usize, Colour)> = Vec::new();
    for (part, header) in headers.iter().enumerate() {
        let names = names(header);
        let mut prefixes: Vec<&str> =
            names.iter().map(|name| name.rfind('.').map_or("", |dot| &name[..=dot])).collect();
        prefixes.sort_unstable();
        prefixes.dedup();
        for prefix in prefixes {
            let has = |name: &str| names.contains(&format!("{prefix}{name}"));
            let found = if ["R", "G", "B"].into_iter().all(has) {
                Colour::Rgb(["R", "G", "B"].map(|name| format!("{prefix}{name}")))
            } else if has("Y") && !["RY", "BY", "X", "Z", "R", "G", "B"].into_iter().any(has) {
                Colour::Grey(format!("{prefix}Y"))
            } else {
                continue;
            };
            if prefix.is_empty() { &mut plain } else { &mut layers }.push((part, found));
        }
    }
    let found = if plain.is_empty() { layers } else { plain };
    match found.as_slice() {
        [one] => Ok(one.clone()),
        [] => {
            let all: Vec<String> = headers.iter().flat_map(names).collect();
            let found = format!("the channels {}", all.join(", ").escape_debug());
            Err(content(path, found, "R, G and B (or Y alone)"))
        }
        several => {
            let name = |(part, colour): &(usize, Colour)| {
                let (Colour::Rgb([channel, ..]) | Colour::Grey(channel)) = colour;
                match &headers[*part].own_attributes.layer_name {
                    Some(layer) => format!("{channel} of {layer}"),
                    None => channel.clone(),
                }
            };
            let all: Vec<String> = several.iter().map(name).collect();
            let found = format!("{} layers of colour: {}", all.len(), all.join(", ").escape_debug());
            Err(content(path, found, "one layer with R, G and B"))
        }
    }
}

/// Number of columns, and texels of the data window.
fn texels(bytes: &[u8], colour: &Colour) -> exr::error::Result<(usize, Vec<[f32; 3]>)> {
    let flat = exr::prelude::read().no_deep_data().largest_resolution_level();
    match colour {
        Colour::Rgb([r, g, b]) => {
            let channels = flat.specific_channels();
            let channels = channels.required(r.as_str()).required(g.as_str()).required(b.as_str()).collect_pixels(
                |size, _| (size.0, vec![[0.0f32; 3]; size.area()]),
                |(width, texels), at, (r, g, b): (f32, f32, f32)| texels[at.1 * *width + at.0] = [r, g, b],
            );
            let image =
                channels.first_valid_layer().all_attributes().non_parallel().from_buffered(Cursor::new(bytes))?;
            Ok(image.layer_data.channel_data.pixels)
        }
        Colour::Grey(y) => {
            let channels = flat.specific_channels().required(y.as_str()).collect_pixels(
                |size, _| (size.0, vec![[0.0f32; 3]; size.area()]),
                |(width, texels), at, (y,): (f32,)| texels[at.1 * *width + at.0] = [y; 3],
            );
            let image =
                channels.first_valid_layer().all_attributes().non_parallel().from_buffered(Cursor::new(bytes))?;
            Ok(image.layer_data.channel_data.pixels)
        }
    }
}

/// The picture is the display window; it is black outside the data window.
fn placed(
    path: &Path,
    bytes: &[u8],
    header: &Header,
    columns: usize,
    stored: &[[f32; 3]],
) -> Result<Picture, PictureError> {
    /// How many texels of a display window may be empty, per byte of the file.
    const EMPTY_PER_BYTE: usize = 170;
    let window = header.shared_attributes.display_window;
    let (width, height) = (window.size.0, window.size.1);
    let count = width
        .checked_mul(height)
        .filter(|&count| count > 0 && count <= stored.len().saturating_add(bytes.len().saturating_mul(EMPTY_PER_BYTE)));
    let Some(count) = count else {
        let found = format!("a display window of {width} x {height} texels in {} bytes", bytes.len());
        return Err(content(path, found, "a size that the file justifies"));
    };
    let offset = |data: i32, display: i32| i64::from(data) - i64::from(display);
    let at = header.own_attributes.layer_position;
    let (left, top) = (offset(at.0, window.position.0), offset(at.1, window.position.1));
    if (left, top, columns, stored.len()) == (0, 0, width, count) {
        return Ok(Picture { width, height, texels: stored.to_vec() });
    }
    let mut texels = vec![[0.0; 3]; count];
    for (row, line) in stored.chunks_exact(columns.max(1)).enumerate() {
        let Some(y) = usize::try_from(top + row as i64).ok().filter(|&y| y < height) else { continue };
        for (column, texel) in line.iter().enumerate() {
            if let Some(x) = usize::try_from(left + column as i64).ok().filter(|&x| x < width) {
                texels[y * width + x] = *texel;
            }
        }
    }
    Ok(Picture { width, height, texels })
}
