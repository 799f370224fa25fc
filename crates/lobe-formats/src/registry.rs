//! The list of formats, and reading and writing whatever format a file has.

use std::fmt;
use std::path::Path;

use crate::adjust::adjust;
use crate::spec::{FormatSpec, Writer};
use crate::{Document, FormatError, Place, ReadOptions, fred, goniometer, plain, sidecar};

/// One entry per format: its variant, its static description, and the feature that it needs.
macro_rules! formats {
    ($($(#[$left_out:meta])? $variant:ident = $module:ident :: $spec:ident),* $(,)?) => {
        /// A file format.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Format {
            $(
                $(#[$left_out])?
                #[doc = concat!("The format of the module `", stringify!($module), "`.")]
                $variant
            ),*
        }

        impl Format {
            /// All formats, in the order in which [`sniff`] tries them: first those with a signature, then those
            /// recognised by their size, then texts, those with the commonest words last.
            pub const ALL: &[Format] = &[$($(#[$left_out])? Format::$variant),*];

            /// What the registry knows of the format.
            pub fn spec(self) -> &'static FormatSpec {
                match self {
                    $($(#[$left_out])? Format::$variant => &crate::$module::$spec),*
                }
            }
        }
    };
}

formats! {
    #[cfg(feature = "mueller")]
    Pbsdf = pbsdf::FORMAT,
    #[cfg(feature = "rgl")]
    Rgl = rgl::FORMAT,
    #[cfg(feature = "spherical")]
    Mbsdf = mbsdf::FORMAT,
    #[cfg(feature = "window")]
    WindowXml = window_xml::FORMAT,
    Speos = speos::FORMAT,
    #[cfg(feature = "half-diff")]
    Merl = merl::FORMAT,
    #[cfg(feature = "utia")]
    Utia = utia::FORMAT,
    Zemax = zemax::FORMAT,
    LightTools = light_tools::FORMAT,
    Ssdd = ssdd::FORMAT,
    Astm = astm::FORMAT,
    #[cfg(feature = "json")]
    OpenMaterial = openmaterial::FORMAT,
    Fred = fred::FORMAT,
    Rpc = fred::RPC,
    Cornell = cornell::FORMAT,
    Alta = alta::FORMAT,
    Nist = nist::FORMAT,
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

    /// How the format is written; `None` if it is only read.
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

/// The format of a file from its content: `.bsdf` alone is the extension of four different ones. `None` if it is of no known
/// format.
pub fn sniff(bytes: &[u8]) -> Option<Format> {
    let bytes = &*plain::text(bytes);
    Format::ALL.iter().copied().find(|format| (format.spec().matches)(bytes))
}

/// Reads a file of any supported format, which is recognised by the content. Formats that do not say whether they hold
/// reflection or transmission are assumed to hold reflection; only for those of Integra does the extension decide: `.ddt` and
/// `.sdt` are transmission. If there is a [sidecar], it says what the file leaves open.
///
/// A folder is read as the RPC Photonics files in it, which are one material.
///
/// # Errors
/// [`FormatError`] if the file or its sidecar cannot be read, is of no known format, or is damaged.
pub fn open(path: &Path) -> Result<(Format, Document), FormatError> {
    open_with(path, &ReadOptions::default())
}

/// As [`open`], with options, which come before those of a [sidecar].
///
/// # Errors
/// As [`open`], and if the options do not fit the file.
pub fn open_with(path: &Path, options: &ReadOptions) -> Result<(Format, Document), FormatError> {
    let options = options.clone().or(sidecar::find(path)?);
    if path.is_dir() {
        let document = fred::open_rpc_folder(path)?;
        let document = adjusted(document, Format::Rpc, path, &options)?;
        return Ok((Format::Rpc, Document { format: Some(Format::Rpc.name()), ..document }));
    }
    let bytes = lobe_files::read(path)?;
    let format = recognised(&bytes, path, &options)?;
    Ok((format, read_with(format, &bytes, path, &options)?))
}

/// Reads the content of a file in memory, whatever its format. `path` names it in errors, and its extension counts as in
/// [`open`].
///
/// # Errors
/// As [`open`].
pub fn from_bytes(bytes: &[u8], path: &Path) -> Result<Document, FormatError> {
    from_bytes_with(bytes, path, &ReadOptions::default())
}

/// As [`from_bytes`], with options; no sidecar is looked for.
///
/// # Errors
/// As [`open_with`].
pub fn from_bytes_with(bytes: &[u8], path: &Path, options: &ReadOptions) -> Result<Document, FormatError> {
    read_with(recognised(bytes, path, options)?, bytes, path, options)
}

fn recognised(bytes: &[u8], path: &Path, options: &ReadOptions) -> Result<Format, FormatError> {
    let is_table = || !options.of_tables().is_empty() || goniometer::may_be(bytes);
    sniff(bytes).or_else(|| is_table().then_some(Format::Goniometer)).ok_or_else(|| {
        let readable = Format::ALL.iter().filter(|format| format.spec().read.is_some());
        let known: Vec<&str> = readable.map(Format::name).collect();
        let expected = format!("one of {}{}", known.join(", "), left_out());
        FormatError::new(path, Place::File, "content of no known format", expected)
    })
}

/// What a program that was built without some formats says when it recognises none.
fn left_out() -> String {
    let features = [
        ("half-diff", cfg!(feature = "half-diff")),
        ("json", cfg!(feature = "json")),
        ("mueller", cfg!(feature = "mueller")),
        ("rgl", cfg!(feature = "rgl")),
        ("spherical", cfg!(feature = "spherical")),
        ("utia", cfg!(feature = "utia")),
        ("window", cfg!(feature = "window")),
    ];
    let left_out: Vec<&str> = features.into_iter().filter(|(_, is_built)| !is_built).map(|(name, _)| name).collect();
    match left_out.is_empty() {
        true => String::new(),
        false => format!(" (built without the features {})", left_out.join(", ")),
    }
}

/// Reads `bytes` as a file of this format, whatever they look like. `path` names it in errors, and its extension counts
/// as in [`open`].
///
/// # Errors
/// [`FormatError`] if the bytes are no sound file of the format.
pub fn read(format: Format, bytes: &[u8], path: &Path) -> Result<Document, FormatError> {
    read_with(format, bytes, path, &ReadOptions::default())
}

/// As [`read`], with options.
///
/// # Errors
/// As [`read`], and if the options do not fit the file.
pub fn read_with(format: Format, bytes: &[u8], path: &Path, options: &ReadOptions) -> Result<Document, FormatError> {
    let spec = format.spec();
    let Some(read) = spec.read else {
        return Err(FormatError::new(
            path,
            Place::File,
            format!("{format}, which is only written"),
            "a format to read",
        ));
    };
    let document = read(&plain::text(bytes), path, options)?;
    Ok(Document { format: Some(spec.name), ..adjusted(document, format, path, options)? })
}

/// The values as the options say that they are.
fn adjusted(document: Document, format: Format, path: &Path, options: &ReadOptions) -> Result<Document, FormatError> {
    let is_table = format == Format::Goniometer;
    if !is_table {
        options.check_no_table(path, format.name())?;
    }
    adjust(document, options, is_table, path)
}
