//! Measures ratios of times that are reliable on a machine that is not idle.

use std::time::{Duration, Instant};

/// Number of turns of every contender.
#[derive(Clone, Copy, Debug)]
pub struct Rounds {
    /// At most this many.
    pub most: usize,
    /// At least this many, however long they take.
    pub least: usize,
    /// Between the two, until this much time has passed.
    pub time: Duration,
}

/// Calls of a contender in a row: the first one finds the caches as the previous contender left them.
const TURN: usize = 3;

/// Times several contenders in turn, `A A A B B B C C C A A A ...`, and returns the least nanoseconds of a call for
/// each.
///
/// The minimum of many rounds is the time of the code itself, because other work on the machine can only add to it.
/// Taking turns gives every contender the same clock speed and the same disturbances.
pub fn interleaved(rounds: Rounds, contenders: &mut [&mut dyn FnMut()]) -> Vec<f64> {
    let begun = Instant::now();
    let mut shortest = vec![f64::INFINITY; contenders.len()];
    for round in 0..rounds.most {
        if round >= rounds.least && begun.elapsed() >= rounds.time {
            break;
        }
        for (run, shortest) in contenders.iter_mut().zip(&mut shortest) {
            for _ in 0..TURN {
                let start = Instant::now();
                run();
                *shortest = shortest.min(start.elapsed().as_secs_f64() * 1e9);
            }
        }
    }
    shortest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_end_when_time_is_over_but_not_before_the_minimum() {
        let count = |time: u64| {
            let rounds = Rounds { most: 20, least: 3, time: Duration::from_secs(time) };
            let (mut first, mut second) = (0, 0);
            interleaved(rounds, &mut [&mut || first += 1, &mut || second += 1]);
            [first, second]
        };
        assert_eq!(count(0), [3 * TURN; 2]);
        assert_eq!(count(3600), [20 * TURN; 2]);
    }
}
