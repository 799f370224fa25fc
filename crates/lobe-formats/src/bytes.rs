//! Reading binary files from front to back, never past their end.

use lobe_files::{FormatError, Place};
use std::path::Path;

/// A place in the bytes of a file.
pub(crate) struct Cursor<'a, 'f> {
    pub bytes: &'a [u8],
    pub at: usize,
    pub file: &'f Path,
}

impl<'a, 'f> Cursor<'a, 'f> {
    pub fn new(bytes: &'a [u8], file: &'f Path) -> Self {
        Cursor { bytes, at: 0, file }
    }

    /// An error at the current place.
    pub fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        FormatError::new(self.file, Place::Byte(self.at as u64), found, expected)
    }

    /// Skips `magic`, which errors show as `name`.
    pub fn signature(&mut self, magic: &[u8], name: &str) -> Result<(), FormatError> {
        if !self.rest().starts_with(magic) {
            let start = &self.rest()[..self.rest().len().min(magic.len())];
            return Err(self.error(format!("\"{}\"", start.escape_ascii()), format!("the signature {name:?}")));
        }
        self.at += magic.len();
        Ok(())
    }

    /// The rest of the file.
    pub fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// The next `n` bytes; `what` describes them in errors.
    pub fn take(&mut self, n: usize, what: &str) -> Result<&'a [u8], FormatError> {
        let Some(taken) = self.rest().get(..n) else {
            let found = format!("the end of the file, {} bytes on", self.rest().len());
            return Err(self.error(found, format!("{what}, {n} bytes")));
        };
        self.at += n;
        Ok(taken)
    }

    /// The next `N` bytes.
    pub fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], FormatError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, what)?);
        Ok(array)
    }

    /// The next `count` 32-bit floats. Fails before allocating if the file does not contain them.
    pub fn floats(&mut self, count: Option<usize>, what: &str) -> Result<Vec<f32>, FormatError> {
        let Some(bytes) = count.and_then(|count| count.checked_mul(4)) else {
            return Err(self.error("more values than memory holds", what));
        };
        let (values, _) = self.take(bytes, what)?.as_chunks();
        Ok(values.iter().map(|x| f32::from_le_bytes(*x)).collect())
    }
}
