//! The file of a picture, the sums that an earlier rendering left there, and their protection.

use std::path::{Path, PathBuf};

use lobe_files::check_output;
use lobe_memory::require;
use lobe_render::picture::{
    Inspected, Meta, PictureError, Shown, ToneMap, inspect, read_partial_in, write_exr_in, write_png_in,
};
use lobe_render::{Channels, Film, Rect, Transport};

use crate::failure::Failure;

/// Bytes per pixel that writing a finished picture takes in addition to the film: the columns of the file, and the
/// file.
pub const FILM: usize = 100;
/// The same for the picture so far: a copy of the film, and the sums in columns and as a file.
const SO_FAR: usize = 400;
/// The same per channel, of which there are at least three.
const SUMS: usize = 40;

/// The kinds of files that pictures are written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// OpenEXR.
    Exr,
    /// PNG.
    Png,
}

impl Kind {
    /// The kind given by the name of a file.
    pub fn of(path: &Path) -> Result<Self, Failure> {
        let is = |extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
        match (is("exr"), is("png")) {
            (true, _) => Ok(Kind::Exr),
            (_, true) => Ok(Kind::Png),
            _ => Err(Failure::Usage(format!("{}: expected a name that ends in .exr or .png", path.display()))),
        }
    }

    /// Refuses an exposure for EXR files, which hold radiances.
    pub fn refuse_exposure(self, exposure: Option<f32>, path: &Path) -> Result<(), Failure> {
        if self == Kind::Png || exposure.is_none() {
            return Ok(());
        }
        let message =
            format!("{}: found --exposure, but EXR files hold unscaled radiances; expected .png", path.display());
        Err(Failure::Usage(message))
    }
}

/// Parses an exposure in stops.
pub fn parse_exposure(text: &str) -> Result<f32, String> {
    let stops: Option<f32> = text.trim().parse().ok();
    stops.filter(|stops| stops.abs() <= 60.0).ok_or_else(|| format!("found `{text}`; expected stops from -60 to 60"))
}

/// The file that a picture is written to.
pub struct Output<'a> {
    path: &'a Path,
    kind: Kind,
    /// The tone mapping of a PNG.
    pub tone: ToneMap,
    /// The quantity that a PNG shows.
    pub shown: Shown,
    keep_sums: bool,
}

/// The result of an earlier rendering.
pub enum Begun<T: Transport> {
    /// The sums of some samples.
    Sums(Film<T>),
    /// A finished picture with this many samples.
    Finished(u32),
}

impl<'a> Output<'a> {
    /// A file of this kind, which finally has the sums if they are kept.
    pub fn new(path: &'a Path, kind: Kind, keep_sums: bool) -> Self {
        Output { path, kind, tone: ToneMap { exposure: 0.0 }, shown: Shown::Colour, keep_sums }
    }

    /// Checks that all output files can be written, and that none of them is an input.
    pub fn check<P: AsRef<Path>>(&self, inputs: &[P]) -> Result<(), Failure> {
        check_output(self.path, inputs)?;
        Ok(check_output(&self.part(), inputs)?)
    }

    /// The file that a stopped rendering leaves behind.
    pub fn part(&self) -> PathBuf {
        match self.kind {
            Kind::Exr => self.path.into(),
            Kind::Png => {
                let mut name = self.path.as_os_str().to_owned();
                name.push(".part.exr");
                name.into()
            }
        }
    }

    /// The result of an earlier rendering; `None` if there is no file, or lobe did not write it.
    pub fn earlier(&self) -> Result<Option<Inspected>, Failure> {
        match inspect(&self.part()) {
            Ok(earlier) => Ok(Some(earlier)),
            Err(error @ PictureError::Io { .. }) if self.part().exists() => Err(error.into()),
            Err(PictureError::Io { .. } | PictureError::Content { .. }) => Ok(None),
        }
    }

    /// The error if existing sums would be overwritten.
    pub fn refuse(&self, earlier: &Inspected) -> Failure {
        Failure::Usage(format!(
            "{}: found the sums of an earlier rendering of {} samples; expected --resume to continue with them, or \
             --force to start anew",
            self.part().display(),
            earlier.meta.samples.end - earlier.meta.samples.start
        ))
    }

    /// The result of an earlier rendering of the same picture.
    pub fn resume<T: Transport>(
        &self,
        basis: &T::Basis,
        wanted: &Meta,
        earlier: &Inspected,
    ) -> Result<Begun<T>, Failure> {
        let part = self.part();
        let wrong = |message: String| Err(Failure::Usage(format!("{}: {message}", part.display())));
        let Inspected { meta, has_sums, .. } = earlier;
        if let Some(difference) = meta.difference(wanted) {
            let (first, second) = (difference.first, difference.second);
            return wrong(format!(
                "found a part of another picture, with {} of `{first}`; expected a part of this one, with `{second}`",
                difference.of
            ));
        }
        if (meta.window, meta.samples.start) != (wanted.window, wanted.samples.start) {
            return wrong(format!(
                "found {} from sample {}; expected a part of this one, {} from sample {}",
                pixels(meta.window),
                meta.samples.start,
                pixels(wanted.window),
                wanted.samples.start
            ));
        }
        let asked = wanted.samples.end - wanted.samples.start;
        let fewer = |there: u32| {
            wrong(format!(
                "found {there} samples, more than the {asked} requested; expected a request for at least as many"
            ))
        };
        if *has_sums {
            let film = read_partial_in::<T>(&part, basis)?.0;
            let (_, most) = film.samples();
            return if most > asked { fewer(most) } else { Ok(Begun::Sums(film)) };
        }
        match meta.samples.end - meta.samples.start {
            there if there > asked && !wanted.timed => fewer(there),
            there if there == asked || wanted.timed => Ok(Begun::Finished(there)),
            there => wrong(format!(
                "found a finished picture of {there} samples without its sums; expected one written with --keep-sums"
            )),
        }
    }

    /// Writes the film so far, for viewing and for continuing.
    pub fn write_so_far<T: Transport>(
        &self,
        basis: &T::Basis,
        meta: &Meta,
        film: impl FnOnce() -> Film<T>,
    ) -> Result<(), Failure> {
        let bytes = meta.window.area() as u64 * (SO_FAR as u64 + SUMS as u64 * <T::Radiance as Channels>::COUNT as u64);
        require(bytes).map_err(|no_room| Failure::File(format!("it takes {no_room}")))?;
        self.write_sums(&film(), basis, meta)
    }

    fn write_sums<T: Transport>(&self, film: &Film<T>, basis: &T::Basis, meta: &Meta) -> Result<(), Failure> {
        write_exr_in(&self.part(), film, basis, meta, true)?;
        if self.kind == Kind::Png {
            write_png_in(self.path, film, basis, self.tone, self.shown)?;
        }
        Ok(())
    }

    /// Writes the finished picture. If that fails, it is written elsewhere, because it may have taken hours.
    pub fn write<T: Transport>(
        &self,
        film: &Film<T>,
        basis: &T::Basis,
        meta: &Meta,
        partial: bool,
    ) -> Result<(), Failure> {
        let Err(failure) = self.write_finished(film, basis, meta, partial) else { return Ok(()) };
        let rescue = std::env::temp_dir().join(format!("lobe-{}.exr", std::process::id()));
        Err(match write_exr_in(&rescue, film, basis, meta, true) {
            Ok(()) => Failure::File(format!("{failure}; the picture and its sums are in {}", rescue.display())),
            Err(_) => failure,
        })
    }

    fn write_finished<T: Transport>(
        &self,
        film: &Film<T>,
        basis: &T::Basis,
        meta: &Meta,
        partial: bool,
    ) -> Result<(), Failure> {
        // A picture that was ended early records the samples that it has, not those that were requested.
        let samples = meta.samples.start..meta.samples.start + film.samples().1;
        let total = meta.total.min(samples.end);
        let finished = if partial { meta.clone() } else { Meta { samples, total, ..meta.clone() } };
        match self.kind {
            Kind::Exr => write_exr_in(self.path, film, basis, &finished, self.keep_sums)?,
            Kind::Png => {
                write_png_in(self.path, film, basis, self.tone, self.shown)?;
                if self.keep_sums {
                    return Ok(write_exr_in(&self.part(), film, basis, &finished, true)?);
                }
                // Only a long rendering leaves one behind.
                match std::fs::remove_file(self.part()) {
                    Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                        return Err(Failure::File(format!("{}: {error}", self.part().display())));
                    }
                    _ => {}
                }
            }
        }
        Ok(())
    }

    /// Writes an interrupted picture, and says how to continue it.
    pub fn interrupted<T: Transport>(&self, film: &Film<T>, basis: &T::Basis, meta: &Meta) -> Failure {
        let (least, most) = film.samples();
        if most == 0 {
            return Failure::Interrupted("interrupted before the first sample; nothing was written".into());
        }
        match self.write_sums(film, basis, meta) {
            Ok(()) => Failure::Interrupted(format!(
                "{}: interrupted with {least} to {most} of {} samples, which were saved; continue with the same command and --resume",
                self.path.display(),
                meta.samples.end - meta.samples.start
            )),
            Err(failure) => failure,
        }
    }
}

fn pixels(window: Rect) -> String {
    let (columns, rows) = (window.columns(), window.rows());
    format!("columns {}..{} and rows {}..{}", columns.start, columns.end, rows.start, rows.end)
}
