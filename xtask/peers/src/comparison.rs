//! Checks that the values of a peer agree with those of this library, and decides which is right if they do not.

use std::collections::BTreeSet;

use anyhow::bail;

/// The allowed difference of values.
#[derive(Clone, Copy, Debug)]
pub struct Agreement {
    /// The largest difference, relative to the peer's value.
    pub relative: f64,
    /// The least value that the difference is relative to.
    pub floor: f64,
    /// The share of values that may differ by more.
    pub outliers: f64,
}

impl Agreement {
    /// The relative difference of two values; infinite if either is NaN.
    fn difference(&self, ours: f32, theirs: f32) -> f64 {
        let (ours, theirs) = (f64::from(ours), f64::from(theirs));
        let difference = (ours - theirs).abs() / theirs.abs().max(self.floor);
        if difference.is_nan() { f64::INFINITY } else { difference }
    }
}

/// How the values of a peer differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The largest relative difference, except for allowed outliers and those in which only the peer may be wrong.
    pub largest: f64,
    /// Number of answers of the peer that are wrong according to the judge.
    pub wrong: usize,
}

/// A judge that decides if values differ. It is slow and exact.
pub trait Judge {
    /// Number of questions. The values at `question`, `question + questions`, ... are the answer to a question.
    fn questions(&self) -> usize;

    /// `true` if values are a correct answer to a question.
    fn is_right(&self, question: usize, answer: &[f32]) -> bool;
}

/// The most answers that a judge is asked about. If more differ, rounding is not the cause, and all of them count.
const MOST: usize = 100;

/// Removes the differences above `limit` of correct answers. Returns the number of wrong answers of the peer.
fn decide(judge: &dyn Judge, limit: f64, differences: &mut [f64], ours: &[f32], theirs: &[f32]) -> usize {
    let (count, questions) = (differences.len(), judge.questions());
    let asked: BTreeSet<usize> = (0..count).filter(|at| differences[*at] > limit).map(|at| at % questions).collect();
    if asked.len() > MOST {
        return 0;
    }
    let mut wrong = 0;
    for question in asked {
        let places = || (question..count).step_by(questions);
        let is_right = |values: &[f32]| judge.is_right(question, &places().map(|at| values[at]).collect::<Vec<_>>());
        wrong += usize::from(!is_right(theirs));
        if is_right(ours) {
            for at in places() {
                if differences[at] > limit {
                    differences[at] = 0.0;
                }
            }
        }
    }
    wrong
}

/// Compares the values of a peer with those of this library; `names` are those of the question, its input and the peer.
/// Without an agreement they are of different materials, and only need to be finite.
///
/// # Errors
/// If they differ by more than allowed.
pub fn compare(
    agreement: Option<Agreement>,
    judge: Option<&dyn Judge>,
    names: (&str, &str, &str),
    ours: &[f32],
    theirs: &[f32],
) -> anyhow::Result<Option<Difference>> {
    let (id, on, peer) = names;
    let Some(agreement) = agreement else {
        if !ours.iter().chain(theirs).all(|value| value.is_finite()) {
            bail!("{id} {on}: {peer} or lobe gives values that are not numbers");
        }
        return Ok(None);
    };
    let limit = agreement.relative;
    let pairs = ours.iter().zip(theirs);
    let mut differences: Vec<f64> = pairs.map(|(ours, theirs)| agreement.difference(*ours, *theirs)).collect();
    let wrong = judge.map_or(0, |judge| decide(judge, limit, &mut differences, ours, theirs));
    let kept = differences.len() - 1 - (differences.len() as f64 * agreement.outliers) as usize;
    let (_, &mut largest, _) = differences.select_nth_unstable_by(kept, f64::total_cmp);
    if largest > limit {
        bail!("{id} {on}: the values of {peer} differ by up to {largest:.1e}; {limit:.1e} is allowed");
    }
    Ok(Some(Difference { largest, wrong }))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: Agreement = Agreement { relative: 1e-3, floor: 0.1, outliers: 0.0 };

    fn judged(
        agreement: Agreement,
        judge: Option<&dyn Judge>,
        ours: &[f32],
        theirs: &[f32],
    ) -> anyhow::Result<Difference> {
        compare(Some(agreement), judge, ("question", "input", "peer"), ours, theirs).map(|found| found.unwrap())
    }

    fn difference(agreement: Agreement, ours: &[f32], theirs: &[f32]) -> anyhow::Result<f64> {
        judged(agreement, None, ours, theirs).map(|found| found.largest)
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

    /// Expects answers of two values: the question's number, and 7 or 8.
    struct Sevens(usize);

    impl Judge for Sevens {
        fn questions(&self) -> usize {
            self.0
        }

        fn is_right(&self, question: usize, answer: &[f32]) -> bool {
            answer.len() == 2 && answer[0] == question as f32 && [7.0, 8.0].contains(&answer[1])
        }
    }

    impl Sevens {
        fn answers(&self) -> Vec<f32> {
            (0..self.0).map(|question| question as f32).chain(vec![7.0; self.0]).collect()
        }
    }

    #[test]
    fn only_wrong_answers_of_this_library_count_and_those_of_the_peer_are_reported() {
        let judge = Sevens(1000);
        let right = judge.answers();
        let with = |changes: &[(usize, f32)]| {
            let mut values = right.clone();
            changes.iter().for_each(|&(at, value)| values[at] = value);
            values
        };
        let found = |ours: &[f32], theirs: &[f32]| judged(EXACT, Some(&judge), ours, theirs);
        let peer = with(&[(20, 21.0), (1020, 9.0), (1030, 8.0), (40, f32::NAN)]);
        assert_eq!(found(&right, &peer).unwrap(), Difference { largest: 0.0, wrong: 2 });
        found(&with(&[(50, 51.0)]), &right).unwrap_err();
        found(&with(&[(1050, 9.0)]), &right).unwrap_err();
        found(&with(&[(1050, f32::NAN)]), &right).unwrap_err();
        // Both are wrong, in different ways.
        found(&with(&[(1050, 9.0)]), &with(&[(1050, 10.0)])).unwrap_err();
        // The judge is not asked about differences below the limit.
        let near = found(&right, &with(&[(1020, 7.0035), (1030, 8.0)])).unwrap();
        assert!((near.largest - 5e-4).abs() < 1e-6 && near.wrong == 0, "{near:?}");
    }

    #[test]
    fn differences_everywhere_are_not_excused() {
        let judge = Sevens(1000);
        let right = judge.answers();
        let eights = |count: usize| [&right[..1000], &vec![8.0; count], &right[1000 + count..]].concat();
        assert_eq!(judged(EXACT, Some(&judge), &right, &eights(MOST)).unwrap().wrong, 0);
        judged(EXACT, Some(&judge), &right, &eights(MOST + 1)).unwrap_err();
    }
}
