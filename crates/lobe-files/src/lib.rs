//! What all readers and writers of files share, whatever the files hold: [`FormatError`] says which file, where in it, what
//! was found and what was expected; [`write_whole`] and [`replace`] write a file completely or leave the old one alone.
#![forbid(unsafe_code)]

mod error;
mod write;

pub use error::{FormatError, Place};
pub use write::{replace, unwritable, write_whole};
