//! The picture to render, and its division into parts.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser};
use lobe::Backend;
use lobe_render::Rect;
use lobe_render::integrator::INTEGRATORS;
use lobe_render::scene::Scene;
use serde::{Deserialize, Serialize};

use crate::angles::progress;
use crate::failure::Failure;

/// Arguments for every scheduler.
#[derive(clap::Args)]
pub struct Wanted {
    /// The scene, a TOML file.
    pub scene: PathBuf,
    /// The number of parts of the picture.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST)))]
    parts: u32,
    /// Divide the picture into strips of rows, or its samples into ranges.
    #[arg(long, value_enum, default_value = "rows")]
    by: By,
    /// Samples per pixel, instead of those in the scene.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..u32::MAX as i64))]
    samples: Option<u32>,
    /// The integrator, with its default parameters, instead of the one in the scene.
    #[arg(long, value_name = "NAME", value_parser = integrators())]
    integrator: Option<String>,
    /// The instructions to use, which every machine must then have.
    #[arg(long, value_name = "NAME")]
    backend: Option<String>,
    /// Round in the same way with all instruction sets: for machines that differ.
    #[arg(long)]
    strict: bool,
    /// The path of lobe on the machines that render; by default the path of this program.
    #[arg(long, value_name = "PATH")]
    lobe: Option<PathBuf>,
}

fn integrators() -> PossibleValuesParser {
    let values: Vec<_> = INTEGRATORS.iter().map(|spec| PossibleValue::new(spec.name).help(spec.summary)).collect();
    PossibleValuesParser::new(values)
}

/// The picture that is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum By {
    /// Strips of rows.
    Rows,
    /// Ranges of samples.
    Samples,
}

/// A description of the picture that is sufficient to report progress.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Plan {
    /// The number of parts.
    pub parts: u32,
    /// The picture that is divided.
    pub by: By,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: u32,
}

/// A plan, and the way in which its parts are rendered.
pub struct Planned {
    pub plan: Plan,
    /// The scene, relative to the root.
    pub scene: PathBuf,
    /// All files that it reads, relative to the root, starting with itself.
    pub files: Vec<PathBuf>,
    /// The path of lobe on the machines that render.
    pub lobe: PathBuf,
    /// Options of `lobe render` for all parts.
    pub options: Vec<String>,
}

impl Wanted {
    /// Reads the scene, so that mistakes are found before it reaches a machine, and divides the picture.
    ///
    /// # Errors
    /// If the scene cannot be read, or cannot be divided in this way.
    pub fn plan(&self) -> Result<Planned, Failure> {
        if lobe_files::is_standard_input(&self.scene) {
            let message = "-: found the standard input, which the machines that render cannot read; expected a file";
            return Err(Failure::Usage(message.into()));
        }
        let backend = match &self.backend {
            Some(name) => Backend::named(name).map_err(|error| Failure::Usage(error.to_string()))?,
            None => Backend::detect().map_err(|error| Failure::Usage(format!("LOBE_BACKEND: {error}")))?,
        };
        let bar = progress("reading the scene");
        let scene = Scene::open_with_progress(&self.scene, backend, &mut |share| bar(share));
        drop(bar);
        let scene = scene.map_err(|error| Failure::File(error.to_string()))?;
        let samples = self.samples.unwrap_or(scene.samples);
        let plan = Plan { parts: self.parts, by: self.by, size: scene.size, samples };
        let (most, what) = match self.by {
            By::Rows => (scene.size[1], "rows"),
            By::Samples => (samples, "samples"),
        };
        if self.parts > most {
            let message = format!("--parts: found {} parts; expected at most {most}, the number of {what}", self.parts);
            return Err(Failure::Usage(message));
        }
        let mut options = vec!["--samples".into(), samples.to_string()];
        for (name, value) in [("--integrator", &self.integrator), ("--backend", &self.backend)] {
            if let Some(value) = value {
                options.extend([name.into(), value.clone()]);
            }
        }
        if self.strict {
            options.push("--strict".into());
        }
        let lobe = match &self.lobe {
            Some(lobe) => lobe.clone(),
            None => std::env::current_exe().map_err(|error| Failure::File(format!("this program: {error}")))?,
        };
        let files = scene.files.iter().map(|file| absolute(file)).collect::<Result<_, _>>()?;
        Ok(Planned { plan, scene: absolute(&self.scene)?, files, lobe, options })
    }
}

/// The absolute path; machines do not share a working folder.
///
/// # Errors
/// If there is no working folder.
pub fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    std::path::absolute(path).map_err(|error| Failure::File(format!("{}: {error}", path.display())))
}

/// The most parts of a picture.
const MOST: u32 = 100_000;

impl Plan {
    /// `true` if a picture can be divided in this way, because a file may contain anything.
    pub fn is_sound(&self) -> bool {
        let [width, height] = self.size.map(u64::from);
        let most = match self.by {
            By::Rows => self.size[1],
            By::Samples => self.samples,
        };
        let work = (width * height).checked_mul(u64::from(self.samples));
        (1..=most.min(MOST)).contains(&self.parts) && work.is_some_and(|work| work > 0)
    }

    /// The option of `lobe render` for part `part`, counted from 1.
    pub fn option(&self, part: u32) -> [String; 2] {
        match self.by {
            By::Rows => ["--tile".into(), format!("{part}/{}", self.parts)],
            By::Samples => {
                let [from, to] = [part - 1, part].map(|part| self.cut(part));
                ["--samples-range".into(), format!("{from}..{to}")]
            }
        }
    }

    /// The end of the samples of part `part`.
    fn cut(&self, part: u32) -> u32 {
        (u64::from(self.samples) * u64::from(part) / u64::from(self.parts)) as u32
    }

    /// The number of pixel samples of a part.
    pub fn work(&self, part: u32) -> u64 {
        let [width, height] = self.size;
        let whole = Rect { x: 0, y: 0, width, height };
        match self.by {
            By::Rows => whole.strip(part, self.parts).map_or(0, |strip| strip.area() as u64) * u64::from(self.samples),
            By::Samples => whole.area() as u64 * u64::from(self.cut(part) - self.cut(part - 1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plan_of_any_numbers_is_cut_or_refused() {
        let sound = Plan { parts: 3, by: By::Samples, size: [5, 9], samples: 7 };
        assert!(sound.is_sound());
        for wrong in [
            Plan { parts: 0, ..sound.clone() },
            Plan { parts: 8, ..sound.clone() },
            Plan { parts: 10, by: By::Rows, ..sound.clone() },
            Plan { parts: u32::MAX, samples: u32::MAX, ..sound.clone() },
            Plan { size: [u32::MAX; 2], samples: u32::MAX, ..sound.clone() },
            Plan { size: [0, 9], ..sound.clone() },
            Plan { samples: 0, ..sound },
        ] {
            assert!(!wrong.is_sound(), "{wrong:?}");
        }
    }

    #[test]
    fn parts_are_the_whole_picture() {
        for by in [By::Rows, By::Samples] {
            for parts in 1..=7 {
                let plan = Plan { parts, by, size: [5, 9], samples: 7 };
                assert_eq!((1..=parts).map(|part| plan.work(part)).sum::<u64>(), 5 * 9 * 7);
                assert!((1..=parts).all(|part| plan.work(part) > 0));
            }
        }
        let plan = Plan { parts: 3, by: By::Samples, size: [1, 1], samples: 8 };
        let ranges: Vec<String> = (1..=3).map(|part| plan.option(part)[1].clone()).collect();
        assert_eq!(ranges, ["0..2", "2..5", "5..8"]);
    }
}
