//! Sampling in proportion to the cosine, which works for every function without a better scheme.

use std::f32::consts::{PI, TAU};

use lobe_backend::Backend;

use super::Bsdf;
use crate::{Aspect, Given, Sampled, Scatter, Side};

/// The kinds of scatter that a function has for light from the side of a direction.
fn ways<B: Bsdf + ?Sized>(bsdf: &B, known: [f32; 3]) -> [bool; 2] {
    let light = Side::of(known);
    [Scatter::Reflection, Scatter::Transmission].map(|scatter| bsdf.holds(Aspect { scatter, light }))
}

pub(super) fn sample_batch<B: Bsdf + ?Sized>(
    bsdf: &B,
    backend: Backend,
    given: Given,
    known: &[[f32; 3]],
    u: &[[f32; 2]],
    mut out: Sampled<'_>,
) {
    let (count, channels) = (known.len(), bsdf.channels().count());
    assert_eq!(u.len(), count, "a pair of numbers per direction");
    assert_eq!((out.directions.len(), out.pdfs.len()), (count, count), "an output per direction");
    assert_eq!(out.weights.len(), count * channels, "a weight per direction and channel");
    for (query, (&known, &u)) in known.iter().zip(u).enumerate() {
        (out.directions[query], out.pdfs[query]) = draw(ways(bsdf, known), known, u);
    }
    let sampled = &*out.directions;
    let (wi, wo) = if given == Given::Light { (known, sampled) } else { (sampled, known) };
    bsdf.eval_batch(backend, wi.into(), wo.into(), out.weights);
    out.times_cosine_over_density();
}

/// A direction on one of the sides that light leaves to, and its density.
fn draw(ways: [bool; 2], known: [f32; 3], [u, w]: [f32; 2]) -> ([f32; 3], f32) {
    let (passes, u, share) = match ways {
        [false, false] => return ([0.0; 3], 0.0),
        [true, false] => (false, u, 1.0),
        [false, true] => (true, u, 1.0),
        [true, true] if u < 0.5 => (false, 2.0 * u, 0.5),
        [true, true] => (true, 2.0 * u - 1.0, 0.5),
    };
    if known[2] == 0.0 || !known[2].is_finite() {
        return ([0.0; 3], 0.0);
    }
    let (sin, cos) = (u.sqrt(), (1.0 - u).max(0.0).sqrt());
    let (y, x) = (TAU * w).sin_cos();
    let z = if (known[2] > 0.0) != passes { cos } else { -cos };
    ([sin * x, sin * y, z], share * cos / PI)
}

pub(super) fn pdf_batch<B: Bsdf + ?Sized>(bsdf: &B, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
    assert_eq!((wi.len(), wo.len()), (pdfs.len(), pdfs.len()), "as many wi as wo and densities");
    let (known, other) = if given == Given::Light { (wi, wo) } else { (wo, wi) };
    for ((&known, &other), pdf) in known.iter().zip(other).zip(pdfs) {
        let ways = ways(bsdf, known);
        let passes = (known[2] > 0.0) != (other[2] > 0.0);
        let share = if ways == [true, true] { 0.5 } else { 1.0 };
        let is_held = ways[usize::from(passes)] && known[2] != 0.0;
        *pdf = if is_held { share * other[2].abs() / PI } else { 0.0 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Channels, Directions};

    /// Scatters 0.6 of the light, half of it reflected and half transmitted.
    #[derive(Debug)]
    struct White;

    impl Bsdf for White {
        fn channels(&self) -> &Channels {
            &Channels::Mono
        }

        fn holds(&self, _: Aspect) -> bool {
            true
        }

        fn eval_batch(&self, _: Backend, _: Directions<'_>, _: Directions<'_>, out: &mut [f32]) {
            out.fill(0.3 / PI);
        }
    }

    #[test]
    fn every_weight_of_a_white_sheet_is_its_albedo() {
        let known: Vec<[f32; 3]> = (0..64).map(|i| [0.6, 0.0, if i % 2 == 0 { 0.8 } else { -0.8 }]).collect();
        let u: Vec<[f32; 2]> = (0..64).map(|i| [(i as f32 + 0.5) / 64.0, (i * 29 % 64) as f32 / 64.0]).collect();
        let (mut directions, mut weights, mut pdfs) = (vec![[0.0; 3]; 64], vec![0.0; 64], vec![0.0; 64]);
        let out = Sampled { directions: &mut directions, weights: &mut weights, pdfs: &mut pdfs };
        White.sample_batch(Backend::best(), Given::Light, &known, &u, out);
        assert!(weights.iter().all(|weight| (weight - 0.6).abs() < 1e-5), "{weights:?}");
        let mut found = vec![0.0; 64];
        White.pdf_batch(Backend::best(), Given::Light, &known, &directions, &mut found);
        assert!(found.iter().zip(&pdfs).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?} {pdfs:?}");
        let passed = known.iter().zip(&directions).filter(|(a, b)| (a[2] > 0.0) != (b[2] > 0.0)).count();
        assert_eq!(passed, 32);
    }
}
