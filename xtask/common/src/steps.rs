//! Progress of long work: a bar on a terminal, otherwise a line at the beginning of each part.

use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};

/// Work of several steps, done in named parts.
pub struct Steps {
    bar: ProgressBar,
    begun: Instant,
}

impl Steps {
    /// No step is done yet.
    pub fn new(steps: u64) -> Self {
        let style = ProgressStyle::with_template("{bar:32} {percent:>3} % {eta:>4} {msg}").expect("a valid template");
        Steps { bar: ProgressBar::new(steps).with_style(style), begun: Instant::now() }
    }

    /// Begins a part.
    pub fn begin(&self, part: impl Into<String>) {
        let part = part.into();
        if self.bar.is_hidden() {
            eprintln!("{:>6.1} s  {part}", self.begun.elapsed().as_secs_f64());
        }
        self.bar.set_message(part);
    }

    /// Runs a part of one step.
    pub fn part<T>(&self, part: &str, work: impl FnOnce() -> T) -> T {
        self.begin(part);
        let made = work();
        self.done(1);
        made
    }

    /// Marks this many more steps as done.
    pub fn done(&self, steps: u64) {
        self.bar.inc(steps);
    }

    /// For work whose size is known only after it has started: sets the number of finished steps and of all steps.
    pub fn are(&self, done: u64, of: u64) {
        self.bar.set_length(of);
        self.bar.set_position(done);
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
