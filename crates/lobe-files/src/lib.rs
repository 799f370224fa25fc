//! What all readers and writers of files share, whatever the files hold: [`FormatError`] says which file, where in it, what
//! was found and what was expected; [`read()`] reads files and nothing else, and [`recorded`] says which; [`unpacked`] opens
//! files that are packed with gzip; [`content()`] says what an unsupported file is; [`printable`] makes
//! text of files safe to show; [`write_whole`] and [`replace`] write a file completely or leave the old one alone, and
//! [`check_output`] says beforehand whether they will.
#![forbid(unsafe_code)]

mod content;
mod error;
mod printable;
mod read;
mod unpack;
mod write;

pub use content::{Content, beginning, content, is_web_page};
pub use error::{FormatError, Place, excerpt, sentence};
pub use printable::printable;
pub use read::{Reads, bytes, is_standard_input, name_standard_input, read, recorded};
pub use unpack::{Unpacked, inflated, is_gzip, unpacked};
pub use write::{check_output, replace, unwritable, write_whole};
