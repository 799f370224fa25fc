//! Draws and densities of a mixture, a chunk of directions at a time: each step asks all lobes in lanes.

use lobe_table::{Given, Sampled, Scatter};

use super::shares::{Room, choose, choose_of_two, is_on};
use super::{Lobes, SCATTERS};
use crate::material::{flipped, mirrored};
use crate::{Backend, Material};

/// Directions at a time: few enough that what is handed on stays in the first cache.
const CHUNK: usize = 512;

/// What a chunk was drawn from.
#[derive(Debug, Default)]
struct Choices {
    room: Room,
    /// How likely each lobe was.
    shares: Vec<[f32; 4]>,
    /// The lobe of each direction, and the numbers that are left for it. Empty if there is only one.
    chosen: Vec<(usize, [f32; 2])>,
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
        let mut choices = Choices::default();
        let mut at = 0;
        while at < known.len() {
            let part = at..known.len().min(at + CHUNK);
            let (directions, pdfs) = (&mut directions[part.clone()], &mut pdfs[part.clone()]);
            self.draw_chunk(material, backend, &known[part.clone()], &u[part.clone()], directions, pdfs, &mut choices);
            at = part.end;
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
        let mut choices = Choices::default();
        let mut at = 0;
        while at < known.len() {
            let part = at..known.len().min(at + CHUNK);
            let known = &known[part.clone()];
            let mut out = Sampled {
                directions: &mut out.directions[part.clone()],
                weights: &mut out.weights[part.start * channels..part.end * channels],
                pdfs: &mut out.pdfs[part.clone()],
            };
            self.draw_chunk(material, backend, known, &u[part.clone()], out.directions, out.pdfs, &mut choices);
            let (wi, wo) = if given == Given::Light { (known, &*out.directions) } else { (&*out.directions, known) };
            material.bsdf().eval_batch(backend, wi.into(), wo.into(), out.weights);
            out.times_cosine_over_density();
            if self.has_mirrors {
                let weights = out.weights.chunks_exact_mut(channels);
                for ((weight, known), (&(lobe, _), shares)) in
                    weights.zip(known).zip(choices.chosen.iter().zip(&choices.shares))
                {
                    if lobe >= 2 && material.mirror(*known, SCATTERS[lobe - 2], weight).is_some() {
                        weight.iter_mut().for_each(|reflectance| *reflectance /= shares[lobe]);
                    }
                }
            }
            at = part.end;
        }
    }

    #[expect(clippy::too_many_arguments, reason = "two for where they come from, and two for where they go")]
    fn draw_chunk(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
        Choices { room, shares, chosen }: &mut Choices,
    ) {
        if let Some(lobe) = self.only(known) {
            return lobe.draw(backend, known, u, directions, pdfs);
        }
        directions.fill([0.0; 3]);
        pdfs.fill(0.0);
        self.shares(material, backend, known, room, shares);
        // The first number chooses the lobe, and what is left of it is as even as it was.
        chosen.clear();
        let both = !self.has_mirrors && self.lobes.iter().all(|ways| ways.iter().all(Option::is_some));
        if both && known.iter().all(|direction| direction[2].abs() > 0.0) {
            chosen.extend(shares.iter().zip(u).map(|(shares, &u)| choose_of_two(shares, u)));
        } else {
            chosen.extend(shares.iter().zip(u).map(|(shares, &u)| choose(shares, u)));
        }
        for (front, way, lobe) in self.each() {
            room.choose(known.len(), |query| {
                is_on(known[query], front) & (chosen[query].0 == way) & (shares[query][way] > 0.0)
            });
            let flips = !front && lobe.flips();
            room.pick_known(known, flips);
            room.u.clear();
            room.u.extend(room.queries.iter().map(|&query| chosen[usize::from(query)].1));
            room.other.clear();
            room.other.resize(room.queries.len(), [0.0; 3]);
            lobe.draw(backend, &room.known, &room.u, &mut room.other, &mut room.values);
            for ((&query, &direction), &pdf) in room.queries.iter().zip(&room.other).zip(&room.values) {
                let query = usize::from(query);
                directions[query] = if flips { flipped(direction) } else { direction };
                pdfs[query] = pdf * shares[query][way];
            }
        }
        if self.has_mirrors {
            for (query, &(lobe, _)) in chosen.iter().enumerate().filter(|(_, (lobe, _))| *lobe >= 2) {
                (directions[query], pdfs[query]) = (mirrored(known[query], SCATTERS[lobe - 2]), f32::INFINITY);
            }
        }
    }

    pub(in super::super) fn pdf(
        &self,
        material: &Material,
        backend: Backend,
        known: &[[f32; 3]],
        other: &[[f32; 3]],
        pdfs: &mut [f32],
    ) {
        let (mut room, mut shares) = (Room::default(), Vec::new());
        for ((known, other), pdfs) in known.chunks(CHUNK).zip(other.chunks(CHUNK)).zip(pdfs.chunks_mut(CHUNK)) {
            if let Some(lobe) = self.only(known) {
                lobe.pdf(backend, known, other, pdfs);
                continue;
            }
            self.shares(material, backend, known, &mut room, &mut shares);
            pdfs.fill(0.0);
            for (front, way, lobe) in self.each() {
                let reflects = SCATTERS[way] == Scatter::Reflection;
                room.choose(known.len(), |query| {
                    let is_above = (known[query][2] > 0.0) == (other[query][2] > 0.0);
                    is_on(known[query], front) & (is_above == reflects)
                });
                let flips = !front && lobe.flips();
                room.pick_known(known, flips);
                room.pick_other(other, flips);
                lobe.pdf(backend, &room.known, &room.other, &mut room.values);
                for (&query, &pdf) in room.queries.iter().zip(&room.values) {
                    pdfs[usize::from(query)] = pdf * shares[usize::from(query)][way];
                }
            }
        }
    }
}
