//! What all readers and writers of files share, whatever the files hold: [`FormatError`] says which file, where in it, what
//! was found and what was expected; [`read()`] reads files and nothing else, and [`recorded`] says which; [`write_whole`] and
//! [`replace`] write a file completely or leave the old one alone, and [`check_output`] says beforehand whether they will.
#![forbid(unsafe_code)]

mod error;
mod read;
mod write;

pub use error::{FormatError, Place, excerpt, sentence};
pub use read::{Reads, bytes, is_standard_input, name_standard_input, read, recorded};
pub use write::{check_output, replace, unwritable, write_whole};
