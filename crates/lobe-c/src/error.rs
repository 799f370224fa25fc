//! Return codes of functions, and descriptions of errors.

use std::ffi::{c_char, c_int};

use lobe::{BackendError, OpenError, SamplerError};
use lobe_formats::{FormatError, Place};

/// The return code of a function: `LOBE_OK`, or one of `LOBE_ERROR_...`.
pub type lobe_status = c_int;

/// Success.
pub const LOBE_OK: lobe_status = 0;
/// An argument is invalid.
pub const LOBE_ERROR_INVALID: lobe_status = 1;
/// A file cannot be read, is damaged, or is of no known format.
pub const LOBE_ERROR_FORMAT: lobe_status = 2;
/// The material does not support the request.
pub const LOBE_ERROR_UNSUPPORTED: lobe_status = 3;
/// A bug in lobe; please report it.
pub const LOBE_ERROR_INTERNAL: lobe_status = 4;

/// The largest number of bytes of a message, including the zero at its end.
pub const LOBE_MESSAGE_LENGTH: usize = 1024;

/// The description of an error, written by a function that fails. It belongs to the caller; several threads must not
/// use the same one.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct lobe_error {
    /// The same code that the function returns.
    pub status: lobe_status,
    /// The line of the file, counted from 1; 0 if there is none.
    pub line: u64,
    /// The offset in the file in bytes; `UINT64_MAX` if there is none.
    pub byte: u64,
    /// A description of the error that names the file; it ends with a zero, and may be truncated.
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

    /// An error of an argument.
    pub fn invalid(message: impl Into<String>) -> Self {
        Error::new(LOBE_ERROR_INVALID, message)
    }

    pub fn status(&self) -> lobe_status {
        self.status
    }

    /// The error for the caller.
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
    fn messages_are_truncated_between_characters_and_terminated() {
        for length in [0, 1, 510, 511, 512, 2000] {
            let message = "é".repeat(length);
            let shown = Error::invalid(message.clone()).shown();
            assert_eq!(text(&shown), "é".repeat(length.min(511)));
        }
        assert_eq!(text(&Error::invalid("a\0b").shown()), "a b");
    }
}
