//! Folders of files that form one material: formats with one incident direction per file.

use std::path::{Path, PathBuf};

use lobe_files::{files_of, unpacked};

use crate::{Document, Format, FormatError, Place, plain, sniff};

/// The names and the contents of files.
type Files = Vec<(PathBuf, Vec<u8>)>;

/// Reads the files of a folder in a format with one incident direction per file, as one material. Other files and
/// subfolders are ignored.
///
/// # Errors
/// [`FormatError`] if the folder or a file cannot be read, if there is no such file, or if there are files of several
/// such formats.
pub(crate) fn open(folder: &Path) -> Result<(Format, Document), FormatError> {
    let paths = files_of(folder)
        .map_err(|error| FormatError::new(folder, Place::File, error.to_string(), "files that can be read"))?;
    let mut found: Option<(Format, Files)> = None;
    let mut others: Vec<&str> = Vec::new();
    for path in paths {
        let bytes = lobe_files::read(&path)?;
        let bytes = plain::text(&unpacked(&bytes, &path)?.bytes).into_owned();
        let Some(format) = sniff(&bytes) else { continue };
        if format.spec().read_set.is_none() {
            others.push(format.name());
            continue;
        }
        let (first, files) = found.get_or_insert_with(|| (format, Vec::new()));
        if *first != format {
            let found = format!("files of {first} and of {format}");
            return Err(FormatError::new(folder, Place::File, found, "those of one material"));
        }
        files.push((path, bytes));
    }
    let sets = || Format::ALL.iter().filter_map(|format| Some((format, format.spec().read_set?)));
    let found = found.and_then(|(format, files)| Some((format, files, format.spec().read_set?)));
    let Some((format, files, read_set)) = found else {
        let names: Vec<&str> = sets().map(|(format, _)| format.name()).collect();
        let mut expected = format!("files of one incident direction each ({})", names.join(" or "));
        others.sort_unstable();
        others.dedup();
        let found = match others.is_empty() {
            true => "a folder without measurements".into(),
            false => format!("a folder with files of other formats ({})", others.join(", ")),
        };
        if !others.is_empty() {
            expected += ", or one of the files by its own name";
        }
        if others.contains(&Format::Goniometer.name()) {
            expected +=
                "; tables of one incident direction each have to be joined into one table, with a column theta_i";
        }
        return Err(FormatError::new(folder, Place::File, found, expected));
    };
    Ok((format, read_set(&files)?))
}
