//! Small renderings, for trying commands out.

use std::ops::Range;
use std::time::Duration;

use crate::failure::Failure;

/// The variable that makes renderings small.
const VARIABLE: &str = "LOBE_DRAFT";

/// Divides sample counts and time limits by the value of `LOBE_DRAFT`, or by 1 if it is not set.
#[derive(Clone, Copy, Debug)]
pub struct Draft(u32);

impl Draft {
    /// Reads the environment.
    pub fn from_environment() -> Result<Self, Failure> {
        let Some(value) = std::env::var_os(VARIABLE) else { return Ok(Draft(1)) };
        let divisor = value.to_str().and_then(|text| text.parse().ok()).filter(|divisor| *divisor > 0);
        divisor.map(Draft).ok_or_else(|| {
            Failure::Usage(format!("{VARIABLE}: found `{}`; expected a whole number above 0", value.display()))
        })
    }

    /// At least one sample.
    pub fn samples(self, samples: u32) -> u32 {
        samples.div_ceil(self.0)
    }

    /// Adjacent ranges stay adjacent.
    pub fn range(self, range: &Range<u32>) -> Range<u32> {
        let start = range.start / self.0;
        start..(range.end / self.0).max(start + 1)
    }

    /// Divides a time limit.
    pub fn time(self, time: Duration) -> Duration {
        time / self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_picture_stay_its_parts() {
        let draft = Draft(32);
        assert_eq!((draft.samples(64), draft.samples(1), draft.samples(33)), (2, 1, 2));
        assert_eq!((draft.range(&(0..32)), draft.range(&(32..64))), (0..1, 1..2));
        assert_eq!(Draft(64).range(&(64..128)), 1..2);
        assert_eq!(Draft(1).range(&(5..7)), 5..7);
    }
}
