//! The reflectance of a smooth surface, a delta function in direction, by angle of incidence.

use crate::bsdf::Bsdf;
use crate::data::{Options, PrepareError, Section, ValueMap};
use crate::specular::AXIS_NAMES;
use crate::{Aspect, Channels, Invalid, Kind, Representation, Scatter};

/// The name of the representation.
pub const KIND: Kind = Kind::new("mirror reflectance");

/// Mirror reflectance (or straight-through transmittance) by direction of the light: a ratio of fluxes from 0 to 1,
/// without pi.
///
/// It accompanies a BRDF or BTDF as its delta part.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    scatter: Scatter,
    knots: [Vec<f64>; 2],
    channels: Channels,
    values: Vec<f32>,
}

impl Data {
    /// `knots` are those of sigma and psi in radians, which ascend strictly, with one psi if it makes no difference.
    /// `values` is `[sigma][psi][channel]`. `None` unless there are exactly these values, and all are finite.
    pub fn new(scatter: Scatter, knots: [Vec<f64>; 2], channels: Channels, values: Vec<f32>) -> Option<Self> {
        let mut expected = channels.count();
        for axis in &knots {
            let ascending = axis.windows(2).all(|pair| pair[0] < pair[1]) && axis.iter().all(|angle| angle.is_finite());
            expected = expected.checked_mul(axis.len()).filter(|_| ascending)?;
        }
        let sound = expected == values.len() && expected > 0 && values.iter().all(|value| value.is_finite());
        sound.then_some(Data { scatter, knots, channels, values })
    }

    /// Reflection or transmission.
    pub fn scatter(&self) -> Scatter {
        self.scatter
    }

    /// The polar angles and the azimuths of the light, in radians.
    pub fn knots(&self) -> &[Vec<f64>; 2] {
        &self.knots
    }

    /// The meaning of the channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// All values, `[sigma][psi][channel]`.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The reflectance of each channel for light from polar angle `sigma` and azimuth `psi`, in radians: linear between
    /// the knots, constant beyond them.
    pub fn at(&self, sigma: f64, psi: f64) -> Vec<f64> {
        let (cells, count) = ([cell(&self.knots[0], sigma), cell(&self.knots[1], psi)], self.channels.count());
        let mut sum = vec![0.0; count];
        for (sigma, share) in cells[0] {
            for (psi, part) in cells[1] {
                let texel = &self.values[(sigma * self.knots[1].len() + psi) * count..][..count];
                sum.iter_mut().zip(texel).for_each(|(sum, &value)| *sum += share * part * f64::from(value));
            }
        }
        sum
    }
}

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        self.channels.clone()
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::front(self.scatter)]
    }

    fn is_isotropic(&self) -> bool {
        self.knots[1].len() == 1
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let section = Section::new(KIND, Aspect::front(self.scatter), self.channels.clone(), &self.values);
        let mut section = section.with_axes([AXIS_NAMES[0], AXIS_NAMES[1]], &self.knots);
        if self.knots[1].len() == 1 {
            section.axes.pop();
        }
        vec![Section { quantity: "mirror reflectance by angle of incidence", ..section }]
    }

    fn map_channels(&mut self, channels: Channels, map: &ValueMap<'_>) -> Result<bool, Invalid> {
        let failed = || Invalid::new("channels", "values that are not finite", "values that f32 can hold");
        *self = Data::new(self.scatter, self.knots.clone(), channels, map(&self.values)).ok_or_else(failed)?;
        Ok(true)
    }

    fn prepare(&self, _: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        Err(PrepareError::NoValues(KIND))
    }

    fn is_delta(&self) -> bool {
        true
    }
}

/// The two knots around an angle, and their weights.
fn cell(knots: &[f64], x: f64) -> [(usize, f64); 2] {
    let upper = knots.partition_point(|&knot| knot < x).min(knots.len() - 1);
    let lower = upper.saturating_sub(1);
    let width = knots[upper] - knots[lower];
    let t = if width > 0.0 { ((x - knots[lower]) / width).clamp(0.0, 1.0) } else { 0.0 };
    [(lower, 1.0 - t), (upper, t)]
}
