//! One line of the results.

use serde::Serialize;
use xtask_common::{nanoseconds, times};

/// This library compared with one peer.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The question.
    pub id: &'static str,
    /// The data and input.
    pub on: String,
    /// The unit that is counted.
    pub unit: &'static str,
    /// The peer.
    pub peer: &'static str,
    /// This library's processor time, in nanoseconds.
    pub ns: f64,
    /// The peer's processor time, in nanoseconds.
    pub peer_ns: f64,
    /// The peer's time divided by this library's.
    pub ratio: f64,
    /// The goal for the ratio, if this is the fastest peer.
    pub goal: Option<f64>,
    /// The largest relative difference of the values, if they are of the same material.
    pub difference: Option<f64>,
    /// Number of disputed answers of the peer that are wrong.
    pub peer_wrong: usize,
}

impl Row {
    /// The text of the columns of the table.
    pub fn cells(&self) -> [String; 8] {
        let goal = self.goal.map(|goal| format!("{}{}", times(goal), if self.ratio < goal { ", short" } else { "" }));
        let wrong = if self.peer_wrong > 0 { format!(", {} wrong", self.peer_wrong) } else { String::new() };
        [
            self.id.into(),
            self.on.clone(),
            self.peer.into(),
            nanoseconds(self.peer_ns),
            nanoseconds(self.ns),
            times(self.ratio),
            goal.unwrap_or_default(),
            self.difference.map_or_else(String::new, |difference| format!("{difference:.0e}{wrong}")),
        ]
    }
}
