//! Several measurements of one sheet: the sides of the two directions select the measurement.

use lobe_table::mueller::Matrix;
use lobe_table::{Aspect, Bsdf, Channels, Directions, Kind, Scatter, Side};

use super::frames::{at_wavelength, depolariser, flipped, unflipped, upright};
use crate::Backend;

/// The kind of a material that consists of several measurements.
pub const SHEET: Kind = Kind::new("sheet");

/// A measurement, and the directions that it applies to.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) scatter: Scatter,
    /// `None` means both sides.
    pub(super) side: Option<Side>,
    pub(super) bsdf: Box<dyn Bsdf>,
}

impl Part {
    fn answers(&self, wi: [f32; 3], wo: [f32; 3]) -> bool {
        let opposite = match self.scatter {
            Scatter::Reflection => 1.0,
            Scatter::Transmission => -1.0,
        };
        let is_on_side = match self.side {
            None => true,
            Some(Side::Front) => wi[2] > 0.0,
            Some(Side::Back) => wi[2] < 0.0,
        };
        // Compares signs, because a product of small numbers may vanish.
        is_on_side && (wi[2] > 0.0 && opposite * wo[2] > 0.0 || wi[2] < 0.0 && opposite * wo[2] < 0.0)
    }
}

/// At least one part; all have the same channels.
#[derive(Debug)]
pub(super) struct Sheet {
    pub(super) channels: Channels,
    pub(super) parts: Vec<Part>,
}

impl Sheet {
    /// `true` if a part was measured with light from that side.
    fn measures(&self, aspect: Aspect) -> bool {
        let fits = |part: &Part| part.scatter == aspect.scatter && part.side.is_none_or(|side| side == aspect.light);
        self.parts.iter().any(fits)
    }
}

impl Bsdf for Sheet {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn bytes(&self) -> usize {
        self.parts.iter().map(|part| part.bsdf.bytes()).sum()
    }

    fn is_isotropic(&self) -> bool {
        self.parts.iter().all(|part| part.bsdf.is_isotropic())
    }

    fn holds(&self, aspect: Aspect) -> bool {
        self.measures(aspect) || (aspect.scatter == Scatter::Transmission && self.measures(aspect.reversed()))
    }

    /// Transmission that was measured in one direction only is assumed to be the same in the other one (Helmholtz
    /// reciprocity).
    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        let (count, channels) = (wi.count(), self.channels.count());
        assert_eq!(count, wo.count(), "as many wi as wo");
        assert_eq!(out.len(), count * channels, "one value per query and channel");
        out.fill(0.0);
        let transmission = |light| Aspect { scatter: Scatter::Transmission, light };
        let through = [Side::Front, Side::Back].map(|light| self.measures(transmission(light)));
        for part in &self.parts {
            let (mut queries, mut lights, mut viewers) = (Vec::new(), Vec::new(), Vec::new());
            for query in 0..count {
                let (mut light, mut viewer) = (wi.get(query), wo.get(query));
                if part.scatter == Scatter::Transmission && !through[usize::from(light[2] < 0.0)] {
                    (light, viewer) = (viewer, light);
                }
                if part.answers(light, viewer) {
                    // Measurements from behind were made with that side up.
                    if light[2] < 0.0 {
                        (light, viewer) = (flipped(light), flipped(viewer));
                    }
                    queries.push(query);
                    lights.push(light);
                    viewers.push(viewer);
                }
            }
            let mut values = vec![0.0; queries.len() * channels];
            part.bsdf.eval_batch(backend, (&lights).into(), (&viewers).into(), &mut values);
            for (&query, value) in queries.iter().zip(values.chunks_exact(channels)) {
                out[query * channels..][..channels].copy_from_slice(value);
            }
        }
    }

    fn is_polarised(&self) -> bool {
        self.parts.iter().any(|part| part.bsdf.is_polarised())
    }

    /// Parts without matrices depolarise light.
    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        if !self.is_polarised() {
            return None;
        }
        // Of several parts for the same sides, the last counts, as for values.
        let answers = |part: &&Part| part.bsdf.is_polarised() && part.answers(wi, wo);
        if let Some(part) = self.parts.iter().rev().find(answers) {
            let (light, viewer, is_flipped) = upright(wi, wo);
            let matrix = part.bsdf.mueller(light, viewer, nm)?;
            return Some(if is_flipped { unflipped(matrix, wi, wo) } else { matrix });
        }
        let mut values = vec![0.0; self.channels.count()];
        self.eval_batch(Backend::best(), (&[wi]).into(), (&[wo]).into(), &mut values);
        match &self.channels {
            Channels::Spectral(wavelengths) => Some(depolariser(at_wavelength(wavelengths, &values, nm))),
            _ => None,
        }
    }

    fn mueller_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
        if !self.is_polarised() {
            return false;
        }
        let (count, channels) = (wi.count(), self.channels.count());
        assert_eq!(count, wo.count(), "as many wi as wo");
        assert_eq!(out.len(), 16 * count * channels, "one matrix per query and channel");
        let mut values = vec![0.0; count * channels];
        self.eval_batch(backend, wi, wo, &mut values);
        out.fill(0.0);
        out.chunks_exact_mut(16).zip(&values).for_each(|(matrix, value)| matrix[0] = *value);
        for part in self.parts.iter().filter(|part| part.bsdf.is_polarised()) {
            let (mut queries, mut lights, mut viewers) = (Vec::new(), Vec::new(), Vec::new());
            for query in (0..count).filter(|query| part.answers(wi.get(*query), wo.get(*query))) {
                let (light, viewer, is_flipped) = upright(wi.get(query), wo.get(query));
                queries.push((query, is_flipped));
                lights.push(light);
                viewers.push(viewer);
            }
            let mut found = vec![0.0; 16 * channels * queries.len()];
            part.bsdf.mueller_batch(backend, (&lights).into(), (&viewers).into(), &mut found);
            for ((query, is_flipped), matrices) in queries.into_iter().zip(found.chunks_exact(16 * channels)) {
                let out = &mut out[16 * channels * query..][..16 * channels];
                out.copy_from_slice(matrices);
                if is_flipped {
                    let (matrices, _) = out.as_chunks_mut::<16>();
                    for matrix in matrices {
                        let upright: Matrix =
                            std::array::from_fn(|i| std::array::from_fn(|j| matrix[4 * i + j].into()));
                        let turned = unflipped(upright, wi.get(query), wo.get(query));
                        matrix.iter_mut().zip(turned.as_flattened()).for_each(|(out, x)| *out = *x as f32);
                    }
                }
            }
        }
        true
    }
}
