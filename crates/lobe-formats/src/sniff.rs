//! Which format a file has, told from its content: `.bsdf` alone is the extension of four different ones.

use std::fmt;

use crate::text::has_words;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Zemax (Radiant Imaging) tabular BSDF, `.bsdf`.
    Zemax,
    /// Integra DDR or DDT.
    Ddr,
    /// Integra SDR or SDT.
    Sdr,
}

impl Format {
    /// All formats, in the order in which [`sniff`] tries them.
    pub const ALL: &[Format] = &[Format::Zemax, Format::Ddr, Format::Sdr];

    /// The name for people.
    pub fn name(&self) -> &'static str {
        match self {
            Format::Zemax => "Zemax BSDF",
            Format::Ddr => "Integra DDR/DDT",
            Format::Sdr => "Integra SDR/SDT",
        }
    }

    /// `true` where the content looks like this format. Formats later in [`Format::ALL`] may look alike.
    fn matches(self, bytes: &[u8]) -> bool {
        let integra = |words: &[&str]| has_words(bytes, ";;", words);
        match self {
            Format::Zemax => has_words(bytes, "#", &["ScatterRadial", "AngleOfIncidence"]),
            Format::Ddr => {
                integra(&["TypeSym"])
                    || integra(&["kbdf"])
                    || integra(&["TypeData"])
                    || integra(&["sigma", "theta", "phi"])
            }
            Format::Sdr => integra(&["sigma", "def"]) || integra(&["sigma", "TypeColorModel"]),
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The format of a file from its content; `None` where it is none that is known.
pub fn sniff(bytes: &[u8]) -> Option<Format> {
    Format::ALL.iter().copied().find(|format| format.matches(bytes))
}
