//! How far long work is: a bar where somebody sees it, else a line for each part that begins.

use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};

/// Work of some steps, done in parts that have names.
pub struct Steps {
    bar: ProgressBar,
    begun: Instant,
}

impl Steps {
    /// No step of them is done.
    pub fn new(steps: u64) -> Self {
        let style = ProgressStyle::with_template("{bar:32} {percent:>3} % {eta:>4} {msg}").expect("a valid template");
        Steps { bar: ProgressBar::new(steps).with_style(style), begun: Instant::now() }
    }

    /// This part begins.
    pub fn begin(&self, part: impl Into<String>) {
        let part = part.into();
        if self.bar.is_hidden() {
            eprintln!("{:>6.1} s  {part}", self.begun.elapsed().as_secs_f64());
        }
        self.bar.set_message(part);
    }

    /// This part of one step begins, and is over.
    pub fn part<T>(&self, part: &str, work: impl FnOnce() -> T) -> T {
        self.begin(part);
        let made = work();
        self.done(1);
        made
    }

    /// So many steps more are done.
    pub fn done(&self, steps: u64) {
        self.bar.inc(steps);
    }

    /// Where work is known only once it is under way: so many steps are done, of that many.
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
