//! [`Representation`] for scattered samples.

use std::borrow::Cow;

use super::data::Data;
use crate::bsdf::Bsdf;
use crate::data::{Coverage, Near, Options, PrepareError, SAME, Samples, Section, ValueMap, direction, reach, spans};
use crate::{Aspect, Channels, Invalid, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("scattered samples");

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
        Data::is_isotropic(self)
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let values: Vec<f32> = Data::samples(self).flat_map(|(_, texel)| texel.to_vec()).collect();
        let section = Section::new(KIND, Aspect::front(self.scatter), self.channels.clone(), &[]);
        let mut thetas: Vec<f32> = Data::incidences(self).map(|[theta, _]| theta.to_degrees() as f32).collect();
        thetas.dedup();
        let thetas: Vec<String> = thetas.iter().map(f32::to_string).collect();
        let symmetry = if self.is_isotropic { "isotropic" } else { "anisotropic" };
        let incidences = match self.incidences.len() {
            1 => "1 direction".into(),
            n => format!("{n} directions"),
        };
        let section = Section { bytes: size_of_val(values.as_slice()), values: Cow::Owned(values), ..section };
        let section =
            section.with_fact("samples", format!("{} pairs of directions, {symmetry}", Data::samples(self).count()));
        vec![section.with_fact("light", format!("{incidences}, at {} degrees", thetas.join(" ")))]
    }

    fn incidences(&self, _: Aspect) -> Vec<[f64; 2]> {
        Data::incidences(self).collect()
    }

    fn samples(&self) -> Option<Samples<'_>> {
        Some(Box::new(Data::samples(self)))
    }

    fn map_channels(&mut self, channels: Channels, map: &ValueMap<'_>) -> Result<bool, Invalid> {
        let (angles, values): (Vec<_>, Vec<_>) = Data::samples(self).unzip();
        let mapped = Data::new(self.scatter, channels, &angles, &map(&values.concat()));
        *self = mapped.map_err(|error| Invalid::new("channels", error.to_string(), "values that f32 can hold"))?;
        Ok(true)
    }

    fn azimuth(&self) -> f64 {
        match Data::incidences(self).last() {
            Some([_, phi]) if !self.is_isotropic => phi,
            Some(_) | None => 0.0,
        }
    }

    fn outgoing(&self, light: [f64; 2]) -> Vec<[f64; 3]> {
        let (measured, offsets) = self.around(light);
        let turn = if self.is_isotropic { light[1] } else { measured[1] };
        let mut found: Vec<_> = offsets.iter().map(|&[theta, phi]| direction(theta, turn + phi)).collect();
        found.retain(|direction| direction[2] > 1e-3);
        found
    }

    fn coverage(&self, light: [f64; 2]) -> Coverage<'_> {
        let mut thetas: Vec<f64> = Data::incidences(self).map(|[theta, _]| theta).collect();
        thetas.dedup_by(|a, b| (*a - *b).abs() < SAME);
        if !spans(&thetas, light[0]) {
            return Box::new(|_| false);
        }
        let near = Near::new(self.outgoing(light), reach(&self.around(light).1));
        Box::new(move |wo| near.has_neighbour(wo))
    }

    fn prepare(&self, _: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self)
    }
}

impl Data {
    /// The measured light nearest to a polar angle and an azimuth, and the outgoing directions for it: polar angles,
    /// and azimuths relative to the light.
    fn around(&self, light: [f64; 2]) -> ([f64; 2], Vec<[f64; 2]>) {
        let wi = direction(light[0], light[1]);
        let distance = |[theta, phi]: [f64; 2]| match self.is_isotropic {
            true => (theta - light[0]).abs(),
            false => {
                let other = direction(theta, phi);
                -(wi[0] * other[0] + wi[1] * other[1] + wi[2] * other[2])
            }
        };
        let distances = Data::incidences(self).map(distance).enumerate();
        let nearest =
            distances.min_by(|(_, a), (_, b)| a.total_cmp(b)).and_then(|(index, _)| self.incidences.get(index));
        let Some(nearest) = nearest else { return ([0.0; 2], Vec::new()) };
        let measured = [nearest.theta, nearest.phi];
        let mut outgoing = nearest.outgoing.clone();
        // One half of an isotropic material represents both.
        if self.is_isotropic && self.measured_side != 0.0 {
            let mirrored: Vec<_> = outgoing.iter().map(|&[theta, phi]| [theta, -phi]).collect();
            outgoing.extend(mirrored);
        }
        (measured, outgoing)
    }
}
