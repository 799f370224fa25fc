//! SSDD, "surface scattering distribution data", the open format of libbsdf, version 0.3.
//!
//! Up to four blocks: BRDF, BTDF, specular reflectance and specular transmittance. Each has keys in ASCII, angles in
//! degrees, and values in ASCII or as little-endian `f32`, the first parameter fastest and the channels faster still.
//! Values are `f` in 1/sr, without the cosine; those of specular blocks are a share of the light, 0 to 1.

mod read;
mod write;

pub use read::{matches, read};
pub use write::{Encoding, write};

use lobe_table::{Channels, Data, specular};

use crate::Document;
use crate::spec::{FormatSpec, Writer, commented, either};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "SSDD",
    word: "ssdd",
    extensions: &["ssdd"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::of_parts(read(bytes, path)?).with_facts(read::facts(bytes)))),
    read_set: None,
    writer: Some(Writer {
        extensions: &["ssdd"],
        holds_channels: |channels| {
            matches!(channels, Channels::Mono | Channels::Rgb | Channels::Xyz | Channels::Spectral(_))
        },
        channels: "one channel, R G B, X Y Z or wavelengths",
        holds: |document| match document.only() {
            Some(Data::Spherical(grid)) => !grid.is_mirrored(),
            Some(Data::Specular(_) | Data::Mirror(_)) => true,
            Some(_) => false,
            None => true,
        },
        holds_sheets: true,
        scatter: either,
        resampled_as: Ok(specular::KIND),
        write: |document, path| commented("#", document, path, |path| write(&document.parts, Encoding::Ascii, path)),
    }),
};
