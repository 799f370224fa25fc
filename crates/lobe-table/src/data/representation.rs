//! What every representation can report.

use std::fmt::Debug;

use super::{Aspect, Gaps, Grid, Kind, Kinks, Options, PrepareError, Section, Uses};
use crate::bsdf::Bsdf;
use crate::{Channels, Edges, Invalid, Scatter};

/// Turns values of one set of channels into those of another one.
pub type ValueMap<'a> = dyn Fn(&[f32]) -> Vec<f32> + 'a;

/// A test of outgoing directions.
pub type Coverage<'a> = Box<dyn Fn([f64; 3]) -> bool + Sync + 'a>;

/// Values one by one: polar angle and azimuth of the light, then of the viewer, in radians; and the channels.
pub type Samples<'a> = Box<dyn Iterator<Item = ([f64; 4], &'a [f32])> + 'a>;

/// What programs need from measured data without knowing their representation.
///
/// Directions are unit vectors away from the surface, normal on +z; angles are in radians.
pub trait Representation: Debug + Send + Sync {
    /// The name of the representation.
    fn kind(&self) -> Kind;

    /// What the channels of a value mean.
    fn channels(&self) -> Channels;

    /// What was measured, in the order of the file: at least one, unless every block is missing.
    fn aspects(&self) -> Vec<Aspect>;

    /// `true` if values do not depend on the rotation of the sample.
    fn is_isotropic(&self) -> bool;

    /// The data made ready to be evaluated.
    ///
    /// # Errors
    /// If they have no value for a pair of directions, or are too large, or if this program was built without the feature
    /// of the representation.
    fn prepare(&self, _options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        Err(PrepareError::LeftOut(self.kind()))
    }

    /// Which options make a difference to what [`prepare`](Self::prepare) gives.
    fn uses(&self) -> Uses {
        Uses::default()
    }

    /// Gives the same nodes other channels: `map` turns values `[...][channel]` into those of the new channels. `false` if
    /// the channels of this representation cannot be mapped one value at a time, which leaves it as it is.
    ///
    /// # Errors
    /// If a new value is not finite, which leaves the data as they are.
    fn map_channels(&mut self, _channels: Channels, _map: &ValueMap<'_>) -> Result<bool, Invalid> {
        Ok(false)
    }

    /// `true` if the data tell light on the front from light on the back.
    fn is_two_sided(&self) -> bool {
        false
    }

    /// `true` if the data are a delta function in direction, which has no value for a pair of directions.
    fn is_delta(&self) -> bool {
        false
    }

    /// The values, and what there is to say about them.
    fn sections(&self) -> Vec<Section<'_>>;

    /// The directions of the light that were measured, polar angle and azimuth, by ascending polar angle; empty if the
    /// representation has no list of them.
    fn incidences(&self, _aspect: Aspect) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// The azimuth of the light to begin with, in radians, when only its polar angle is varied.
    fn azimuth(&self) -> f64 {
        0.0
    }

    /// The outgoing directions that were measured for light at a polar angle and an azimuth, as if light and view were both
    /// above the surface. Empty if the representation has no directions of its own.
    fn outgoing(&self, _light: [f64; 2]) -> Vec<[f64; 3]> {
        Vec::new()
    }

    /// A test of outgoing directions for light at a polar angle and an azimuth, as if both were above the surface: is the
    /// value there one of the measurement, and not only its continuation?
    fn coverage(&self, _light: [f64; 2]) -> Coverage<'_> {
        Box::new(|_| true)
    }

    /// Where values have kinks for light at a polar angle and an azimuth, under these edges; `None` if they have none
    /// that are known.
    fn kinks(&self, _edges: &Edges, _light: [f64; 2]) -> Option<Kinks> {
        None
    }

    /// The values as a grid of four angles, if they are one.
    fn grid(&self) -> Option<Grid<'_>> {
        None
    }

    /// The pairs of directions that were measured, by incident direction, if they are on no grid.
    fn samples(&self) -> Option<Samples<'_>> {
        None
    }

    /// What the file marks as not measured; `None` if it marks nothing.
    fn gaps(&self) -> Option<Gaps> {
        None
    }

    /// The albedo of each channel for light at a polar angle and an azimuth, if it is an exact sum of values.
    fn albedo(&self, _aspect: Aspect, _light: [f64; 2]) -> Option<Vec<f64>> {
        None
    }

    /// `true` if values are known to be `f` in 1/sr.
    fn has_known_unit(&self) -> bool {
        true
    }

    /// The refractive index of what is behind the surface, relative to what is in front of it. Radiance changes with its
    /// square, so that transmission is reciprocal only up to that.
    fn refractive_index(&self) -> f64 {
        1.0
    }

    /// `true` if the data know more of polarised light than a value for a pair of directions can express.
    fn is_polarised(&self) -> bool {
        false
    }

    /// Which part of the hemisphere was measured, in words, if the representation is the same for every material.
    fn extent(&self) -> Option<&'static str> {
        None
    }

    /// Reflection or transmission: that of the first of the [aspects](Self::aspects).
    fn scatter(&self) -> Scatter {
        self.aspects().first().map_or(Scatter::Reflection, |aspect| aspect.scatter)
    }
}
