//! Merges parts of a picture that were rendered on many machines.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use lobe_memory::NoRoom;

use crate::film::{Film, Rect};
use crate::picture::{Difference, Inspected, Meta, PictureError, inspect, read_partial_in};
use crate::transport::Transport;

/// The reason why parts do not make a picture.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// A part cannot be read.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// There are no parts.
    #[error("found no parts; expected at least one")]
    Nothing,
    /// The parts belong to different pictures.
    #[error("{second}: found {found} of {value}; expected {expected} as in {first}")]
    Different {
        /// The property that differs.
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
    #[error("{second}: found samples {samples} of pixels that {first} also has; expected every sample once")]
    Twice {
        /// A part.
        first: PathBuf,
        /// Another one.
        second: PathBuf,
        /// The samples that both have.
        samples: String,
    },
    /// The parts are not the whole picture.
    #[error("found {found} of {expected} samples; expected all of them, but these are missing: {}", list(gaps))]
    Gaps {
        /// Number of samples of all parts.
        found: u64,
        /// Number of samples of the picture.
        expected: u64,
        /// What is missing.
        gaps: Vec<Gap>,
    },
    /// The picture does not fit into memory.
    #[error("found a picture of {0}; expected one that fits into memory")]
    Memory(NoRoom),
    /// The parts are far apart, so that they cover too little of the window that spans them.
    #[error("found parts that cover too little of {0:?}, which spans them; expected adjacent parts")]
    Sparse(Rect),
}

/// Samples of pixels that are in no part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gap {
    /// Which pixels.
    pub pixels: Rect,
    /// `true` if they are whole rows of the picture.
    pub is_whole_rows: bool,
    /// Which samples.
    pub samples: Range<u32>,
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Rect { x, y, width, height } = self.pixels;
        write!(f, "samples {}..{} of rows {y}..{}", self.samples.start, self.samples.end, y + height)?;
        if self.is_whole_rows { Ok(()) } else { write!(f, " in columns {x}..{}", x + width) }
    }
}

/// The first few of them.
fn list(gaps: &[Gap]) -> String {
    const SHOWN: usize = 4;
    let mut shown: Vec<String> = gaps.iter().take(SHOWN).map(ToString::to_string).collect();
    if gaps.len() > SHOWN {
        shown.push(format!("{} more", gaps.len() - SHOWN));
    }
    shown.join(", ")
}

/// Facts about a part that was added.
struct Part {
    meta: Meta,
    /// The samples of each pixel of its window.
    counts: Vec<u32>,
}

impl Part {
    /// The samples that all pixels of a rectangle have; none if it is not inside the window.
    fn samples_of(&self, pixels: &Rect) -> Range<u32> {
        let Meta { window, samples, .. } = &self.meta;
        if window.intersection(pixels) != Some(*pixels) {
            return samples.start..samples.start;
        }
        let row = |y: u32| {
            let at = (y - window.y) as usize * window.width as usize + (pixels.x - window.x) as usize;
            &self.counts[at..][..pixels.width as usize]
        };
        let least = pixels.rows().flat_map(row).min().copied().unwrap_or(0);
        samples.start..samples.start.saturating_add(least)
    }
}

/// Reads parts and adds them. The result has the same bits as the picture rendered in one go. If a time limit ended the
/// rendering of a part, one sample of each pixel is enough.
///
/// # Errors
/// If a part cannot be read, belongs to another picture, or has samples that another part also has; and if samples are
/// missing, unless `gaps` are allowed.
pub fn merge(paths: &[impl AsRef<Path>], gaps: bool) -> Result<(Film, Meta), MergeError> {
    merge_in(paths, gaps, &())
}

/// Like [`merge`], for parts in these channels.
///
/// # Errors
/// The same as for [`merge`].
pub fn merge_in<T: Transport>(
    paths: &[impl AsRef<Path>],
    gaps: bool,
    basis: &T::Basis,
) -> Result<(Film<T>, Meta), MergeError> {
    let mut metas: Vec<(&Path, Meta)> = Vec::new();
    for path in paths.iter().map(AsRef::as_ref) {
        let Inspected { meta, .. } = inspect(path)?;
        for (first, other) in &metas {
            compare((first, other), (path, &meta))?;
        }
        metas.push((path, meta));
    }
    let (_, meta) = metas.first().ok_or(MergeError::Nothing)?.clone();
    let window = metas.iter().map(|(_, meta)| meta.window).reduce(around).expect("at least one part");
    let area: usize = metas.iter().map(|(_, meta)| meta.window.area()).sum();
    if window.area() / 16 > area {
        return Err(MergeError::Sparse(window));
    }
    let mut whole = Film::<T>::try_new(window, 0).map_err(MergeError::Memory)?;
    let mut parts = Vec::new();
    for (path, _) in &metas {
        let (film, meta) = read_partial_in::<T>(path, basis)?;
        whole.merge(&film);
        parts.push(Part { meta, counts: film.pixels().iter().map(|pixel| pixel.samples).collect() });
    }
    let timed = metas.iter().any(|(_, meta)| meta.timed);
    let wanted = if timed { 1 } else { meta.total };
    if !gaps {
        let missing = missing(&parts, meta.size, wanted);
        if !missing.is_empty() {
            let found = whole.pixels().iter().map(|pixel| u64::from(pixel.samples.min(wanted))).sum();
            let expected = u64::from(meta.size[0]) * u64::from(meta.size[1]) * u64::from(wanted);
            return Err(MergeError::Gaps { found, expected, gaps: missing });
        }
    }
    let samples = metas.iter().map(|(_, meta)| &meta.samples);
    let start = samples.clone().map(|s| s.start).min().unwrap_or(0);
    let end = if timed { start + whole.samples().1 } else { samples.map(|s| s.end).max().unwrap_or(0) };
    let total = if timed { end } else { meta.total };
    Ok((whole, Meta { window, samples: start..end, total, timed, ..meta }))
}

/// The samples below `wanted` that are missing, by rows from the top.
fn missing(parts: &[Part], [width, height]: [u32; 2], wanted: u32) -> Vec<Gap> {
    // Between two neighbouring edges of windows, all pixels belong to the same parts.
    let edges = |range: fn(&Rect) -> Range<u32>, end: u32| {
        let windows = parts.iter().map(|part| range(&part.meta.window));
        let mut edges: Vec<u32> = windows.flat_map(|range| [range.start, range.end]).chain([0, end]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    };
    let (columns, rows) = (edges(Rect::columns, width), edges(Rect::rows, height));
    let mut gaps: Vec<Gap> = Vec::new();
    for y in rows.windows(2) {
        for x in columns.windows(2) {
            let pixels = Rect { x: x[0], y: y[0], width: x[1] - x[0], height: y[1] - y[0] };
            let mut there: Vec<Range<u32>> = parts.iter().map(|part| part.samples_of(&pixels)).collect();
            there.sort_by_key(|samples| samples.start);
            let mut next = 0;
            for samples in
                there.into_iter().chain(std::iter::once(wanted..wanted)).filter(|s| s.start == wanted || !s.is_empty())
            {
                if next < samples.start.min(wanted) {
                    add(&mut gaps, pixels, next..samples.start.min(wanted), width);
                }
                next = next.max(samples.end);
            }
        }
    }
    gaps
}

/// Adds a gap, or extends one that it continues.
fn add(gaps: &mut Vec<Gap>, pixels: Rect, samples: Range<u32>, width: u32) {
    let is_whole_rows = pixels.width == width;
    let continued = gaps.iter_mut().find(|gap| {
        let Rect { x, y, width, height } = gap.pixels;
        gap.samples == samples && (x, width) == (pixels.x, pixels.width) && y + height == pixels.y
    });
    match continued {
        Some(gap) => gap.pixels.height += pixels.height,
        None => gaps.push(Gap { pixels, is_whole_rows, samples }),
    }
}

/// The smallest window around two windows.
fn around(a: Rect, b: Rect) -> Rect {
    let (x, y) = (a.x.min(b.x), a.y.min(b.y));
    let right = a.columns().end.max(b.columns().end);
    let bottom = a.rows().end.max(b.rows().end);
    Rect { x, y, width: right - x, height: bottom - y }
}

fn compare((first, a): (&Path, &Meta), (second, b): (&Path, &Meta)) -> Result<(), MergeError> {
    let different = |found, expected: String, value: String| {
        Err(MergeError::Different { found, first: first.into(), second: second.into(), value, expected })
    };
    if let Some(Difference { of, first, second }) = a.difference(b) {
        return different(of, first, second);
    }
    if a.total != b.total {
        return different("a total of samples", a.total.to_string(), b.total.to_string());
    }
    let shared = a.samples.start.max(b.samples.start)..a.samples.end.min(b.samples.end);
    if a.window.intersection(&b.window).is_some() && !shared.is_empty() {
        let samples = format!("{}..{}", shared.start, shared.end);
        return Err(MergeError::Twice { first: first.into(), second: second.into(), samples });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(window: [u32; 4], samples: Range<u32>, counts: Option<Vec<u32>>) -> Part {
        let text = format!(
            "scene = \"a\"\nsize = [8, 6]\nwindow = {window:?}\nsamples = [{}, {}]\ntotal = 4",
            samples.start, samples.end
        );
        let meta = Meta::parse(&text).expect("sound");
        let counts = counts.unwrap_or_else(|| vec![samples.len() as u32; meta.window.area()]);
        Part { meta, counts }
    }

    fn gaps(parts: &[Part]) -> String {
        missing(parts, [8, 6], 4).iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    }

    #[test]
    fn gaps_are_named_by_rows_columns_and_samples() {
        assert_eq!(gaps(&[part([0, 0, 8, 6], 0..4, None)]), "");
        assert_eq!(
            gaps(&[part([0, 0, 8, 2], 0..4, None), part([0, 4, 8, 2], 0..4, None)]),
            "samples 0..4 of rows 2..4"
        );
        assert_eq!(
            gaps(&[part([0, 0, 8, 6], 1..2, None), part([0, 0, 8, 6], 3..4, None)]),
            "samples 0..1 of rows 0..6; samples 2..3 of rows 0..6"
        );
        let most = [part([0, 0, 8, 3], 0..4, None), part([0, 3, 5, 3], 0..4, None)];
        assert_eq!(gaps(&most), "samples 0..4 of rows 3..6 in columns 5..8");
        // The pixels of a part that ended early show how far it came.
        let mut counts = vec![4; 48];
        counts[47] = 3;
        assert_eq!(gaps(&[part([0, 0, 8, 6], 0..4, Some(counts))]), "samples 3..4 of rows 0..6");
        assert_eq!(gaps(&[part([0, 2, 8, 2], 0..4, None)]), "samples 0..4 of rows 0..2; samples 0..4 of rows 4..6");
    }
}
