//! Parts of a picture, rendered on many machines, back together.

use std::path::{Path, PathBuf};

use crate::film::{Film, Rect};
use crate::picture::{Meta, PictureError, read_partial};

/// Why parts do not make a picture.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// A part cannot be read.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// No parts.
    #[error("found no parts; expected at least one")]
    Nothing,
    /// Parts of different pictures.
    #[error("{second}: found {found} of {value}; expected {expected} as in {first}")]
    Different {
        /// What differs.
        found: &'static str,
        /// The first part.
        first: PathBuf,
        /// The part that differs.
        second: PathBuf,
        /// Its value.
        value: String,
        /// The value of the first part.
        expected: String,
    },
    /// Two parts have the same samples of the same pixels.
    #[error("{second}: found samples {samples} of pixels that {first} has as well; expected every sample once")]
    Twice {
        /// A part.
        first: PathBuf,
        /// Another one.
        second: PathBuf,
        /// The samples that both have.
        samples: String,
    },
    /// The parts are not the whole picture.
    #[error("found {found} of {expected} samples; expected all of them")]
    Gaps {
        /// Samples of all parts.
        found: u64,
        /// Samples of the picture.
        expected: u64,
    },
    /// What lies between the parts is far more than the parts.
    #[error("parts that cover too little of {0:?}, which spans them; expected adjacent parts")]
    Sparse(Rect),
}

/// Reads parts and adds them. The result is the same bits as the picture rendered at once.
///
/// # Errors
/// If a part cannot be read, is of another picture, or has samples that another one has too; and if samples are
/// missing, unless `gaps` are allowed.
pub fn merge(paths: &[impl AsRef<Path>], gaps: bool) -> Result<(Film, Meta), MergeError> {
    let mut parts: Vec<(PathBuf, Film, Meta)> = Vec::new();
    for path in paths {
        let path = path.as_ref();
        let (film, meta) = read_partial(path)?;
        for (first, _, other) in &parts {
            compare((first, other), (path, &meta))?;
        }
        parts.push((path.into(), film, meta));
    }
    let (_, _, meta) = parts.first().ok_or(MergeError::Nothing)?.clone();
    let found: u64 = parts.iter().flat_map(|(_, film, _)| film.pixels()).map(|pixel| u64::from(pixel.samples)).sum();
    let expected = u64::from(meta.size[0]) * u64::from(meta.size[1]) * u64::from(meta.total);
    if found != expected && !gaps {
        return Err(MergeError::Gaps { found, expected });
    }
    let window = parts.iter().map(|(_, _, meta)| meta.window).reduce(around).expect("at least one part");
    let area: usize = parts.iter().map(|(_, _, meta)| meta.window.area()).sum();
    if window.area() / 16 > area {
        return Err(MergeError::Sparse(window));
    }
    let samples = parts.iter().map(|(_, _, meta)| &meta.samples);
    let samples = samples.clone().map(|s| s.start).min().unwrap_or(0)..samples.map(|s| s.end).max().unwrap_or(0);
    let mut whole = Film::new(window);
    parts.iter().for_each(|(_, film, _)| whole.merge(film));
    Ok((whole, Meta { window, samples, ..meta }))
}

/// The smallest window around two.
fn around(a: Rect, b: Rect) -> Rect {
    let (x, y) = (a.x.min(b.x), a.y.min(b.y));
    let right = a.columns().end.max(b.columns().end);
    let bottom = a.rows().end.max(b.rows().end);
    Rect { x, y, width: right - x, height: bottom - y }
}

fn compare((first, a): (&Path, &Meta), (second, b): (&Path, &Meta)) -> Result<(), MergeError> {
    let size = |meta: &Meta| format!("{} x {}", meta.size[0], meta.size[1]);
    for (found, expected, value) in [
        ("the scene", a.scene.clone(), b.scene.clone()),
        ("a size", size(a), size(b)),
        ("a total of samples", a.total.to_string(), b.total.to_string()),
    ] {
        if expected != value {
            return Err(MergeError::Different { found, first: first.into(), second: second.into(), value, expected });
        }
    }
    let shared = a.samples.start.max(b.samples.start)..a.samples.end.min(b.samples.end);
    if a.window.intersection(&b.window).is_some() && !shared.is_empty() {
        let samples = format!("{}..{}", shared.start, shared.end);
        return Err(MergeError::Twice { first: first.into(), second: second.into(), samples });
    }
    Ok(())
}
