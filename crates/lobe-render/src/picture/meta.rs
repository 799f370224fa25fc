//! What a picture says about itself: nothing that depends on the machine, the threads or the time.

use std::fmt;
use std::ops::Range;

use crate::film::Rect;

/// What was rendered. Kept in the EXR attribute `lobe` as lines `name = value`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Meta {
    /// Hash of everything that the value of a sample depends on: the scene, its files, the size and the integrator.
    pub scene: String,
    /// Columns and rows of the whole picture.
    pub size: [u32; 2],
    /// The pixels that were rendered.
    pub window: Rect,
    /// The numbers of the requested samples.
    pub samples: Range<u32>,
    /// How many samples the whole picture has.
    pub total: u32,
}

impl fmt::Display for Meta {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Meta { scene, size, window, samples, total } = self;
        writeln!(f, "scene = \"{scene}\"")?;
        writeln!(f, "size = [{}, {}]", size[0], size[1])?;
        writeln!(f, "window = [{}, {}, {}, {}]", window.x, window.y, window.width, window.height)?;
        writeln!(f, "samples = [{}, {}]", samples.start, samples.end)?;
        write!(f, "total = {total}")
    }
}

impl Meta {
    /// Reads what [`Display`](fmt::Display) has written. `None` if it is something else, or makes no sense.
    pub fn parse(text: &str) -> Option<Self> {
        let table = toml::de::DeTable::parse(text).ok()?;
        let table = table.get_ref();
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
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let window = Rect { x: 3, y: 4, width: 5, height: 6 };
        let meta = Meta { scene: "ab12".into(), size: [20, 10], window, samples: 8..16, total: 64 };
        assert_eq!(Meta::parse(&meta.to_string()), Some(meta.clone()));
        let outside = Meta { window: Rect { x: 16, ..window }, ..meta };
        assert_eq!(Meta::parse(&outside.to_string()), None);
        assert_eq!(Meta::parse("no = 1"), None);
    }
}
