//! The list of formats, and the recognition of the format of a file.

use std::fmt;

use crate::plain;
use crate::spec::{FormatSpec, Writer};

/// One entry per format: its variant, its static description, and the feature that it needs.
macro_rules! formats {
    ($($(#[$left_out:meta])? $variant:ident = $($path:ident)::+),* $(,)?) => {
        /// A file format.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Format {
            $(
                $(#[$left_out])?
                #[doc = concat!("The format of `", stringify!($($path)::+), "`.")]
                $variant
            ),*
        }

        impl Format {
            /// All formats, in the order in which [`sniff`] tries them: first those with a signature, then those
            /// recognised by their size, then texts, with the least distinctive last.
            pub const ALL: &[Format] = &[$($(#[$left_out])? Format::$variant),*];

            /// The static description of the format.
            pub fn spec(self) -> &'static FormatSpec {
                match self {
                    $($(#[$left_out])? Format::$variant => &crate::$($path)::+),*
                }
            }
        }
    };
}

formats! {
    #[cfg(feature = "mueller")]
    Pbsdf = pbsdf::FORMAT,
    #[cfg(feature = "mueller")]
    Polarised = polarised::FORMAT,
    #[cfg(feature = "rgl")]
    Rgl = rgl::FORMAT,
    #[cfg(feature = "spherical")]
    Mbsdf = mbsdf::FORMAT,
    Fourier = fourier::FORMAT,
    #[cfg(feature = "window")]
    WindowXml = window_xml::FORMAT,
    Speos = speos::FORMAT,
    SpeosSurface = speos::surface::FORMAT,
    Merl = merl::FORMAT,
    Utia = utia::FORMAT,
    Zemax = zemax::FORMAT,
    LightTools = light_tools::FORMAT,
    Ssdd = ssdd::FORMAT,
    Astm = astm::FORMAT,
    #[cfg(feature = "json")]
    OpenMaterial = openmaterial::FORMAT,
    Fred = fred::FORMAT,
    Rpc = fred::RPC,
    Pab = pab::FORMAT,
    TracePro = tracepro::FORMAT,
    Cornell = cornell::FORMAT,
    Alta = alta::FORMAT,
    #[cfg(feature = "mueller")]
    MuellerCsv = mueller_csv::FORMAT,
    Nist = nist::FORMAT,
    Zernike = zernike::FORMAT,
    Lumos = lumos::FORMAT,
    Goniometer = goniometer::FORMAT,
    Ddr = ddr::FORMAT,
    Sdr = sdr::FORMAT,
    Npz = npz::FORMAT,
}

impl Format {
    /// The name for people.
    pub fn name(&self) -> &'static str {
        self.spec().name
    }

    /// The writer of the format; `None` if it is only read.
    pub fn writer(self) -> Option<&'static Writer> {
        self.spec().writer.as_ref()
    }

    /// The formats that can be written.
    pub fn writable() -> impl Iterator<Item = Format> {
        Format::ALL.iter().copied().filter(|format| format.writer().is_some())
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The format of a file from its content: `.bsdf` alone is the extension of four different formats. `None` if no known
/// format matches.
pub fn sniff(bytes: &[u8]) -> Option<Format> {
    let bytes = &*plain::text(bytes);
    Format::ALL.iter().copied().find(|format| (format.spec().matches)(bytes))
}
