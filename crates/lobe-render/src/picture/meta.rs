//! Metadata of a picture, none of which depends on the machine, the threads or the time.

use std::fmt;
use std::ops::Range;

use crate::film::Rect;
use crate::shader::Backend;

/// Description of a picture, kept in the EXR attribute `lobe` as lines `name = value`.
#[derive(Clone, Debug, PartialEq)]
pub struct Meta {
    /// Hash of everything that the value of a sample depends on: the scene, its files, the size and the integrator.
    pub scene: String,
    /// Columns and rows of the whole picture.
    pub size: [u32; 2],
    /// The pixels that were rendered.
    pub window: Rect,
    /// The indices of the requested samples.
    pub samples: Range<u32>,
    /// Number of samples of the whole picture.
    pub total: u32,
    /// `true` if a time limit ended the rendering, so that pixels may have fewer samples than requested.
    pub timed: bool,
    /// The exposure of the scene in stops, for files that are tone-mapped.
    pub exposure: f32,
    /// The version of the program; empty in files from versions that did not record it.
    pub version: String,
    /// How numbers were rounded: [`Meta::arithmetic_of`] the backend; empty in the same files as `version`.
    pub arithmetic: String,
}

/// A difference between two pictures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The property that differs.
    pub of: &'static str,
    /// Its value in the first picture.
    pub first: String,
    /// Its value in the second picture.
    pub second: String,
}

impl fmt::Display for Meta {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Meta { scene, size, window, samples, total, timed, exposure, version, arithmetic } = self;
        writeln!(f, "scene = \"{scene}\"")?;
        writeln!(f, "size = [{}, {}]", size[0], size[1])?;
        writeln!(f, "window = [{}, {}, {}, {}]", window.x, window.y, window.width, window.height)?;
        writeln!(f, "samples = [{}, {}]", samples.start, samples.end)?;
        writeln!(f, "total = {total}")?;
        writeln!(f, "timed = {timed}")?;
        writeln!(f, "exposure = {exposure:?}")?;
        writeln!(f, "version = \"{version}\"")?;
        write!(f, "arithmetic = \"{arithmetic}\"")
    }
}

impl Meta {
    /// The version of this program.
    pub const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// How a backend rounds: all backends in strict form alike, each in its own way otherwise.
    pub fn arithmetic_of(backend: Backend) -> String {
        match backend.has_fused_form() && !backend.is_strict() {
            true => format!("fused, {}", backend.name()),
            false => "strict".into(),
        }
    }

    /// The reason why the samples of two files do not belong to one picture; `None` if they do.
    pub fn difference(&self, other: &Meta) -> Option<Difference> {
        let size = |meta: &Meta| format!("{} x {} pixels", meta.size[0], meta.size[1]);
        let differing = |of, first: &str, second: &str| {
            let difference = Difference { of, first: first.into(), second: second.into() };
            (first != second).then_some(difference)
        };
        differing("the version", &self.version, &other.version)
            .or_else(|| differing("the arithmetic", &self.arithmetic, &other.arithmetic))
            .or_else(|| differing("the scene", &self.scene, &other.scene))
            .or_else(|| differing("a size", &size(self), &size(other)))
    }

    /// Reads text written by [`Display`](fmt::Display). `None` for any other text, or if values in it are invalid.
    pub fn parse(text: &str) -> Option<Self> {
        let table = toml::de::DeTable::parse(text).ok()?;
        let table = table.get_ref();
        let text =
            |name: &str| table.get(name).and_then(|value| value.get_ref().as_str()).unwrap_or_default().to_owned();
        let exposure = table.get("exposure").and_then(|value| value.get_ref().as_float()?.as_str().parse().ok());
        let number = |value: &toml::de::DeValue<'_>| value.as_integer()?.as_str().parse::<u32>().ok();
        let numbers = |name: &str| -> Option<Vec<u32>> {
            table.get(name)?.get_ref().as_array()?.iter().map(|value| number(value.get_ref())).collect()
        };
        let size: [u32; 2] = numbers("size")?.try_into().ok()?;
        let [x, y, width, height]: [u32; 4] = numbers("window")?.try_into().ok()?;
        let [start, end]: [u32; 2] = numbers("samples")?.try_into().ok()?;
        let window = Rect { x, y, width, height };
        let inside = u64::from(x) + u64::from(width) <= u64::from(size[0])
            && u64::from(y) + u64::from(height) <= u64::from(size[1]);
        let sound = inside && width > 0 && height > 0 && start <= end;
        sound.then_some(Meta {
            scene: table.get("scene")?.get_ref().as_str()?.to_owned(),
            size,
            window,
            samples: start..end,
            total: number(table.get("total")?.get_ref())?,
            timed: table.get("timed").and_then(|value| value.get_ref().as_bool()).unwrap_or(false),
            exposure: exposure.filter(|stops: &f32| stops.is_finite()).unwrap_or(0.0),
            version: text("version"),
            arithmetic: text("arithmetic"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_metadata_is_read_back() {
        let window = Rect { x: 3, y: 4, width: 5, height: 6 };
        let meta = Meta {
            scene: "ab12".into(),
            size: [20, 10],
            window,
            samples: 8..16,
            total: 64,
            timed: true,
            exposure: -1.5,
            version: Meta::VERSION.into(),
            arithmetic: Meta::arithmetic_of(Backend::best()),
        };
        assert_eq!(Meta::parse(&meta.to_string()), Some(meta.clone()));
        let outside = Meta { window: Rect { x: 16, ..window }, ..meta };
        assert_eq!(Meta::parse(&outside.to_string()), None);
        assert_eq!(Meta::parse("no = 1"), None);
    }

    #[test]
    fn the_difference_of_pictures_is_named() {
        let text = "scene = \"ab12\"\nsize = [2, 2]\nwindow = [0, 0, 2, 2]\nsamples = [0, 4]\ntotal = 4";
        let old = Meta::parse(text).expect("a file from a version that recorded less");
        assert_eq!(old.difference(&old), None);
        for (other, of) in [
            (Meta { version: "9".into(), ..old.clone() }, "the version"),
            (Meta { arithmetic: "strict".into(), ..old.clone() }, "the arithmetic"),
            (Meta { scene: "cd34".into(), ..old.clone() }, "the scene"),
            (Meta { size: [4, 2], ..old.clone() }, "a size"),
        ] {
            assert_eq!(old.difference(&other).map(|difference| difference.of), Some(of));
        }
        assert_eq!(old.difference(&Meta { total: 9, exposure: 1.0, timed: true, ..old.clone() }), None);
        for backend in Backend::available() {
            assert_eq!(Meta::arithmetic_of(backend.strict()), "strict");
        }
    }
}
