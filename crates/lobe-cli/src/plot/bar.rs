//! The progress of figures.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lobe_plot::Progress;

/// A progress bar on standard error, if that is a terminal, once a second has passed.
pub struct Bar(ProgressBar);

/// Work that takes less than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

impl Bar {
    /// A bar that is not shown yet.
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg:8} {bar:40} {percent:>3} % {eta} left") {
            bar.set_style(style);
        }
        Bar(bar)
    }
}

impl Progress for Bar {
    fn begin(&self, figure: &str, pairs: u64) {
        self.0.set_message(figure.to_string());
        self.0.set_length(pairs);
        self.0.set_position(0);
    }

    fn advance(&self, pairs: u64) {
        if self.0.is_hidden() && self.0.elapsed() > PATIENCE {
            self.0.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.0.inc(pairs);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
