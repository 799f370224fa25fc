//! Writes files so that they are either complete or absent.

use std::path::Path;

use anyhow::Context;

/// Replaces the file, or leaves it unchanged.
///
/// # Errors
/// If the directory cannot be written to.
pub fn replace(path: &Path, content: impl AsRef<[u8]>) -> anyhow::Result<()> {
    lobe_files::replace(path, content.as_ref()).with_context(|| format!("cannot write {}", path.display()))
}
