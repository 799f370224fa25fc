//! How likely each lobe is, and which one is drawn.

use super::{Lobes, SCATTERS, dot};
use crate::material::flipped;
use crate::{Backend, Material};

/// What is handed on from one direction of a chunk to the next, and where directions are put that belong together.
#[derive(Debug, Default)]
pub(super) struct Room {
    /// Which directions of the chunk.
    pub(super) queries: Vec<u16>,
    pub(super) known: Vec<[f32; 3]>,
    pub(super) other: Vec<[f32; 3]>,
    pub(super) u: Vec<[f32; 2]>,
    pub(super) values: Vec<f32>,
}

impl Room {
    /// Chooses directions of a chunk by their number.
    pub(super) fn choose(&mut self, count: usize, is_wanted: impl Fn(usize) -> bool) {
        self.queries.clear();
        self.queries.resize(count, 0);
        let mut found = 0;
        for query in 0..count {
            // Written whatever it is, so that the processor has nothing to guess.
            self.queries[found] = query as u16;
            found += usize::from(is_wanted(query));
        }
        self.queries.truncate(found);
        self.values.clear();
        self.values.resize(found, 0.0);
    }

    /// Copies the known directions that are chosen, with the other side up if they are to be flipped.
    pub(super) fn pick_known(&mut self, from: &[[f32; 3]], flip: bool) {
        pick(&self.queries, from, flip, &mut self.known);
    }

    /// As [`pick_known`](Self::pick_known), for the other direction of pairs.
    pub(super) fn pick_other(&mut self, from: &[[f32; 3]], flip: bool) {
        pick(&self.queries, from, flip, &mut self.other);
    }
}

fn pick(queries: &[u16], from: &[[f32; 3]], flip: bool, to: &mut Vec<[f32; 3]>) {
    to.clear();
    if flip {
        to.extend(queries.iter().map(|&query| flipped(from[usize::from(query)])));
    } else {
        to.extend(queries.iter().map(|&query| from[usize::from(query)]));
    }
}

/// Whether a direction lies on that side.
pub(super) fn is_on(direction: [f32; 3], front: bool) -> bool {
    if front { direction[2] > 0.0 } else { direction[2] < 0.0 }
}

impl Lobes {
    /// How likely each lobe is for each direction of a chunk: reflection, transmission, and the mirrors of both.
    pub(super) fn shares(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        room: &mut Room,
        shares: &mut Vec<[f32; 4]>,
    ) {
        shares.clear();
        shares.resize(known.len(), [0.0; 4]);
        for (front, way, lobe) in self.each() {
            room.choose(known.len(), |query| is_on(known[query], front));
            room.pick_known(known, !front && lobe.flips());
            lobe.brightness(backend, &room.known, &mut room.values);
            // A lobe is never left out: what is dark between two slices may be bright in one place. Nor does one exceed all
            // numbers, as the brightness of values near the largest does.
            let share = |b: f32| if b > 1e-6 { b.min(1e30) } else { 1e-6 };
            room.queries.iter().zip(&room.values).for_each(|(&query, &b)| shares[usize::from(query)][way] = share(b));
        }
        if self.has_mirrors {
            let mut reflectance = vec![0.0; self.luminance.len()];
            for (share, &known) in shares.iter_mut().zip(known) {
                for (way, scatter) in SCATTERS.into_iter().enumerate() {
                    if material.mirror(known, scatter, &mut reflectance).is_some() {
                        share[2 + way] = dot(&reflectance, &self.luminance);
                    }
                }
            }
        }
        for share in shares {
            let [a, b, c, d] = *share;
            let total = a + b + c + d;
            let divisor = if total > 0.0 { total } else { 1.0 };
            *share = [a / divisor, b / divisor, c / divisor, d / divisor];
        }
    }
}

/// The lobe that the first number falls on, and two numbers to draw from it with.
pub(super) fn choose(shares: &[f32; 4], [u, w]: [f32; 2]) -> (usize, [f32; 2]) {
    let mut below = 0.0;
    let mut last = (0, [u, w]);
    for (lobe, &share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
        last = (lobe, [((u - below) / share).clamp(0.0, 1.0), w]);
        if u < below + share {
            break;
        }
        below += share;
    }
    last
}

/// As [`choose`], of a reflection and a transmission that are both there: without a branch that nobody can foresee.
pub(super) fn choose_of_two(shares: &[f32; 4], [u, w]: [f32; 2]) -> (usize, [f32; 2]) {
    let [first, second, ..] = *shares;
    let is_first = u < first;
    let (below, share) = if is_first { (0.0, first) } else { (first, second) };
    (usize::from(!is_first), [((u - below) / share).clamp(0.0, 1.0), w])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_lobes_are_chosen_as_any_are() {
        let numbers = [0.0, 0.1, 0.25, 0.25_f32.next_down(), 0.5, 0.75, 1.0 - f32::EPSILON / 2.0, 1.0, -1.0, f32::NAN];
        for share in [0.25, 0.75, 1e-6, 0.5] {
            for u in numbers {
                let shares = [share, 1.0 - share, 0.0, 0.0];
                let ([found, expected], w) = ([choose_of_two(&shares, [u, 0.3]), choose(&shares, [u, 0.3])], 0.3_f32);
                assert_eq!((found.0, found.1[0].to_bits()), (expected.0, expected.1[0].to_bits()), "{share}, {u}");
                assert_eq!((found.1[1], expected.1[1]), (w, w));
            }
        }
    }

    #[test]
    fn shares_of_the_first_number_are_numbers_again() {
        let shares = [0.2, 0.0, 0.5, 0.3];
        for (u, lobe, expected) in [(0.1, 0, 0.5), (0.2, 2, 0.0), (0.45, 2, 0.5), (0.85, 3, 0.5)] {
            let (found, [number, _]) = choose(&shares, [u, 0.0]);
            assert!(found == lobe && (number - expected).abs() < 1e-5, "{u}: {found}, {number}");
        }
    }
}
