//! The format to write: one of those that the library can write.

use std::path::Path;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use lobe_formats::{Format, Writer};
use lobe_table::window::klems;

use crate::failure::Failure;

/// Parses the word for a format that can be written.
pub fn parser() -> impl TypedValueParser<Value = Format> {
    let value = |format: Format| {
        let held = format.writer().map_or_else(String::new, |writer| format!(": {}", holds(writer)));
        PossibleValue::new(format.spec().word).help(format!("{format}{held}"))
    };
    PossibleValuesParser::new(Format::writable().map(value))
        .try_map(|word| Format::writable().find(|format| format.spec().word == word).ok_or("no format of this name"))
}

/// A description of what a format can hold.
fn holds(writer: &Writer) -> String {
    let nodes = match writer.resampled_as {
        Ok(klems::KIND) => "Klems matrices, tensor trees",
        Ok(kind) => kind.name(),
        Err(words) => words,
    };
    let sides = if writer.holds_sheets { "; several sides" } else { "" };
    format!("{}; {nodes}{sides}", writer.channels)
}

/// A format that can be written, and its writer.
#[derive(Clone, Copy)]
pub struct Target {
    pub format: Format,
    pub writer: &'static Writer,
}

/// The requested format, or the one that the extension of the file names.
pub fn target(path: &Path, to: Option<Format>) -> Result<Target, Failure> {
    let unknown =
        |why: String| Failure::Usage(format!("{}: {why}; expected --to with the format to write", path.display()));
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let all = Format::writable().filter_map(|format| Some(Target { format, writer: format.writer()? }));
    let fits = |target: &Target| match to {
        Some(format) => target.format == format,
        None => target.writer.extensions.contains(&extension.as_str()),
    };
    let found: Vec<Target> = all.filter(fits).collect();
    match found.as_slice() {
        [target] => Ok(*target),
        [] if extension.is_empty() => Err(unknown("found no extension".into())),
        [] => Err(unknown(format!("found the extension .{extension}, which belongs to no format that lobe writes"))),
        several => {
            let name = |target: &Target| target.format.name().trim_end_matches(" BSDF");
            let names: Vec<&str> = several.iter().map(name).collect();
            Err(unknown(format!("found the extension .{extension}, which {} files share", names.join(" and "))))
        }
    }
}
