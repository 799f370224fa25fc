//! Splits a chunk of directions by side, and the directions of a side by the lobe that samples each.

use super::Lobe;
use crate::Backend;
use crate::material::flipped;

/// Directions of one side, with this side up.
#[derive(Debug, Default)]
pub(super) struct Lit {
    /// Their indices in the chunk.
    pub(super) at: Vec<u16>,
    known: Vec<[f32; 3]>,
    other: Vec<[f32; 3]>,
    u: Vec<[f32; 2]>,
    brightness: [Vec<f32>; 2],
}

/// Directions for which one lobe samples or evaluates densities.
#[derive(Debug, Default)]
pub(super) struct Part {
    count: usize,
    /// Their indices among the directions of the side.
    at: Vec<u16>,
    /// The probability of the lobe for each.
    share: Vec<f32>,
    known: Vec<[f32; 3]>,
    other: Vec<[f32; 3]>,
    u: Vec<[f32; 2]>,
    pdfs: Vec<f32>,
}

impl Part {
    /// Room for this many directions.
    fn make_room(&mut self, count: usize) {
        self.count = 0;
        if self.at.len() < count {
            self.at.resize(count, 0);
            self.share.resize(count, 0.0);
            self.known.resize(count, [0.0; 3]);
            self.other.resize(count, [0.0; 3]);
            self.u.resize(count, [0.0; 2]);
            self.pdfs.resize(count, 0.0);
        }
    }

    /// Samples all directions.
    pub(super) fn draw(&mut self, lobe: &Lobe, backend: Backend) {
        let Part { count, known, other, u, pdfs, .. } = self;
        let count = *count;
        lobe.draw(backend, &known[..count], &u[..count], &mut other[..count], &mut pdfs[..count]);
    }

    /// Finds all densities.
    pub(super) fn find_densities(&mut self, lobe: &Lobe, backend: Backend) {
        let Part { count, known, other, pdfs, .. } = self;
        let count = *count;
        lobe.pdf(backend, &known[..count], &other[..count], &mut pdfs[..count]);
    }

    /// The result for each: its index among the directions of the side, the direction, the density, and the probability
    /// of the lobe.
    pub(super) fn results(&self) -> impl Iterator<Item = (usize, [f32; 3], f32, f32)> {
        let Part { count, at, share, other, pdfs, .. } = self;
        let results = at.iter().zip(other).zip(pdfs).zip(share).take(*count);
        results.map(|(((&at, &direction), &pdf), &share)| (usize::from(at), direction, pdf, share))
    }
}

/// The brightness of a lobe, limited so that the lobe is never left out, because a lobe that is dark between two slices
/// may be bright in one direction, and so that it stays finite, even for values near the largest number.
pub(super) fn counted(brightness: f32) -> f32 {
    if brightness > 1e-6 { brightness.min(1e30) } else { 1e-6 }
}

/// `true` if a direction lies on this side.
pub(super) fn is_on(direction: [f32; 3], front: bool) -> bool {
    if front { direction[2] > 0.0 } else { direction[2] < 0.0 }
}

impl Lit {
    /// Chooses the directions of a side; `false` if there are none.
    pub(super) fn choose(&mut self, directions: &[[f32; 3]], front: bool) -> bool {
        let Lit { at, known, .. } = self;
        at.clear();
        known.clear();
        if front && directions.iter().all(|&direction| is_on(direction, true)) {
            at.extend(0..directions.len() as u16);
            known.extend_from_slice(directions);
        } else {
            let on_side = directions.iter().enumerate().filter(|(_, direction)| is_on(**direction, front));
            for (query, &direction) in on_side {
                at.push(query as u16);
                known.push(if front { direction } else { flipped(direction) });
            }
        }
        !at.is_empty()
    }

    /// Takes the random numbers of the chosen directions.
    pub(super) fn take_numbers(&mut self, from: &[[f32; 2]]) {
        self.u.clear();
        self.u.extend(self.at.iter().map(|&query| from[usize::from(query)]));
    }

    /// Takes the other directions of pairs, with the side of the known ones up.
    pub(super) fn take_other(&mut self, from: &[[f32; 3]], front: bool) {
        self.other.clear();
        let other = self.at.iter().map(|&query| from[usize::from(query)]);
        self.other.extend(other.map(|direction| if front { direction } else { flipped(direction) }));
    }

    fn find_brightness(&mut self, lobes: [&Lobe; 2], backend: Backend) {
        let Lit { known, brightness, .. } = self;
        for (lobe, brightness) in lobes.into_iter().zip(brightness) {
            brightness.resize(known.len(), 0.0);
            lobe.brightness(backend, known, brightness);
        }
    }

    /// Splits numbers, with their directions, between two lobes by their brightness. What is left of the first number,
    /// rescaled, is again uniform.
    pub(super) fn split(&mut self, lobes: [&Lobe; 2], backend: Backend, [first, second]: &mut [Part; 2]) {
        self.find_brightness(lobes, backend);
        let Lit { known, u, brightness: [bright, others], .. } = self;
        first.make_room(known.len());
        second.make_room(known.len());
        let (mut firsts, mut seconds) = (0, 0);
        let queries = known.iter().zip(u).zip(bright.iter().zip(others));
        for (at, ((known, [number, other]), (bright, other_bright))) in queries.enumerate() {
            let shares = shares([*bright, *other_bright]);
            let (is_second, share, number) = choose(shares, *number);
            // Written to both and kept in one, so that there is no branch to mispredict.
            for (part, count) in [(&mut *first, firsts), (&mut *second, seconds)] {
                part.at[count] = at as u16;
                part.known[count] = *known;
                part.u[count] = [number, *other];
                part.share[count] = share;
            }
            firsts += usize::from(!is_second);
            seconds += usize::from(is_second);
        }
        (first.count, second.count) = (firsts, seconds);
    }

    /// Splits pairs between reflection and transmission by the side of the other direction.
    pub(super) fn split_pairs(&mut self, lobes: [&Lobe; 2], backend: Backend, [first, second]: &mut [Part; 2]) {
        self.find_brightness(lobes, backend);
        let Lit { known, other, brightness: [bright, others], .. } = self;
        first.make_room(known.len());
        second.make_room(known.len());
        let (mut firsts, mut seconds) = (0, 0);
        let queries = known.iter().zip(other).zip(bright.iter().zip(others));
        for (at, ((known, other), (bright, other_bright))) in queries.enumerate() {
            let shares = shares([*bright, *other_bright]);
            let is_first = other[2] > 0.0;
            for (part, count) in [(&mut *first, firsts), (&mut *second, seconds)] {
                part.at[count] = at as u16;
                part.known[count] = *known;
                part.other[count] = *other;
                part.share[count] = shares[usize::from(!is_first)];
            }
            firsts += usize::from(is_first);
            seconds += usize::from(!is_first);
        }
        (first.count, second.count) = (firsts, seconds);
    }

    /// Gives all numbers, with their directions, to the only lobe.
    pub(super) fn all(&self, part: &mut Part) {
        let count = self.known.len();
        part.make_room(count);
        part.count = count;
        part.at.clear();
        part.at.extend(0..count as u16);
        part.share[..count].fill(1.0);
        part.known[..count].copy_from_slice(&self.known);
        if self.u.len() == count {
            part.u[..count].copy_from_slice(&self.u);
        }
        if self.other.len() == count {
            part.other[..count].copy_from_slice(&self.other);
        }
    }
}

/// The probabilities of two lobes.
fn shares(brightness: [f32; 2]) -> [f32; 2] {
    let [first, second] = brightness.map(counted);
    let total = first + second;
    [first / total, second / total]
}

/// `true` if a number selects the second of two lobes, the probability of the selected lobe, and what is left of the
/// number, rescaled.
fn choose([first, second]: [f32; 2], number: f32) -> (bool, f32, f32) {
    let is_first = number < first;
    let (below, share) = if is_first { (0.0, first) } else { (first, second) };
    (!is_first, share, ((number - below) / share).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::super::mirrors;
    use super::*;

    #[test]
    fn two_lobes_are_chosen_as_any_are() {
        let numbers = [0.0, 0.1, 0.25, 0.25_f32.next_down(), 0.5, 0.75, 1.0 - f32::EPSILON / 2.0, 1.0, -1.0, f32::NAN];
        for share in [0.25, 0.75, 1e-6, 0.5] {
            for u in numbers {
                let (is_second, found_share, found) = choose([share, 1.0 - share], u);
                let shares = [share, 1.0 - share, 0.0, 0.0];
                let (lobe, [expected, _]) = mirrors::choose(&shares, [u, 0.3]);
                assert_eq!((usize::from(is_second), found.to_bits()), (lobe, expected.to_bits()), "{share}, {u}");
                assert_eq!(found_share, shares[lobe]);
            }
        }
    }
}
