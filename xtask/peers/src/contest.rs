//! One question: this library and its peers on the same input.

use lobe::Backend;
use lobe_benches::contest::Contender;

use super::comparison::{Agreement, Difference, Judge, compare};
use super::exchange::Exchange;
use super::processor;
use super::program::Programs;
use super::row::Row;

/// Runs of each contestant per turn: the first finds the caches as the previous contestant left them.
const TIMES: usize = 3;

/// A peer that answers a task in a separate program.
#[derive(Clone, Debug)]
pub struct Outside {
    /// Its displayed name.
    pub name: &'static str,
    /// The program.
    pub program: &'static str,
    /// The task of the program.
    pub task: String,
    /// It uses wider vectors than this library has: it is shown, but not compared with a goal.
    pub wider: bool,
}

impl Outside {
    pub fn new(name: &'static str, program: &'static str, task: impl Into<String>) -> Self {
        Outside { name, program, task: task.into(), wider: false }
    }

    /// It uses vectors of sixteen floats, which this library has on some processors.
    pub fn of_sixteen(name: &'static str, program: &'static str, task: impl Into<String>) -> Self {
        Outside { wider: Backend::best().lanes() < 16, ..Self::new(name, program, task) }
    }
}

/// A question.
pub struct Contest {
    /// Short name.
    pub id: &'static str,
    /// The data and input.
    pub on: String,
    /// What is counted, as in "nanoseconds per lookup".
    pub unit: &'static str,
    /// How many of them one run performs.
    pub count: usize,
    /// This library.
    pub lobe: Contender,
    /// Peers in this process.
    pub inside: Vec<Contender>,
    /// Peers in others.
    pub outside: Vec<Outside>,
    /// How closely all values must agree; `None` if they are not of the same material.
    pub agreement: Option<Agreement>,
    /// The judge that decides if they differ by more; `None` if all differences count.
    pub judge: Option<Box<dyn Judge>>,
    /// The goal: how many times as fast as the fastest peer whose vectors are no wider.
    pub goal: Option<f64>,
}

impl Contest {
    /// The question, and its data and input.
    pub fn name(&self) -> String {
        format!("{} {}", self.id, self.on)
    }

    /// Leaves out the peers that do not run; `false` if none is left.
    pub fn keep_present(&mut self, programs: &Programs) -> bool {
        self.outside.retain(|peer| programs.has(peer.program));
        !(self.inside.is_empty() && self.outside.is_empty())
    }

    /// Runs all contestants once and compares the values: one difference for each peer, those in this process first.
    ///
    /// # Errors
    /// If values differ by more than allowed.
    pub fn check(&mut self, programs: &mut Programs, exchange: &Exchange) -> anyhow::Result<Vec<Option<Difference>>> {
        self.lobe.run();
        let ours = self.lobe.values();
        let compared = |peer: &str, theirs: &[f32]| {
            compare(self.agreement, self.judge.as_deref(), (self.id, &self.on, peer), &ours, theirs)
        };
        let mut differences = Vec::new();
        for peer in &mut self.inside {
            peer.run();
            differences.push(compared(peer.name, &peer.values())?);
        }
        for peer in &self.outside {
            let file = exchange.answer(peer.program, &peer.task);
            programs.write(peer.program, &peer.task, &file)?;
            let theirs = exchange.read(&file, ours.len())?;
            // Some of these files are large, and are not read again.
            std::fs::remove_file(&file)?;
            differences.push(compared(peer.name, &theirs)?);
        }
        Ok(differences)
    }

    /// One turn of all contestants, in processor time: `least` keeps the shortest of all runs.
    ///
    /// # Errors
    /// If a program fails.
    pub fn turn(&mut self, programs: &mut Programs, least: &mut Least) -> anyhow::Result<()> {
        least.lobe = least.lobe.min(seconds(&mut self.lobe));
        least.peers.resize(self.inside.len() + self.outside.len(), f64::INFINITY);
        let (inside, outside) = least.peers.split_at_mut(self.inside.len());
        for (peer, least) in self.inside.iter_mut().zip(inside) {
            *least = least.min(seconds(peer));
        }
        for (peer, least) in self.outside.iter().zip(outside) {
            *least = least.min(programs.run(peer.program, &peer.task, TIMES)?);
        }
        Ok(())
    }

    /// The figures after the last turn.
    pub fn rows(&self, Least { lobe, peers }: &Least, differences: &[Option<Difference>]) -> Vec<Row> {
        let wider = self.inside.iter().map(|_| false).chain(self.outside.iter().map(|peer| peer.wider));
        let fastest = peers.iter().zip(wider).filter(|(_, wider)| !wider).map(|(least, _)| *least);
        let fastest = fastest.fold(f64::INFINITY, f64::min);
        let names = self.inside.iter().map(|peer| peer.name).chain(self.outside.iter().map(|peer| peer.name));
        let row = |((name, least), difference): ((&'static str, f64), &Option<Difference>)| Row {
            id: self.id,
            on: self.on.clone(),
            unit: self.unit,
            peer: name,
            ns: lobe / self.count as f64 * 1e9,
            peer_ns: least / self.count as f64 * 1e9,
            ratio: least / lobe,
            goal: self.goal.filter(|_| least == fastest),
            difference: difference.map(|difference| difference.largest),
            peer_wrong: difference.map_or(0, |difference| difference.wrong),
        };
        names.zip(peers.iter().copied()).zip(differences).map(row).collect()
    }
}

/// The shortest runs so far, in seconds.
#[derive(Clone, Debug)]
pub struct Least {
    lobe: f64,
    /// The peers in this process first.
    peers: Vec<f64>,
}

impl Default for Least {
    fn default() -> Self {
        Least { lobe: f64::INFINITY, peers: Vec::new() }
    }
}

/// The least processor time of the runs of a turn, in seconds.
fn seconds(contender: &mut Contender) -> f64 {
    let run = |_| {
        let start = processor::seconds();
        contender.run();
        processor::seconds() - start
    };
    (0..TIMES).map(run).fold(f64::INFINITY, f64::min)
}
