//! Lets processes take turns at questions.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, ensure};

/// The questions that a program answers.
///
/// # Errors
/// If it cannot be run.
pub fn questions(program: &Path) -> anyhow::Result<Vec<String>> {
    let failed = || format!("cannot run {}", program.display());
    let output = Command::new(program).stdin(Stdio::null()).output().with_context(failed)?;
    ensure!(output.status.success(), failed());
    Ok(String::from_utf8(output.stdout)?.lines().map(String::from).collect())
}

/// A running program.
pub struct Contender {
    process: Child,
    questions: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Contender {
    /// # Errors
    /// If it cannot be run.
    pub fn start(program: &Path) -> anyhow::Result<Self> {
        let mut process = Command::new(program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot run {}", program.display()))?;
        let questions = process.stdin.take().context("an input")?;
        let answers = BufReader::new(process.stdout.take().context("an output")?);
        Ok(Contender { process, questions, answers })
    }

    /// Nanoseconds of the shortest of a few calls.
    fn ask(&mut self, question: &str) -> anyhow::Result<f64> {
        writeln!(self.questions, "{question}")?;
        let mut answer = String::new();
        self.answers.read_line(&mut answer)?;
        answer.trim().parse().with_context(|| format!("no time for {question} but `{}`", answer.trim()))
    }
}

impl Drop for Contender {
    fn drop(&mut self) {
        // The program waits for another question.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The shortest time of every question in every program; the others are compared with the last program.
pub struct Timings {
    questions: Vec<String>,
    shortest: Vec<Vec<f64>>,
}

impl Timings {
    pub fn new(questions: Vec<String>, programs: usize) -> Self {
        let shortest = vec![vec![f64::INFINITY; programs]; questions.len()];
        Timings { questions, shortest }
    }

    pub fn len(&self) -> usize {
        self.questions.len()
    }

    pub fn name(&self, question: usize) -> &str {
        &self.questions[question]
    }

    /// Lets all programs answer a question, in turns.
    ///
    /// # Errors
    /// If a program ends.
    pub fn measure(&mut self, question: usize, contenders: &mut [Contender], rounds: usize) -> anyhow::Result<()> {
        let name = &self.questions[question];
        for _ in 0..rounds {
            for (contender, shortest) in contenders.iter_mut().zip(&mut self.shortest[question]) {
                *shortest = shortest.min(contender.ask(name)?);
            }
        }
        Ok(())
    }

    /// The time of the reference, and the speeds of the others relative to it.
    pub fn ratios(&self, question: usize) -> (f64, Vec<f64>) {
        let (reference, others) = self.shortest[question].split_last().expect("a reference");
        (*reference, others.iter().map(|time| reference / time).collect())
    }

    /// The questions at which some program has less than this share of the speed of the reference, and those not asked
    /// yet.
    pub fn slower_than(&self, least: f64) -> Vec<usize> {
        let is_slow = |&question: &usize| !self.ratios(question).1.iter().all(|ratio| *ratio >= least);
        (0..self.len()).filter(is_slow).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn questions_not_asked_or_slow_are_asked_again() {
        let mut timings = Timings::new(vec!["a".into(), "b".into(), "c".into()], 3);
        assert_eq!(timings.slower_than(0.95), [0, 1, 2]);
        timings.shortest = vec![vec![100.0, 90.0, 96.0], vec![100.0, 102.0, 96.0], vec![50.0, 90.0, f64::INFINITY]];
        assert_eq!(timings.slower_than(0.95), [1]);
        assert_eq!(timings.ratios(0).1, [0.96, 96.0 / 90.0]);
    }
}
