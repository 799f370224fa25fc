//! Samples and densities of a mixture, a chunk of directions at a time: each step evaluates all lobes in lanes.

use lobe_table::{Given, Sampled};

use super::mirrors::Choice;
use super::sides::{Lit, Part};
use super::{Lobe, Lobes, SCATTERS};
use crate::material::flipped;
use crate::{Backend, Material};

/// Directions per chunk: few enough that intermediate values stay in the second-level cache, and enough that calls cost
/// little.
const CHUNK: usize = 1024;

/// Intermediate values of a chunk, which the next one overwrites.
#[derive(Debug, Default)]
struct Room {
    lit: Lit,
    parts: [Part; 2],
}

/// The output for the samples of a chunk.
struct Drawn<'a> {
    directions: &'a mut [[f32; 3]],
    pdfs: &'a mut [f32],
}

impl Lobes {
    /// Draws directions; mirrors have a density of infinity.
    pub(in super::super) fn draw(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) {
        let mut room = Room::default();
        let out = directions.chunks_mut(CHUNK).zip(pdfs.chunks_mut(CHUNK));
        for ((known, u), (directions, pdfs)) in known.chunks(CHUNK).zip(u.chunks(CHUNK)).zip(out) {
            self.draw_chunk(material, backend, known, u, Drawn { directions, pdfs }, &mut room);
        }
    }

    pub(in super::super) fn sample(
        &self,
        material: &Material,
        backend: Backend,
        given: Given,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        out: Sampled<'_>,
    ) {
        let channels = material.channel_count();
        let mut room = Room::default();
        let mut at = 0;
        while at < known.len() {
            let part = at..known.len().min(at + CHUNK);
            let known = &known[part.clone()];
            let mut out = Sampled {
                directions: &mut out.directions[part.clone()],
                weights: &mut out.weights[part.start * channels..part.end * channels],
                pdfs: &mut out.pdfs[part.clone()],
            };
            let drawn = Drawn { directions: &mut *out.directions, pdfs: &mut *out.pdfs };
            let choices = self.draw_chunk(material, backend, known, &u[part.clone()], drawn, &mut room);
            let (wi, wo) = if given == Given::Light { (known, &*out.directions) } else { (&*out.directions, known) };
            material.bsdf().eval_batch(backend, wi.into(), wo.into(), out.weights);
            out.times_cosine_over_density();
            let weights = out.weights.chunks_exact_mut(channels).zip(known);
            for ((weight, known), Choice { shares, lobe }) in weights.zip(choices) {
                if lobe >= 2 && material.mirror(*known, SCATTERS[lobe - 2], weight).is_some() {
                    weight.iter_mut().for_each(|reflectance| *reflectance /= shares[lobe]);
                }
            }
            at = part.end;
        }
    }

    /// Samples the directions of a chunk. If there are mirrors, returns the lobe of each sample.
    fn draw_chunk(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        Drawn { directions, pdfs }: Drawn<'_>,
        Room { lit, parts }: &mut Room,
    ) -> Vec<Choice> {
        if let Some(lobe) = self.only(known) {
            lobe.draw(backend, known, u, directions, pdfs);
            return Vec::new();
        }
        directions.fill([0.0; 3]);
        pdfs.fill(0.0);
        if self.has_mirrors {
            return self.draw_with_mirrors(material, backend, known, u, directions, pdfs);
        }
        for (ways, front) in self.lobes.iter().zip([true, false]) {
            if ways.iter().all(Option::is_none) || !lit.choose(known, front) {
                continue;
            }
            lit.take_numbers(u);
            match ways {
                [Some(first), Some(second)] => lit.split([first, second], backend, parts),
                _ => lit.all(&mut parts[0]),
            }
            for (lobe, part) in ways.iter().flatten().zip(&mut *parts) {
                part.draw(lobe, backend);
                for (at, direction, pdf, share) in part.results() {
                    let query = usize::from(lit.at[at]);
                    directions[query] = if front { direction } else { flipped(direction) };
                    pdfs[query] = pdf * share;
                }
            }
        }
        Vec::new()
    }

    pub(in super::super) fn pdf(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        other: &[[f32; 3]],
        pdfs: &mut [f32],
    ) {
        let Room { mut lit, mut parts } = Room::default();
        for ((known, other), pdfs) in known.chunks(CHUNK).zip(other.chunks(CHUNK)).zip(pdfs.chunks_mut(CHUNK)) {
            if let Some(lobe) = self.only(known) {
                lobe.pdf(backend, known, other, pdfs);
                continue;
            }
            pdfs.fill(0.0);
            if self.has_mirrors {
                self.pdf_with_mirrors(material, backend, known, other, pdfs);
                continue;
            }
            for (ways, front) in self.lobes.iter().zip([true, false]) {
                if ways.iter().all(Option::is_none) || !lit.choose(known, front) {
                    continue;
                }
                lit.take_other(other, front);
                match ways {
                    [Some(first), Some(second)] => lit.split_pairs([first, second], backend, &mut parts),
                    _ => lit.all(&mut parts[0]),
                }
                let lobes: Vec<&Lobe> = ways.iter().flatten().collect();
                for (lobe, part) in lobes.into_iter().zip(&mut parts) {
                    part.find_densities(lobe, backend);
                    for (at, _, pdf, share) in part.results() {
                        pdfs[usize::from(lit.at[at])] = pdf * share;
                    }
                }
            }
        }
    }
}
