//! Pairs of directions and their values.

use lobe_colour::Channels;
use lobe_ops::{Aspect, OnBackend, Subject, direction_pairs};
use lobe_table::Representation;
use thiserror::Error;

use crate::geometry::Geometry;

/// The values to which a model is fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    pub(crate) channels: Channels,
    pub(crate) pairs: Vec<Geometry>,
    /// `[pair][channel]`.
    pub(crate) values: Vec<f64>,
    /// The number of pairs that are 0 in all channels, which in files means "not measured".
    pub(crate) left_out: usize,
}

/// Values that are not a valid measurement.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MeasurementError {
    /// There is not one value per pair and channel.
    #[error("found {found} values; expected {expected}, one per pair of directions and channel")]
    Count {
        /// The number of values found.
        found: usize,
        /// The number of pairs times channels.
        expected: usize,
    },
    /// A value is infinite or not a number.
    #[error("found {value} for pair {pair}; expected a finite number")]
    NotFinite {
        /// The index of the pair of directions.
        pair: usize,
        /// The value.
        value: f64,
    },
    /// A direction is not above the surface.
    #[error("found a direction with z = {z} in pair {pair}; expected directions above the surface")]
    Below {
        /// The index of the pair of directions.
        pair: usize,
        /// The height of the direction.
        z: f64,
    },
}

impl Measurement {
    /// Values `[pair][channel]` in 1/sr for pairs of unit vectors with z > 0: first to the light, then to the viewer.
    ///
    /// # Errors
    /// [`MeasurementError`] names the pair.
    pub fn new(
        channels: Channels,
        pairs: &[([f64; 3], [f64; 3])],
        values: &[f64],
    ) -> Result<Measurement, MeasurementError> {
        let count = channels.count();
        let expected = pairs.len() * count;
        if values.len() != expected || count == 0 {
            return Err(MeasurementError::Count { found: values.len(), expected });
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(MeasurementError::NotFinite { pair: index / count, value: values[index] });
        }
        for (pair, (wi, wo)) in pairs.iter().enumerate() {
            let z = wi[2].min(wo[2]);
            if z <= 0.0 || !wi.iter().chain(wo).all(|c| c.is_finite()) {
                return Err(MeasurementError::Below { pair, z });
            }
        }
        let mut measurement = Measurement { channels, pairs: Vec::new(), values: Vec::new(), left_out: 0 };
        for (&(wi, wo), texel) in pairs.iter().zip(values.chunks_exact(count)) {
            measurement.push(Geometry::new(wi, wo), texel.iter().copied());
        }
        Ok(measurement)
    }

    /// Up to about `count` pairs of the measurement in a file, with polar angles up to `limit` in radians: its own
    /// pairs of directions if it lists them, otherwise interpolated pairs, half of them near the mirror direction.
    pub fn of_subject(subject: &Subject, aspect: Aspect, limit: f64, count: usize) -> Measurement {
        let Some(data) = subject.data(aspect) else { return Measurement::empty(subject.material.channels().clone()) };
        let data = data.representation();
        let nodes = nodes(data, aspect, limit, count);
        let pairs = if nodes.is_empty() { between(data, limit, count) } else { nodes };
        Measurement::at(&subject.material, aspect, pairs)
    }

    /// `count` pairs of a function of directions, with polar angles up to `limit` in radians.
    pub fn of_bsdf<'a>(bsdf: impl Into<OnBackend<'a>>, aspect: Aspect, limit: f64, count: usize) -> Measurement {
        Measurement::at(bsdf, aspect, direction_pairs(count, limit))
    }

    fn empty(channels: Channels) -> Measurement {
        Measurement { channels, pairs: Vec::new(), values: Vec::new(), left_out: 0 }
    }

    fn at<'a>(bsdf: impl Into<OnBackend<'a>>, aspect: Aspect, pairs: Vec<([f64; 3], [f64; 3])>) -> Measurement {
        let bsdf = bsdf.into();
        let narrow = |w: [f64; 3]| w.map(|c| c as f32);
        let placed = pairs.iter().map(|&(wi, wo)| aspect.place(wi, wo));
        let (wi, wo): (Vec<_>, Vec<_>) = placed.map(|(wi, wo)| (narrow(wi), narrow(wo))).unzip();
        let count = bsdf.channels().count();
        let mut values = vec![0.0; pairs.len() * count];
        bsdf.eval_batch(&wi, &wo, &mut values);
        let mut measurement = Measurement::empty(bsdf.channels().clone());
        for ((wi, wo), texel) in pairs.into_iter().zip(values.chunks_exact(count)) {
            measurement.push(Geometry::new(wi, wo), texel.iter().map(|&value| f64::from(value)));
        }
        measurement
    }

    fn push(&mut self, geometry: Geometry, texel: impl Iterator<Item = f64> + Clone) {
        if !texel.clone().all(f64::is_finite) || texel.clone().all(|value| value == 0.0) {
            self.left_out += 1;
            return;
        }
        self.pairs.push(geometry);
        self.values.extend(texel);
    }

    /// The meaning of the channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// The number of pairs of directions.
    pub fn count(&self) -> usize {
        self.pairs.len()
    }

    /// The number of pairs that were 0 in all channels and are not used.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// One channel of it.
    ///
    /// # Panics
    /// If there is no channel with this index.
    pub fn channel(&self, index: usize) -> Measurement {
        let count = self.channels.count();
        let channels = match &self.channels {
            Channels::Spectral(wavelengths) => Channels::Spectral(vec![wavelengths[index]]),
            Channels::Mono => Channels::Mono,
            other => Channels::Named(vec![other.names()[index].clone()]),
        };
        let values = self.values.iter().skip(index).step_by(count).copied().collect();
        Measurement { channels, values, pairs: self.pairs.clone(), left_out: self.left_out }
    }

    /// Its channels in linear sRGB.
    ///
    /// # Errors
    /// If they have no colour.
    pub fn in_rgb(&self) -> Result<Measurement, lobe_colour::NoColour> {
        let reduction = lobe_colour::Reduction::new(&self.channels, lobe_colour::Space::Rgb)?;
        let texels = self.values.chunks_exact(self.channels.count());
        let values = texels.flat_map(|texel| reduction.exact(texel)).collect();
        Ok(Measurement { channels: Channels::Rgb, values, pairs: self.pairs.clone(), left_out: self.left_out })
    }

    /// About `count` of its pairs, evenly chosen.
    pub(crate) fn thinned(&self, count: usize) -> Measurement {
        let channels = self.channels.count();
        let mut thinned = Measurement::empty(self.channels.clone());
        for index in spread(self.count(), count) {
            thinned.pairs.push(self.pairs[index]);
            thinned.values.extend_from_slice(&self.values[index * channels..][..channels]);
        }
        thinned
    }

    /// The mean of its channels.
    pub(crate) fn grey(&self) -> Measurement {
        let count = self.channels.count();
        let mean = |texel: &[f64]| texel.iter().sum::<f64>() / count as f64;
        let values = self.values.chunks_exact(count).map(mean).collect();
        Measurement { channels: Channels::Mono, values, pairs: self.pairs.clone(), left_out: 0 }
    }
}

/// `count` indices below `total`, all different, in the order of a sequence that spreads them evenly.
fn spread(total: usize, count: usize) -> Vec<usize> {
    if count >= total {
        return (0..total).collect();
    }
    // A step near the golden section that has no divisor in common with the total visits every index once.
    let mut step = (total as f64 * 0.618_033_988_749_895) as usize;
    while gcd(step.max(1), total) != 1 {
        step += 1;
    }
    let mut chosen: Vec<usize> =
        (0..count).map(|index| (index as u128 * step as u128 % total as u128) as usize).collect();
    chosen.sort_unstable();
    chosen
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The pairs of directions that were measured, if they are known.
fn nodes(data: &dyn Representation, aspect: Aspect, limit: f64, count: usize) -> Vec<([f64; 3], [f64; 3])> {
    let lowest = limit.cos() - 1e-9;
    let mut lights = data.incidences(aspect);
    lights.retain(|[theta, _]| theta.cos() >= lowest);
    // Slices of an isotropic material at other azimuths add nothing, and neither does the end of a full turn.
    lights.dedup_by(|a, b| same(spherical(*a), spherical(*b)));
    let lights: Vec<[f64; 2]> = spread(lights.len(), count).into_iter().map(|index| lights[index]).collect();
    let quota = count.div_ceil(lights.len().max(1));
    let mut pairs = Vec::new();
    for light in lights {
        let is_measured = data.coverage(light);
        let mut outgoing = data.outgoing(light);
        outgoing.retain(|wo| wo[2] >= lowest.max(1e-3) && is_measured(*wo));
        // A pole is one direction, for all azimuths.
        outgoing.dedup_by(|a, b| same(*a, *b));
        let wi = spherical(light);
        pairs.extend(spread(outgoing.len(), quota).into_iter().map(|index| (wi, outgoing[index])));
    }
    pairs
}

/// Pairs of directions for a representation that does not list its own.
fn between(data: &dyn Representation, limit: f64, count: usize) -> Vec<([f64; 3], [f64; 3])> {
    let mut pairs = direction_pairs(count, limit);
    pairs.retain(|(wi, wo)| data.coverage([wi[2].clamp(-1.0, 1.0).acos(), wi[1].atan2(wi[0])])(*wo));
    pairs
}

fn spherical([theta, phi]: [f64; 2]) -> [f64; 3] {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

fn same(a: [f64; 3], b: [f64; 3]) -> bool {
    a.into_iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_indices_are_different() {
        for (total, count) in [(10, 4), (1000, 999), (7, 7), (1, 5), (144, 55), (0, 3), (2, 1)] {
            let mut chosen = spread(total, count);
            chosen.dedup();
            assert_eq!(chosen.len(), count.min(total), "{count} of {total}");
            assert!(chosen.iter().all(|index| *index < total));
        }
    }

    #[test]
    fn invalid_measurements_are_refused() {
        let up = [0.0, 0.0, 1.0];
        let new = |pair, values: &[f64]| Measurement::new(Channels::Mono, &[pair], values);
        assert!(matches!(new((up, up), &[]), Err(MeasurementError::Count { found: 0, expected: 1 })));
        assert!(matches!(new((up, up), &[f64::NAN]), Err(MeasurementError::NotFinite { pair: 0, .. })));
        assert!(matches!(new((up, [0.0, 0.0, -1.0]), &[1.0]), Err(MeasurementError::Below { pair: 0, .. })));
        assert_eq!(new((up, up), &[0.0]).map(|found| (found.count(), found.left_out())), Ok((0, 1)));
    }
}
