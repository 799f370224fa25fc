//! Measures contests and turns them into rows.

use std::time::Duration;

use anyhow::bail;
use lobe_benches::clock::Rounds;
use lobe_benches::contest::{Contest, QUESTIONS, Question};
use lobe_benches::workload::Input;
use xtask_common::Steps;

use super::rows::Row;
use super::sections::{self, Section};

/// Queries per run, unless a question has its own number.
///
/// A run of the slowest contender must fit between two interruptions, a few milliseconds apart, so that its shortest
/// time is meaningful. More rounds do the rest.
const COUNT: usize = 1 << 13;

/// For figures to be kept.
pub const FULL: Rounds = Rounds { most: 400, least: 10, time: Duration::from_secs(5) };
/// For a quick look, and for continuous integration.
pub const QUICK: Rounds = Rounds { most: 40, least: 3, time: Duration::from_millis(500) };

/// Verifies all values and times the questions on both inputs, those named or all, section by section: those of the
/// paper come first. Each section is `shown` as soon as it is measured.
///
/// # Errors
/// If there is no question of a given name, or values are wrong; nothing of the section is then timed.
pub fn all(rounds: Rounds, only: Option<&[&str]>, shown: impl Fn(&Section, &[Row])) -> anyhow::Result<Vec<Row>> {
    if let Some(unknown) = only.into_iter().flatten().find(|id| Question::named(id).is_none()) {
        let ids: Vec<_> = QUESTIONS.iter().map(|question| question.id).collect();
        bail!("no question `{unknown}`; there are {}", ids.join(", "));
    }
    let mut rows = Vec::new();
    for section in sections::of(|question| only.is_none_or(|only| only.contains(&question.id))) {
        measure(&section, rounds, &mut rows)?;
        shown(&section, &rows);
    }
    Ok(rows)
}

fn measure(section: &Section, rounds: Rounds, rows: &mut Vec<Row>) -> anyhow::Result<()> {
    let mut contests: Vec<(Question, Input, Contest)> = Vec::new();
    let steps = Steps::new((section.questions.len() * Input::ALL.len() * 2) as u64);
    steps.begin(format!("{}: values", section.title));
    for &question in &section.questions {
        for input in Input::ALL {
            let mut contest = question.contest(input, COUNT);
            if let Err(wrong) = contest.verify() {
                bail!("{}, {} input: {wrong}", question.id, input.name());
            }
            contests.push((question, input, contest));
            steps.done(1);
        }
    }
    for (question, input, mut contest) in contests {
        let timing = steps.part(&format!("{} {}", question.id, input.name()), || contest.time(rounds));
        for (contender, &ns) in contest.contenders.iter().zip(&timing.contenders) {
            for (baseline, &baseline_ns) in contest.baselines.iter().zip(&timing.baselines) {
                rows.push(Row {
                    id: question.id.into(),
                    backend: contender.name.into(),
                    input: input.name().into(),
                    baseline: baseline.name.into(),
                    ns,
                    baseline_ns,
                    ratio: baseline_ns / ns,
                });
            }
        }
    }
    Ok(())
}
