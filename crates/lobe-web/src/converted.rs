//! Converts materials to files in other formats.

use std::path::{Path, PathBuf};

use lobe_files::{Files, in_memory};
use lobe_formats::{Format, convert};
use serde::Serialize;

use crate::Opened;

/// A format in which files can be written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Target {
    /// The word for the format on the command line.
    pub word: &'static str,
    /// The name of the format.
    pub name: &'static str,
    /// The extension of its files.
    pub extension: &'static str,
    /// `true` if the format has the representation of the material, so that nodes and values are written unchanged.
    pub is_exact: bool,
}

/// A file that was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Converted {
    /// The name of the file.
    pub name: String,
    /// The contents of the file.
    pub bytes: Vec<u8>,
    /// How the channels were changed; empty if they were not.
    pub note: String,
}

/// The formats in which files can be written; those with the representation of the material come first.
pub fn targets(opened: &Opened) -> Vec<Target> {
    let document = &opened.subject.measured().document;
    let target = |format: Format| {
        let writer = format.writer()?;
        let extension = writer.extensions.first()?;
        Some(Target { word: format.spec().word, name: format.name(), extension, is_exact: (writer.holds)(document) })
    };
    let mut targets: Vec<Target> = Format::writable().filter_map(target).collect();
    targets.sort_by_key(|target| !target.is_exact);
    targets
}

/// Converts the material to a file in another format, with the same nodes and values. If `channel` is not empty, only
/// the channel of that name is written.
///
/// # Errors
/// If the format does not have the representation or the channels of the material. The message is that of the program.
pub fn converted(opened: &Opened, word: &str, channel: &str) -> Result<Converted, String> {
    let format = Format::writable().find(|format| format.spec().word == word);
    let format = format.ok_or_else(|| format!("found the format {word}; expected one that can be written"))?;
    let document = &opened.subject.measured().document;
    let extension = format.writer().and_then(|writer| writer.extensions.first()).copied().unwrap_or("txt");
    let stem = Path::new(opened.subject.name()).file_stem().map_or("material".into(), |stem| stem.to_string_lossy());
    let path = PathBuf::from(format!("{stem}.{extension}"));
    let channel = (!channel.is_empty()).then_some(channel);
    let (written, mut files) = in_memory(Files::new(), || convert(document, format, channel, &path));
    let Some(written) = written.map_err(|error| error.to_string())? else {
        let kinds = document.kinds();
        return Err(format!(
            "{format}: found {kinds}; expected a representation that the format has. To resample: lobe convert {} {} \
             --to {word}",
            opened.subject.name(),
            path.display()
        ));
    };
    let bytes = files.remove(&path).ok_or_else(|| format!("{format}: nothing was written"))?;
    Ok(Converted { name: path.display().to_string(), bytes, note: written.note.unwrap_or_default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Session;

    #[test]
    fn what_is_written_opens_with_the_same_values() {
        let mut session = Session::new();
        session.add("paint.ddr", std::fs::read(lobe_testing::files::fixture("paint-12x21x13.ddr")).unwrap());
        let paint = session.open("paint.ddr").unwrap();
        let exact: Vec<Target> =
            targets(session.opened(paint).unwrap()).into_iter().filter(|target| target.is_exact).collect();
        assert!(exact.len() >= 3, "{exact:?}");
        for target in exact {
            let written = converted(session.opened(paint).unwrap(), target.word, "").unwrap();
            if Format::ALL.iter().any(|format| format.spec().word == target.word && format.spec().read.is_none()) {
                continue;
            }
            session.add(&written.name, written.bytes);
            let again = session.open(&written.name).unwrap();
            let value = |number| {
                let material = session.opened(number).unwrap().subject.material().clone();
                let mut value = vec![0.0; material.channel_count()];
                material.eval([0.6, 0.0, 0.8], [-0.5, 0.0, 0.866], &mut value);
                value
            };
            if written.note.is_empty() {
                assert_eq!(value(paint), value(again), "{}", target.word);
            }
        }
        let error = converted(session.opened(paint).unwrap(), "rgl", "").unwrap_err();
        assert!(error.contains("lobe convert paint.ddr"), "{error}");
    }
}
