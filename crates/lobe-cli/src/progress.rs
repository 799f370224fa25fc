//! The progress of long commands.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::message::say;

/// Work that takes less than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// A progress bar on standard error, if that is a terminal, once a second has passed.
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

/// A progress bar for work that ends with its samples or its time, whichever is first; nothing if standard error is not
/// a terminal.
pub struct Bar(ProgressBar);

impl Bar {
    /// A progress bar, or none.
    pub fn new(quiet: bool) -> Self {
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let style = ProgressStyle::with_template("{wide_bar} {percent:>3}%  {elapsed} / {eta} left  {msg}")
            .expect("a valid template");
        Bar(ProgressBar::with_draw_target(Some(0), target).with_style(style))
    }

    /// Shows the number of finished samples, and the elapsed share of the time limit.
    pub fn show(&self, done: u64, total: u64, time: Option<(Duration, Duration)>) {
        let share = done as f64 / total.max(1) as f64;
        // Whichever limit is nearer.
        let timed = time.map_or(0.0, |(elapsed, limit)| elapsed.as_secs_f64() / limit.as_secs_f64().max(1e-9));
        const STEPS: f64 = 10_000.0;
        self.0.set_length(STEPS as u64);
        self.0.set_position((STEPS * share.max(timed).min(1.0)) as u64);
        self.0.set_message(format!("{:.1} M samples", done as f64 / 1e6));
    }

    /// Prints a line above the bar.
    pub fn say(&self, text: &str) {
        self.0.suspend(|| say(text));
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
