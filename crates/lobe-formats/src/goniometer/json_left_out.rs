//! The replacement for the JSON reader in programs built without it.

use std::path::Path;

use super::raw::Raw;
use crate::reading::ReadOptions;
use crate::{FormatError, Place};

/// `true` for every text that looks like JSON, so that it is refused with the reason.
pub(super) fn matches(_: &str) -> bool {
    true
}

/// Refuses it.
pub(super) fn read(_: &[u8], file: &Path, _: &ReadOptions) -> Result<Raw, FormatError> {
    Err(FormatError::new(file, Place::File, "JSON", "another format: this program was built without the feature json"))
}
