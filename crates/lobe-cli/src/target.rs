//! The formats that can be written, and what each can hold.

use std::fmt;
use std::path::Path;

use clap::ValueEnum;
use lobe::{Channels, Scatter};

use crate::failure::Failure;

/// A format to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// Integra DDR (reflection) or DDT (transmission).
    Ddr,
    /// Integra SDR or SDT: mirror reflectance only.
    Sdr,
    /// SSDD of libbsdf, in decimal numbers.
    Ssdd,
    /// Zemax tabular BSDF.
    Zemax,
    /// MERL binary: isotropic reflection in RGB.
    Merl,
    /// RGL tensor file with its parameterisation: reflection.
    Rgl,
    /// WINDOW XML of Klems matrices, both sides.
    Klems,
    /// CSV with named columns.
    Csv,
    /// NumPy arrays.
    Npz,
}

impl Target {
    /// The requested format, or the one that the extension of the file names.
    pub fn of(path: &Path, to: Option<Target>) -> Result<Target, Failure> {
        if let Some(target) = to {
            return Ok(target);
        }
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let unknown = |why: &str| {
            Err(Failure::Usage(format!("{}: {why}; expected --to with the format to write", path.display())))
        };
        Ok(match extension.as_str() {
            "ddr" | "ddt" => Target::Ddr,
            "sdr" | "sdt" => Target::Sdr,
            "ssdd" => Target::Ssdd,
            "binary" => Target::Merl,
            "xml" => Target::Klems,
            "csv" => Target::Csv,
            "npz" => Target::Npz,
            "bsdf" => return unknown("found the extension .bsdf, which RGL and Zemax files share"),
            "" => return unknown("found no extension"),
            other => return unknown(&format!("found the extension .{other}, which no format that lobe writes has")),
        })
    }

    /// What these channels become in this format, and how: `None` if it has nothing like them.
    pub fn holds(self, channels: &Channels) -> bool {
        match self {
            Target::Ddr | Target::Sdr => matches!(channels, Channels::Mono | Channels::Rgb | Channels::Spectral(_)),
            Target::Ssdd | Target::Csv => !matches!(channels, Channels::Named(_)),
            Target::Zemax => matches!(channels, Channels::Mono | Channels::Xyz),
            Target::Merl => matches!(channels, Channels::Rgb),
            Target::Rgl => matches!(channels, Channels::Rgb | Channels::Spectral(_)),
            Target::Klems => matches!(channels, Channels::Mono | Channels::Xyz | Channels::Named(_)),
            Target::Npz => true,
        }
    }

    /// The channels for people.
    pub fn channels(self) -> &'static str {
        match self {
            Target::Ddr | Target::Sdr => "one channel, R G B or wavelengths",
            Target::Ssdd | Target::Csv => "one channel, R G B, X Y Z or wavelengths",
            Target::Zemax => "one channel or X Y Z",
            Target::Merl => "R G B",
            Target::Rgl => "R G B or wavelengths",
            Target::Klems => "one channel, X Y Z or named bands",
            Target::Npz => "any channels",
        }
    }

    /// The only side that a file of this name can hold, if its name or format implies one.
    pub fn side(self, path: &Path) -> Option<Scatter> {
        let is_transmission =
            path.extension().is_some_and(|e| e.eq_ignore_ascii_case("ddt") || e.eq_ignore_ascii_case("sdt"));
        match self {
            Target::Ddr | Target::Sdr if is_transmission => Some(Scatter::Transmission),
            Target::Ddr | Target::Sdr | Target::Merl | Target::Rgl => Some(Scatter::Reflection),
            Target::Ssdd | Target::Zemax | Target::Klems | Target::Csv | Target::Npz => None,
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Target::Ddr => "Integra DDR/DDT",
            Target::Sdr => "Integra SDR/SDT",
            Target::Ssdd => "SSDD",
            Target::Zemax => "Zemax BSDF",
            Target::Merl => "MERL",
            Target::Rgl => "RGL BSDF",
            Target::Klems => "WINDOW XML",
            Target::Csv => "CSV",
            Target::Npz => "NumPy npz",
        })
    }
}
