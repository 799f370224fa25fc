//! Several measurements of one sheet: the sides of the two directions select the measurement.

use lobe_table::{Aspect, Bsdf, Channels, Directions, Kind, Scatter, Side};

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

/// The same direction with the other side up.
pub(crate) fn flipped([x, y, z]: [f32; 3]) -> [f32; 3] {
    [x, y, -z]
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
}
