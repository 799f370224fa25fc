//! Recognises the format of a file from its content: `.bsdf` alone is the extension of four different ones.

use std::fmt;

use crate::text::has_words;
use crate::{
    alta, astm, cornell, fred, goniometer, light_tools, lumos, mbsdf, merl, nist, openmaterial, pbsdf, speos, ssdd,
    tensor, utia, window_xml,
};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Polarised materials of KAIST, `.pbsdf`.
    Pbsdf,
    /// Materials of the EPFL database, `.bsdf`.
    Rgl,
    /// NVIDIA MDL, `.mbsdf`.
    Mbsdf,
    /// WINDOW and Radiance, `.xml`.
    WindowXml,
    /// Ansys Speos, `.brdf` and `.anisotropicbsdf`.
    Speos,
    /// Materials of the MERL database, `.binary`.
    Merl,
    /// Materials of the UTIA database, `.bin`.
    Utia,
    /// Zemax (Radiant Imaging) tabular BSDF, `.bsdf`.
    Zemax,
    /// LightTools, `.bsdf`.
    LightTools,
    /// SSDD of libbsdf.
    Ssdd,
    /// ASTM E1392.
    Astm,
    /// ASAM OpenMATERIAL 3D, `.xompt`.
    OpenMaterial,
    /// FRED tables.
    Fred,
    /// RPC Photonics (VIAVI): one incident direction of a diffuser a file.
    Rpc,
    /// The Cornell Program of Computer Graphics, `.brdf`.
    Cornell,
    /// ALTA, `.dat`.
    Alta,
    /// NIST's polarised PTFE, `.csv`.
    Nist,
    /// lumos-sat, `.csv`.
    Lumos,
    /// CSV or JSON with named columns.
    Goniometer,
    /// Integra DDR or DDT.
    Ddr,
    /// Integra SDR or SDT.
    Sdr,
}

impl Format {
    /// All formats, in the order in which [`sniff`] tries them: first those with a signature, then those recognised by
    /// their size, then texts, those with the commonest words last.
    pub const ALL: &[Format] = &[
        Format::Pbsdf,
        Format::Rgl,
        Format::Mbsdf,
        Format::WindowXml,
        Format::Speos,
        Format::Merl,
        Format::Utia,
        Format::Zemax,
        Format::LightTools,
        Format::Ssdd,
        Format::Astm,
        Format::OpenMaterial,
        Format::Fred,
        Format::Rpc,
        Format::Cornell,
        Format::Alta,
        Format::Nist,
        Format::Lumos,
        Format::Goniometer,
        Format::Ddr,
        Format::Sdr,
    ];

    /// The name for people.
    pub fn name(&self) -> &'static str {
        match self {
            Format::Pbsdf => "KAIST pBSDF",
            Format::Rgl => "RGL BSDF",
            Format::Mbsdf => "MDL MBSDF",
            Format::WindowXml => "WINDOW XML",
            Format::Speos => "Speos BSDF",
            Format::Merl => "MERL",
            Format::Utia => "UTIA",
            Format::Zemax => "Zemax BSDF",
            Format::LightTools => "LightTools BSDF",
            Format::Ssdd => "SSDD",
            Format::Astm => "ASTM E1392",
            Format::OpenMaterial => "OpenMATERIAL 3D",
            Format::Fred => "FRED",
            Format::Rpc => "RPC Photonics",
            Format::Cornell => "Cornell BRDF",
            Format::Alta => "ALTA",
            Format::Nist => "NIST Mueller CSV",
            Format::Lumos => "lumos-sat CSV",
            Format::Goniometer => "table with named columns",
            Format::Ddr => "Integra DDR/DDT",
            Format::Sdr => "Integra SDR/SDT",
        }
    }

    /// `true` if the content looks like this format. Formats later in [`Format::ALL`] may look alike.
    fn matches(self, bytes: &[u8]) -> bool {
        let integra = |words: &[&str]| has_words(bytes, ";;", words);
        match self {
            Format::Pbsdf => pbsdf::matches(bytes),
            // Every other tensor file, so that the reader may say what is missing in it.
            Format::Rgl => tensor::matches(bytes),
            Format::Mbsdf => mbsdf::matches(bytes),
            Format::WindowXml => window_xml::matches(bytes),
            Format::Speos => speos::matches(bytes),
            Format::Merl => merl::matches(bytes),
            Format::Utia => utia::matches(bytes),
            Format::Zemax => has_words(bytes, "#", &["ScatterRadial", "AngleOfIncidence"]),
            Format::LightTools => light_tools::matches(bytes),
            Format::Ssdd => ssdd::matches(bytes),
            Format::Astm => astm::matches(bytes),
            Format::OpenMaterial => openmaterial::matches(bytes),
            Format::Fred => fred::matches(bytes),
            Format::Rpc => fred::matches_rpc(bytes),
            Format::Cornell => cornell::matches(bytes),
            Format::Alta => alta::matches(bytes),
            Format::Nist => nist::matches(bytes),
            Format::Lumos => lumos::matches(bytes),
            Format::Goniometer => goniometer::matches(bytes),
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

/// The format of a file from its content; `None` if it is unknown.
pub fn sniff(bytes: &[u8]) -> Option<Format> {
    Format::ALL.iter().copied().find(|format| format.matches(bytes))
}
