//! The ways in which a command fails, and their exit codes.

use std::fmt;
use std::io;
use std::process::ExitCode;

use lobe::OpenError;
use lobe_files::printable;
use lobe_formats::{ConvertError, FormatError};
use lobe_memory::NoRoom;
use lobe_render::picture::PictureError;

/// The reason why a command stopped.
#[derive(Debug)]
pub enum Failure {
    /// A file cannot be read or written, or is damaged. Exit code 1.
    File(String),
    /// The request is invalid. Exit code 2.
    Usage(String),
    /// A check failed, or a bound was not met. Exit code 3.
    Check(String),
    /// The user asked the program to end. Exit code 130.
    Interrupted(String),
    /// The reader of the output has closed it, as `head` does. Not a failure.
    OutputClosed,
}

impl Failure {
    /// The exit code for the shell.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Failure::File(_) => ExitCode::from(1),
            Failure::Usage(_) => ExitCode::from(2),
            Failure::Check(_) => ExitCode::from(3),
            Failure::Interrupted(_) => ExitCode::from(INTERRUPTED),
            Failure::OutputClosed => ExitCode::SUCCESS,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // Messages quote text from files, which a terminal must not obey; some have several lines.
            Failure::File(message)
            | Failure::Usage(message)
            | Failure::Check(message)
            | Failure::Interrupted(message) => {
                let lines: Vec<_> = message.split('\n').map(printable).collect();
                f.write_str(&lines.join("\n"))
            }
            Failure::OutputClosed => f.write_str("the output was closed"),
        }
    }
}

/// The exit code of a program ended by a signal: 128 plus the number of SIGINT.
pub const INTERRUPTED: u8 = 130;

impl From<FormatError> for Failure {
    fn from(error: FormatError) -> Self {
        Failure::File(error.to_string())
    }
}

impl From<ConvertError> for Failure {
    fn from(error: ConvertError) -> Self {
        match error {
            ConvertError::Channels(message) => Failure::Usage(message),
            error => Failure::File(error.to_string()),
        }
    }
}

impl From<OpenError> for Failure {
    fn from(error: OpenError) -> Self {
        match error {
            OpenError::Backend(error) => Failure::Usage(format!("LOBE_BACKEND: {error}")),
            error => Failure::File(error.to_string()),
        }
    }
}

impl From<NoRoom> for Failure {
    fn from(no_room: NoRoom) -> Self {
        Failure::File(format!("found a picture of {no_room}; expected one that fits"))
    }
}

impl From<PictureError> for Failure {
    fn from(error: PictureError) -> Self {
        Failure::File(error.to_string())
    }
}

/// Errors while writing to standard output.
impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Failure::OutputClosed,
            _ => Failure::File(format!("standard output: {error}")),
        }
    }
}

impl From<serde_json::Error> for Failure {
    fn from(error: serde_json::Error) -> Self {
        Failure::from(io::Error::from(error))
    }
}
