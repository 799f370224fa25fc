//! Warnings about what a file cannot answer.

use std::path::Path;

use lobe_formats::Document;

use crate::message::say;

/// Says on the standard error what of the answers is guessed rather than measured.
pub fn warn_of_guesses(file: &Path, document: &Document) {
    for guess in lobe_ops::check::guesses(document) {
        say(format_args!("warning: {}: {guess}", file.display()));
    }
}
