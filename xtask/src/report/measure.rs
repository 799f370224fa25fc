//! From contests to rows.

use anyhow::bail;
use indicatif::{ProgressBar, ProgressStyle};
use lobe_benches::contest::{Contest, QUESTIONS, Question};
use lobe_benches::workload::Input;

use super::rows::Row;

/// How much is measured.
///
/// A run of the slowest contender has to fit between two interruptions for its shortest time to mean anything: some
/// milliseconds. The rest is in the number of rounds.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    count: usize,
    rounds: usize,
}

impl Plan {
    /// For figures to be kept.
    pub const FULL: Plan = Plan { count: 1 << 13, rounds: 400 };
    /// For a look, and for continuous integration.
    pub const QUICK: Plan = Plan { count: 1 << 13, rounds: 40 };

    /// Fewer rounds where a run takes more queries, but always some.
    fn rounds_of(&self, contest: &Contest) -> usize {
        (self.rounds * self.count / contest.count).max(self.rounds / 10)
    }
}

/// Verifies everybody's values, then times the questions on both inputs: those named, or all.
///
/// # Errors
/// Where there is no question of a name, or values are wrong; nothing is timed then.
pub fn all(plan: Plan, only: &[&String]) -> anyhow::Result<Vec<Row>> {
    if let Some(unknown) = only.iter().find(|id| Question::named(id).is_none()) {
        let ids: Vec<_> = QUESTIONS.iter().map(|question| question.id).collect();
        bail!("no question `{unknown}`; there are {}", ids.join(", "));
    }
    let asked = |question: &Question| only.is_empty() || only.iter().any(|id| *id == question.id);
    let questions: Vec<_> = QUESTIONS.into_iter().filter(asked).collect();
    let mut contests: Vec<(Question, Input, Contest)> = Vec::new();
    let checks = (questions.len() * Input::ALL.len()) as u64;
    let bar = progress(checks, "checking values");
    for question in questions {
        for input in Input::ALL {
            let mut contest = question.contest(input, plan.count);
            if let Err(wrong) = contest.verify() {
                bar.abandon();
                bail!("{}, {} input: {wrong}", question.id, input.name());
            }
            contests.push((question, input, contest));
            bar.inc(1);
        }
    }
    bar.finish_and_clear();

    let rounds: u64 = contests.iter().map(|(.., contest)| plan.rounds_of(contest) as u64 + 1).sum();
    let bar = progress(rounds, "");
    let mut rows = Vec::new();
    for (question, input, mut contest) in contests {
        bar.set_message(format!("{} {}", question.id, input.name()));
        let timing = contest.time(plan.rounds_of(&contest), || bar.inc(1));
        for (contender, &ns) in contest.contenders.iter().zip(&timing.contenders) {
            for (baseline, &baseline_ns) in contest.baselines.iter().zip(&timing.baselines) {
                rows.push(Row {
                    id: question.id,
                    backend: contender.name,
                    input: input.name(),
                    baseline: baseline.name,
                    ns,
                    baseline_ns,
                    ratio: baseline_ns / ns,
                });
            }
        }
    }
    bar.finish_and_clear();
    Ok(rows)
}

fn progress(length: u64, message: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:32} {percent:>3} % {eta:>4} {msg}").expect("a valid template");
    ProgressBar::new(length).with_style(style).with_message(message)
}
