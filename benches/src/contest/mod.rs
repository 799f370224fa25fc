//! Contests: a question for baselines and every backend, on the same input and in the same run.
//!
//! [`QUESTIONS`] lists them; a new one is a file and a line there. A contest is built, [verified](Contest::verify)
//! against the `f64` reference, and only then [timed](Contest::time).

mod acos;
mod backends;
mod drawn;
mod evaluation;
mod interpolation;
mod large;
mod questions;
mod representations;
mod rgl;
mod sampling;
mod search;
mod spectral;
mod threads;

use std::fmt;

use crate::clock::{self, Rounds};

pub use backends::{Named, backends};
pub use interpolation::angles;
pub use questions::{QUESTIONS, Question};

/// Work that is repeated, and its output.
pub trait Task {
    /// Does the whole work once.
    fn run(&mut self);
    /// The output of the last run, in the order of the contest's expected values.
    fn values(&self) -> Vec<f32>;
}

/// A [`Task`] made of an output, a function that fills it and one that puts it in order.
struct Job<O, R, V> {
    out: O,
    run: R,
    values: V,
}

impl<O, R: FnMut(&mut O), V: Fn(&O) -> Vec<f32>> Task for Job<O, R, V> {
    fn run(&mut self) {
        (self.run)(&mut self.out);
        std::hint::black_box(&self.out);
    }

    fn values(&self) -> Vec<f32> {
        (self.values)(&self.out)
    }
}

/// The allowed difference from the reference, relative to the largest expected value.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// The largest error.
    pub max: f64,
    /// The root of the mean squared error.
    pub rms: f64,
}

/// A participant in a contest.
pub struct Contender {
    /// A backend, as `avx2` or `avx2-strict`, or a baseline.
    pub name: &'static str,
    /// The accuracy required of its values.
    pub tolerance: Tolerance,
    task: Box<dyn Task>,
}

impl Contender {
    /// No requirement, for values that are compared elsewhere.
    pub const UNCHECKED: Tolerance = Tolerance { max: f64::INFINITY, rms: f64::INFINITY };

    /// Runs `run` on `out`, whose values are in the order of the expected ones.
    pub fn new<O: 'static>(
        name: &'static str,
        tolerance: Tolerance,
        out: O,
        run: impl FnMut(&mut O) + 'static,
        values: impl Fn(&O) -> Vec<f32> + 'static,
    ) -> Self {
        Contender { name, tolerance, task: Box::new(Job { out, run, values }) }
    }

    /// Does the whole work once.
    pub fn run(&mut self) {
        self.task.run();
    }

    /// The output of the last run.
    pub fn values(&self) -> Vec<f32> {
        self.task.values()
    }
}

/// One question on one input: baselines, and the contenders that are compared with each of them.
pub struct Contest {
    /// Number of queries per run.
    pub count: usize,
    /// The baselines with which the contenders are compared.
    pub baselines: Vec<Contender>,
    /// One per backend.
    pub contenders: Vec<Contender>,
    /// The correct values.
    expected: Vec<f64>,
}

/// A contender whose values differ from the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct WrongValues {
    /// Its name.
    pub name: &'static str,
    /// Largest error, relative to the largest expected value.
    pub max: f64,
    /// Root of the mean squared error, likewise.
    pub rms: f64,
}

impl fmt::Display for WrongValues {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let WrongValues { name, max, rms } = self;
        write!(f, "{name} differs from the reference by at most {max:.1e} and by {rms:.1e} on average (rms)")
    }
}

impl std::error::Error for WrongValues {}

/// Nanoseconds per query.
#[derive(Clone, Debug)]
pub struct Timing {
    /// For each baseline, in order.
    pub baselines: Vec<f64>,
    /// For each contender, in order.
    pub contenders: Vec<f64>,
}

impl Contest {
    /// Runs all contenders once and compares all values with the reference.
    ///
    /// # Errors
    /// The first contender whose values are wrong.
    pub fn verify(&mut self) -> Result<(), WrongValues> {
        let scale = self.expected.iter().fold(0.0f64, |scale, value| scale.max(value.abs()));
        for contender in self.baselines.iter_mut().chain(&mut self.contenders) {
            contender.task.run();
            let values = contender.task.values();
            assert_eq!(values.len(), self.expected.len(), "{}: one value for each expected", contender.name);
            let errors = values.iter().zip(&self.expected).map(|(got, expected)| (f64::from(*got) - expected) / scale);
            let (max, sum) =
                errors.fold((0.0f64, 0.0), |(max, sum), error| (max.max(error.abs()), sum + error * error));
            let rms = (sum / values.len() as f64).sqrt();
            // The maximum ignores NaN, the mean does not.
            if !(max <= contender.tolerance.max && rms <= contender.tolerance.rms) {
                return Err(WrongValues { name: contender.name, max, rms });
            }
        }
        Ok(())
    }

    /// Times all contenders in turn.
    pub fn time(&mut self, rounds: Rounds) -> Timing {
        let mut runs: Vec<_> =
            self.baselines.iter_mut().chain(&mut self.contenders).map(|contender| || contender.task.run()).collect();
        let mut runs: Vec<&mut dyn FnMut()> = runs.iter_mut().map(|run| run as &mut dyn FnMut()).collect();
        let mut baselines = clock::interleaved(rounds, &mut runs);
        baselines.iter_mut().for_each(|ns| *ns /= self.count as f64);
        let contenders = baselines.split_off(self.baselines.len());
        Timing { baselines, contenders }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contest(value: f32) -> Contest {
        let tolerance = Tolerance { max: 0.1, rms: 0.05 };
        let out = vec![0.0; 4];
        let run = move |out: &mut Vec<f32>| out.copy_from_slice(&[1.0, 2.0, 4.0, value]);
        let contender = Contender::new("someone", tolerance, out, run, Vec::clone);
        Contest { count: 4, baselines: vec![], contenders: vec![contender], expected: vec![1.0, 2.0, 4.0, 3.0] }
    }

    #[test]
    fn wrong_values_are_found() {
        assert_eq!(contest(3.0).verify(), Ok(()));
        assert_eq!(contest(3.3).verify(), Ok(()), "0.075 at most and 0.04 on average");
        assert!(contest(3.42).verify().is_err(), "0.105 at most");
        assert!(contest(2.58).verify().is_err(), "0.105 at most, below");
        assert!(contest(3.39).verify().is_ok() && contest(f32::NAN).verify().is_err());
    }

    #[test]
    fn every_question_has_a_unique_id() {
        for question in QUESTIONS {
            assert_eq!(QUESTIONS.iter().filter(|other| other.id == question.id).count(), 1, "{}", question.id);
        }
    }
}
