//! What a function answers, and where it says why.

use std::ffi::{c_char, c_int};

use lobe::{BackendError, OpenError, SamplerError};
use lobe_formats::{FormatError, Place};

/// Whether a function did what it was asked for: `LOBE_OK`, or one of `LOBE_ERROR_...`.
pub type lobe_status = c_int;

/// Done.
pub const LOBE_OK: lobe_status = 0;
/// An argument makes no sense.
pub const LOBE_ERROR_INVALID: lobe_status = 1;
/// A file cannot be read, is damaged, or is of no known format.
pub const LOBE_ERROR_FORMAT: lobe_status = 2;
/// The material has nothing of the kind that was asked for.
pub const LOBE_ERROR_UNSUPPORTED: lobe_status = 3;
/// A mistake in lobe; please report it.
pub const LOBE_ERROR_INTERNAL: lobe_status = 4;

/// How many bytes a message has at most, with the zero at its end.
pub const LOBE_MESSAGE_LENGTH: usize = 1024;

/// Where a function says what is wrong. It belongs to the caller; several threads must not use the same one.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct lobe_error {
    /// The same that the function returns.
    pub status: lobe_status,
    /// The line of the file, counted from 1, or 0.
    pub line: u64,
    /// The offset in the file in bytes, or `UINT64_MAX`.
    pub byte: u64,
    /// What is wrong, in words that name the file; ends with a zero, and may be cut.
    pub message: [c_char; LOBE_MESSAGE_LENGTH],
}

/// An error on its way to the border.
#[derive(Debug)]
pub struct Error {
    status: lobe_status,
    message: String,
    line: u64,
    byte: u64,
}

impl Error {
    pub fn new(status: lobe_status, message: impl Into<String>) -> Self {
        Error { status, message: message.into(), line: 0, byte: u64::MAX }
    }

    /// What is wrong with an argument.
    pub fn invalid(message: impl Into<String>) -> Self {
        Error::new(LOBE_ERROR_INVALID, message)
    }

    pub fn status(&self) -> lobe_status {
        self.status
    }

    /// The same for the caller.
    pub fn shown(&self) -> lobe_error {
        let mut message = [0; LOBE_MESSAGE_LENGTH];
        let mut end = self.message.len().min(LOBE_MESSAGE_LENGTH - 1);
        while !self.message.is_char_boundary(end) {
            end -= 1;
        }
        for (out, byte) in message.iter_mut().zip(self.message[..end].bytes()) {
            // A zero would end the message.
            *out = if byte == 0 { b' ' as c_char } else { byte as c_char };
        }
        lobe_error { status: self.status, line: self.line, byte: self.byte, message }
    }
}

impl From<FormatError> for Error {
    fn from(error: FormatError) -> Self {
        let (line, byte) = match error.place {
            Place::File => (0, u64::MAX),
            Place::Line(line) => (line as u64, u64::MAX),
            Place::Byte(byte) => (0, byte),
        };
        Error { line, byte, ..Error::new(LOBE_ERROR_FORMAT, error.to_string()) }
    }
}

impl From<OpenError> for Error {
    fn from(error: OpenError) -> Self {
        match error {
            OpenError::Format(error) => error.into(),
            OpenError::Backend(error) => error.into(),
            other => Error::new(LOBE_ERROR_FORMAT, other.to_string()),
        }
    }
}

impl From<BackendError> for Error {
    fn from(error: BackendError) -> Self {
        Error::invalid(error.to_string())
    }
}

impl From<SamplerError> for Error {
    fn from(error: SamplerError) -> Self {
        Error::invalid(error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(error: &lobe_error) -> String {
        let bytes: Vec<u8> = error.message.iter().map(|&c| c as u8).take_while(|&byte| byte != 0).collect();
        String::from_utf8(bytes).expect("whole characters")
    }

    #[test]
    fn messages_are_cut_between_characters_and_end() {
        for length in [0, 1, 510, 511, 512, 2000] {
            let message = "é".repeat(length);
            let shown = Error::invalid(message.clone()).shown();
            assert_eq!(text(&shown), "é".repeat(length.min(511)));
        }
        assert_eq!(text(&Error::invalid("a\0b").shown()), "a b");
    }
}
