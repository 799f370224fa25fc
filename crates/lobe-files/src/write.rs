//! Writing a file so that it is whole or not there.

use std::io::{self, ErrorKind, Write as _};
use std::path::Path;

use crate::{FormatError, Place};

/// Writes `content` to a temporary file next to `path` and renames it, so that no half-written file is ever visible.
///
/// # Errors
/// [`FormatError`] if the folder or the file cannot be written.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), FormatError> {
    replace(path, content).map_err(|error| unwritable(path, &error))
}

/// As [`write_whole`], with the error of the system. A file that is replaced keeps its permissions; a new one has those of
/// the user's umask.
///
/// # Errors
/// If the folder or the file cannot be written.
pub fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".lobe-");
    // Temporary files are private by default; this one becomes an ordinary file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(content)?;
    if let Ok(old) = std::fs::metadata(path) {
        file.as_file().set_permissions(old.permissions())?;
    }
    file.as_file().sync_all()?;
    file.persist(path)?;
    Ok(())
}

/// Why `path` was not written: the file system refused, or the material does not fit the format.
pub fn unwritable(path: &Path, error: &io::Error) -> FormatError {
    let expected = match error.kind() {
        ErrorKind::InvalidInput => "a material that fits the format",
        _ => "a file that can be written",
    };
    FormatError::new(path, Place::File, error.to_string(), expected)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_whole(&path, b"old").unwrap();
        write_whole(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_replaced_file_keeps_its_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_whole(&path, b"old").unwrap();
        std::fs::set_permissions(&path, PermissionsExt::from_mode(0o640)).unwrap();
        write_whole(&path, b"new").unwrap();
        assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[test]
    fn a_folder_that_is_missing_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_whole(&folder.path().join("none/a"), b"").unwrap_err();
        assert!(error.file.ends_with("none/a") && error.expected == "a file that can be written", "{error}");
    }
}
