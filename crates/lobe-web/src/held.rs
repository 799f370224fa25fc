//! What there is in a file without values for pairs of directions, such as the reflectance of a mirror.

use std::path::Path;

use lobe::table::mirror;
use lobe_formats::{Document, Format};
use serde::Serialize;

use crate::facts::{Block, blocks, scatter_word};

/// What a file holds that can be read, but has no values for pairs of directions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Held {
    /// The name of the file.
    pub name: String,
    /// Its format.
    pub format: &'static str,
    /// Its size.
    pub bytes: u64,
    /// Names and values of each block of values.
    pub parts: Vec<Block>,
    /// What the header says.
    pub source: Vec<(String, String)>,
    /// What the reader made of what the file leaves open.
    pub notes: Vec<String>,
    /// What may be wrong with that.
    pub doubts: Vec<String>,
    /// The mirrors, one for each azimuth of the light.
    pub mirrors: Vec<MirrorTable>,
}

/// The share of the light that is mirrored, or goes straight through.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MirrorTable {
    /// What the file calls it, and `reflection` or `transmission`.
    pub name: String,
    /// The azimuth of the light in radians; nothing if it makes no difference.
    pub psi: Option<f64>,
    /// The names of the channels.
    pub channels: Vec<String>,
    /// One for each polar angle of the light.
    pub rows: Vec<MirrorRow>,
}

/// The share of the light from one direction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MirrorRow {
    /// The polar angle of the light in radians.
    pub sigma: f64,
    /// The share of each channel.
    pub values: Vec<f32>,
}

/// What a document holds that was read from `path`, a file of that many bytes.
pub(crate) fn held(path: &Path, bytes: u64, format: Format, document: &Document) -> Held {
    let name = path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into());
    let mirrors = document.parts.iter().filter_map(|part| Some((part.name.as_str(), part.data.mirror()?)));
    Held {
        name,
        format: format.name(),
        bytes,
        parts: blocks(document),
        source: document.source.clone(),
        notes: document.notes.clone(),
        doubts: document.doubts.clone(),
        mirrors: mirrors.flat_map(|(name, mirror)| tables(name, mirror)).collect(),
    }
}

fn tables(name: &str, mirror: &mirror::Data) -> Vec<MirrorTable> {
    let [sigmas, psis] = mirror.knots();
    let count = mirror.channels().count();
    let table = |(at, psi): (usize, &f64)| {
        let row = |(row, &sigma): (usize, &f64)| {
            let values = mirror.values()[(row * psis.len() + at) * count..][..count].to_vec();
            MirrorRow { sigma, values }
        };
        MirrorTable {
            name: format!("{name} {}", scatter_word(mirror.scatter())).trim().into(),
            psi: (psis.len() > 1).then_some(*psi),
            channels: mirror.channels().names(),
            rows: sigmas.iter().enumerate().map(row).collect(),
        }
    };
    psis.iter().enumerate().map(table).collect()
}
