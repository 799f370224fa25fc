//! Code shared by all readers and writers of files, of any content: [`FormatError`] names the file, the place in it,
//! what was found and what was expected; [`read()`] reads ordinary files, and [`recorded`] lists which were read;
//! [`unpacked`] unpacks files compressed with gzip; [`content()`] says what an unsupported file is; [`printable`] makes
//! text from files safe to show; [`write_whole`] and [`replace`] write a file completely or leave the old one
//! unchanged, and [`check_output`] checks beforehand whether they can.
#![forbid(unsafe_code)]

mod content;
mod error;
mod memory;
mod printable;
mod read;
mod unpack;
mod write;

pub use content::{Content, beginning, content, is_web_page};
pub use error::{FormatError, Place, excerpt, sentence};
pub use memory::{Files, exists, files_of, in_memory, is_folder};
pub use printable::printable;
pub use read::{Reads, begins_with, bytes, is_standard_input, name_standard_input, read, recorded};
pub use unpack::{Unpacked, inflated, is_gzip, unpacked};
pub use write::{SIDECAR, check_folder, check_output, replace, unwritable, write_whole};
