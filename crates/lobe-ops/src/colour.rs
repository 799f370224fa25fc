//! Conversion of tables and materials to CIE XYZ or RGB, as defined in [`lobe_colour`]. Values stay in 1/sr.

use lobe::Backend;
use lobe_colour::{Channels, NoColour, Reduction, Space};
use lobe_table::{Aspect, Bsdf, Directions, GridError, specular};
use thiserror::Error;

use crate::OnBackend;

/// The same table with XYZ or RGB channels. Colours outside the triangle of the primaries have negative RGB, which is
/// kept.
///
/// # Errors
/// Those of [`Reduction::new`], and values too large for `f32`.
pub fn convert(samples: &specular::Data, space: Space) -> Result<specular::Data, ColourError> {
    let reduction = Reduction::new(samples.channels(), space)?;
    let texels = samples.values().chunks_exact(samples.channels().count());
    let values = texels.flat_map(|texel| reduction.exact(texel).map(|value| value as f32)).collect();
    let converted = specular::Data::new(samples.scatter(), samples.knots().clone(), channels(space), values)?;
    Ok(match samples.refraction() {
        Some(offsets) => converted.with_refraction(offsets.to_vec())?,
        None => converted,
    })
}

fn channels(space: Space) -> Channels {
    match space {
        Space::Xyz => Channels::Xyz,
        Space::Rgb => Channels::Rgb,
    }
}

/// A table that cannot be converted.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ColourError {
    /// Its channels have no colour.
    #[error(transparent)]
    NoColour(#[from] NoColour),
    /// A value is too large for `f32`.
    #[error(transparent)]
    Samples(#[from] GridError),
}

/// A material in another colour space.
#[derive(Debug)]
pub struct Coloured<'a> {
    scattering: OnBackend<'a>,
    reduction: Reduction,
    channels: Channels,
}

impl<'a> Coloured<'a> {
    /// `scattering` with three channels.
    ///
    /// # Errors
    /// Those of [`Reduction::new`].
    pub fn new(scattering: impl Into<OnBackend<'a>>, space: Space) -> Result<Self, NoColour> {
        let scattering = scattering.into();
        let reduction = Reduction::new(scattering.channels(), space)?;
        Ok(Coloured { scattering, reduction, channels: channels(space) })
    }
}

impl<'a> From<&'a Coloured<'_>> for OnBackend<'a> {
    fn from(coloured: &'a Coloured<'_>) -> Self {
        OnBackend::new(coloured, coloured.scattering.backend)
    }
}

impl Bsdf for Coloured<'_> {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn holds(&self, aspect: Aspect) -> bool {
        self.scattering.bsdf.holds(aspect)
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        let count = self.scattering.channels().count();
        let mut values = vec![0.0; wi.count() * count];
        self.scattering.bsdf.eval_batch(backend, wi, wo, &mut values);
        for (out, texel) in out.chunks_exact_mut(3).zip(values.chunks_exact(count)) {
            out.iter_mut().zip(self.reduction.exact(texel)).for_each(|(out, value)| *out = value as f32);
        }
    }
}
