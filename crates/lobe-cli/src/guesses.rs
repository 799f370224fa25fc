//! Warnings about values that a file does not determine.

use std::path::Path;

use lobe_formats::Document;

use crate::message::say;

/// Says on standard error which values are guessed rather than measured.
pub fn warn_of_guesses(file: &Path, document: &Document) {
    for guess in lobe_ops::check::guesses(document) {
        say(format_args!("warning: {}: {guess}", file.display()));
    }
}
