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

fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    // Temporary files are private by default; this one becomes an ordinary file, under the user's umask.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(content)?;
    file.as_file().sync_all()?;
    file.persist(path)?;
    Ok(())
}

/// Why `path` was not written: the file system refused, or the material does not fit the format.
pub(crate) fn unwritable(path: &Path, error: &io::Error) -> FormatError {
    let expected = match error.kind() {
        ErrorKind::InvalidInput => "a material that fits the format",
        _ => "a file that can be written",
    };
    FormatError::new(path, Place::File, error.to_string(), expected)
}
