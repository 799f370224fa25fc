//! Ctrl-C and termination signals: the first one ends the program in good order, the second one at once.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::failure::INTERRUPTED;
use crate::message::say;

static ASKED: AtomicUsize = AtomicUsize::new(0);

/// Counts signals from now on; the second one ends the program. Without this, the first one does.
pub fn listen() {
    // If no handler can be installed, signals end the program as usual.
    let _ = ctrlc::set_handler(|| {
        if ASKED.fetch_add(1, Ordering::Relaxed) > 0 {
            std::process::exit(INTERRUPTED.into());
        }
        // On a separate thread: it blocks if nobody reads the output, and the next signal must still be handled.
        let _ = std::thread::Builder::new()
            .spawn(|| say("interrupted: saving the samples so far; interrupt again to end at once"));
    });
}

/// Counts signals from now on without a message, so that the first one can end a wait; the second one ends the program.
pub fn listen_quietly() {
    let _ = ctrlc::set_handler(|| {
        if ASKED.fetch_add(1, Ordering::Relaxed) > 0 {
            std::process::exit(INTERRUPTED.into());
        }
    });
}

/// Returns `true` if the program was asked to end.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed) > 0
}
