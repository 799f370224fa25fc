//! How far a long command has come.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// What takes less than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar on the standard error, where that is a terminal, once a second has passed.
pub struct Progress(ProgressBar);

impl Progress {
    /// `steps` steps of `what`.
    pub fn new(steps: usize, what: &'static str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden()).with_message(what);
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {percent:>3} % {eta} left") {
            bar.set_style(style);
        }
        Progress(bar)
    }

    /// One step is done.
    pub fn step(&self) {
        if self.0.is_hidden() && self.0.elapsed() > PATIENCE {
            self.0.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.0.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
