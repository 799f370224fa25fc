//! Ctrl-C, and the signals that ask a program to end: once to end in good order, twice to end at once.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::failure::INTERRUPTED;
use crate::message::say;

static ASKED: AtomicUsize = AtomicUsize::new(0);

/// From now on signals are counted, and the second one ends the program. Without this, the first one does.
pub fn listen() {
    // If it cannot be had, signals end the program as they always do.
    let _ = ctrlc::set_handler(|| {
        if ASKED.fetch_add(1, Ordering::Relaxed) > 0 {
            std::process::exit(INTERRUPTED.into());
        }
        say("interrupted: what there is will be written; once more ends at once");
    });
}

/// Whether the program was asked to end.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed) > 0
}
