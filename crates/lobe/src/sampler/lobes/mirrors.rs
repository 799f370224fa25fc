//! Mixtures with mirrors: each direction has up to four lobes.

use lobe_table::Scatter;

use super::sides::{counted, is_on};
use super::{Lobes, SCATTERS, dot};
use crate::material::{flipped, mirrored};
use crate::{Backend, Material};

/// The probabilities of the lobes of a direction, and the lobe that was sampled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    /// Reflection, transmission, and the mirrors of both.
    pub(super) shares: [f32; 4],
    pub(super) lobe: usize,
}

/// The indices of the directions of a chunk that lie on one side.
fn of_side(known: &[[f32; 3]], front: bool) -> Vec<usize> {
    (0..known.len()).filter(|&query| is_on(known[query], front)).collect()
}

/// The directions of some queries, with their side up.
fn pick(directions: &[[f32; 3]], queries: &[usize], front: bool) -> Vec<[f32; 3]> {
    queries.iter().map(|&query| if front { directions[query] } else { flipped(directions[query]) }).collect()
}

impl Lobes {
    /// The probability of each lobe for each direction of a chunk: reflection, transmission, and the mirrors of both.
    fn shares_with_mirrors(&self, material: &Material, backend: Backend, known: &[[f32; 3]]) -> Vec<[f32; 4]> {
        let mut shares = vec![[0.0; 4]; known.len()];
        for (front, way, lobe) in self.each() {
            let queries = of_side(known, front);
            let mut brightness = vec![0.0; queries.len()];
            lobe.brightness(backend, &pick(known, &queries, front), &mut brightness);
            queries.iter().zip(&brightness).for_each(|(&query, &b)| shares[query][way] = counted(b));
        }
        let mut reflectance = vec![0.0; self.luminance.len()];
        for (share, &known) in shares.iter_mut().zip(known) {
            for (way, scatter) in SCATTERS.into_iter().enumerate() {
                if material.mirror(known, scatter, &mut reflectance).is_some() {
                    share[2 + way] = dot(&reflectance, &self.luminance);
                }
            }
        }
        for share in &mut shares {
            let total: f32 = share.iter().sum();
            if total > 0.0 {
                share.iter_mut().for_each(|part| *part /= total);
            }
        }
        shares
    }

    /// Samples directions of a chunk; mirrors have infinite density. Returns the lobe of each sample.
    pub(super) fn draw_with_mirrors(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) -> Vec<Choice> {
        let shares = self.shares_with_mirrors(material, backend, known);
        // The first number chooses the lobe; what is left of it, rescaled, is again uniform.
        let chosen: Vec<(usize, [f32; 2])> = shares.iter().zip(u).map(|(shares, &u)| choose(shares, u)).collect();
        for (front, way, lobe) in self.each() {
            let mut queries = of_side(known, front);
            queries.retain(|&query| chosen[query].0 == way && shares[query][way] > 0.0);
            let u: Vec<[f32; 2]> = queries.iter().map(|&query| chosen[query].1).collect();
            let (mut drawn, mut found) = (vec![[0.0; 3]; queries.len()], vec![0.0; queries.len()]);
            lobe.draw(backend, &pick(known, &queries, front), &u, &mut drawn, &mut found);
            for ((&query, direction), pdf) in queries.iter().zip(drawn).zip(found) {
                directions[query] = if front { direction } else { flipped(direction) };
                pdfs[query] = pdf * shares[query][way];
            }
        }
        for (query, &(lobe, _)) in chosen.iter().enumerate().filter(|(_, (lobe, _))| *lobe >= 2) {
            (directions[query], pdfs[query]) = (mirrored(known[query], SCATTERS[lobe - 2]), f32::INFINITY);
        }
        chosen.iter().zip(shares).map(|(&(lobe, _), shares)| Choice { shares, lobe }).collect()
    }

    /// The densities of the pairs of a chunk.
    pub(super) fn pdf_with_mirrors(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        other: &[[f32; 3]],
        pdfs: &mut [f32],
    ) {
        let shares = self.shares_with_mirrors(material, backend, known);
        for (front, way, lobe) in self.each() {
            let mut queries = of_side(known, front);
            let is_above = |query: usize| (known[query][2] > 0.0) == (other[query][2] > 0.0);
            queries.retain(|&query| is_above(query) == (SCATTERS[way] == Scatter::Reflection));
            let mut found = vec![0.0; queries.len()];
            let [known, other] = [known, other].map(|from| pick(from, &queries, front));
            lobe.pdf(backend, &known, &other, &mut found);
            queries.iter().zip(found).for_each(|(&query, pdf)| pdfs[query] = pdf * shares[query][way]);
        }
    }
}

/// The lobe that the first number selects, and two numbers to sample it with.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_the_first_number_is_rescaled() {
        let shares = [0.2, 0.0, 0.5, 0.3];
        for (u, lobe, expected) in [(0.1, 0, 0.5), (0.2, 2, 0.0), (0.45, 2, 0.5), (0.85, 3, 0.5)] {
            let (found, [number, _]) = choose(&shares, [u, 0.0]);
            assert!(found == lobe && (number - expected).abs() < 1e-5, "{u}: {found}, {number}");
        }
    }
}
