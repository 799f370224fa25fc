//! One question: this library and its peers on the same input.

use anyhow::bail;
use lobe_benches::contest::Contender;

use super::exchange::Exchange;
use super::processor;
use super::program::Programs;
use super::record::Row;

/// Runs of everybody in a turn: the first finds the caches as the one before left them.
const TIMES: usize = 3;

/// How far values may differ.
#[derive(Clone, Copy, Debug)]
pub struct Agreement {
    /// The largest difference, in parts of the peer's value.
    pub relative: f64,
    /// The value in whose parts it is measured where the peer's is smaller.
    pub floor: f64,
    /// The share of values that may differ by more.
    pub outliers: f64,
}

/// How the values of a peer differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The largest but for the outliers that are allowed, relative.
    pub largest: f64,
}

/// A peer: this one answers a task in a program of its own.
#[derive(Clone, Debug)]
pub struct Outside {
    /// As it is shown.
    pub name: &'static str,
    /// Which program.
    pub program: &'static str,
    /// Which of its tasks.
    pub task: String,
}

/// A question.
pub struct Contest {
    /// Short name.
    pub id: &'static str,
    /// On what.
    pub on: String,
    /// What is counted, as in "nanoseconds per lookup".
    pub unit: &'static str,
    /// How many of them a run does.
    pub count: usize,
    /// This library.
    pub lobe: Contender,
    /// Peers in this process.
    pub inside: Vec<Contender>,
    /// Peers in others.
    pub outside: Vec<Outside>,
    /// What the values of all are held to; `None` where they are not of the same material.
    pub agreement: Option<Agreement>,
    /// How many times the speed of the fastest peer this library shall have.
    pub goal: Option<f64>,
}

impl Contest {
    /// What is asked, and on what.
    pub fn name(&self) -> String {
        format!("{} {}", self.id, self.on)
    }

    /// Leaves out the peers that do not run; `false` where nobody is left.
    pub fn keep_present(&mut self, programs: &Programs) -> bool {
        self.outside.retain(|peer| programs.has(peer.program));
        !(self.inside.is_empty() && self.outside.is_empty())
    }

    /// Runs everybody once and compares the values: one difference for each peer, those inside first.
    ///
    /// # Errors
    /// Where values differ by more than is allowed.
    pub fn check(&mut self, programs: &mut Programs, exchange: &Exchange) -> anyhow::Result<Vec<Option<Difference>>> {
        self.lobe.run();
        let ours = self.lobe.values();
        let mut differences = Vec::new();
        for peer in &mut self.inside {
            peer.run();
            differences.push(compare(self.agreement, (self.id, &self.on, peer.name), &ours, &peer.values())?);
        }
        for peer in &self.outside {
            let file = exchange.answer(peer.program, &peer.task);
            programs.write(peer.program, &peer.task, &file)?;
            let theirs = exchange.read(&file, ours.len())?;
            // Some of these files are large, and nobody reads them again.
            std::fs::remove_file(&file)?;
            differences.push(compare(self.agreement, (self.id, &self.on, peer.name), &ours, &theirs)?);
        }
        Ok(differences)
    }

    /// Times everybody in turns, in processor time, the least of all runs. `progress` is called after each turn.
    ///
    /// # Errors
    /// Where a program breaks off.
    pub fn time(
        &mut self,
        programs: &mut Programs,
        turns: usize,
        differences: &[Option<Difference>],
        mut progress: impl FnMut(),
    ) -> anyhow::Result<Vec<Row>> {
        let (mut lobe, mut peers) = (f64::INFINITY, vec![f64::INFINITY; self.inside.len() + self.outside.len()]);
        for _ in 0..turns {
            lobe = lobe.min(seconds(&mut self.lobe));
            let (inside, outside) = peers.split_at_mut(self.inside.len());
            for (peer, least) in self.inside.iter_mut().zip(inside) {
                *least = least.min(seconds(peer));
            }
            for (peer, least) in self.outside.iter().zip(outside) {
                *least = least.min(programs.run(peer.program, &peer.task, TIMES)?);
            }
            progress();
        }
        let fastest = peers.iter().copied().fold(f64::INFINITY, f64::min);
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
        };
        Ok(names.zip(peers.iter().copied()).zip(differences).map(row).collect())
    }
}

/// The least processor seconds of the runs of a turn.
fn seconds(contender: &mut Contender) -> f64 {
    let run = |_| {
        let start = processor::seconds();
        contender.run();
        processor::seconds() - start
    };
    (0..TIMES).map(run).fold(f64::INFINITY, f64::min)
}

fn compare(
    agreement: Option<Agreement>,
    (id, on, peer): (&str, &str, &str),
    ours: &[f32],
    theirs: &[f32],
) -> anyhow::Result<Option<Difference>> {
    let Some(Agreement { relative, floor, outliers }) = agreement else {
        // Of another material; but figures all the same.
        if !ours.iter().chain(theirs).all(|value| value.is_finite()) {
            bail!("{id} {on}: {peer} or lobe gives values that are no numbers");
        }
        return Ok(None);
    };
    let mut differences: Vec<f64> = ours
        .iter()
        .zip(theirs)
        .map(|(ours, theirs)| {
            let (ours, theirs) = (f64::from(*ours), f64::from(*theirs));
            let difference = (ours - theirs).abs() / theirs.abs().max(floor);
            if difference.is_nan() { f64::INFINITY } else { difference }
        })
        .collect();
    let kept = differences.len() - 1 - (differences.len() as f64 * outliers) as usize;
    let (_, largest, _) = differences.select_nth_unstable_by(kept, f64::total_cmp);
    let largest = *largest;
    if largest > relative {
        bail!("{id} {on}: the values of {peer} differ by up to {largest:.1e}; {relative:.1e} is allowed");
    }
    Ok(Some(Difference { largest }))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: Agreement = Agreement { relative: 1e-3, floor: 0.1, outliers: 0.0 };

    fn difference(agreement: Agreement, ours: &[f32], theirs: &[f32]) -> anyhow::Result<f64> {
        compare(Some(agreement), ("question", "input", "peer"), ours, theirs).map(|found| found.unwrap().largest)
    }

    #[test]
    fn differences_are_relative_and_small_values_count_as_the_floor() {
        let found = difference(EXACT, &[1.0005, 0.0], &[1.0, 0.00005]).unwrap();
        assert!((found - 5e-4).abs() < 1e-6, "{found}");
    }

    #[test]
    fn wrong_values_are_named() {
        let error = difference(EXACT, &[1.0, 1.1], &[1.0, 1.0]).unwrap_err().to_string();
        assert!(error.contains("peer") && error.contains("1.0e-1"), "{error}");
        difference(EXACT, &[f32::NAN], &[1.0]).unwrap_err();
    }

    #[test]
    fn no_more_than_the_allowed_share_may_be_off() {
        let mut ours = vec![1.0; 100];
        ours[3] = 2.0;
        let one = Agreement { outliers: 0.01, ..EXACT };
        assert_eq!(difference(one, &ours, &[1.0; 100]).unwrap(), 0.0);
        ours[4] = 2.0;
        difference(one, &ours, &[1.0; 100]).unwrap_err();
    }
}
