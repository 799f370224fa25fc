//! The trait that every representation implements.

use std::fmt::Debug;

use super::{Aspect, Gaps, Grid, Kind, Kinks, Options, PrepareError, Section, Uses};
use crate::bsdf::Bsdf;
use crate::{Channels, Edges, Invalid, Scatter};

/// Converts values from one set of channels to another.
pub type ValueMap<'a> = dyn Fn(&[f32]) -> Vec<f32> + 'a;

/// A test of outgoing directions.
pub type Coverage<'a> = Box<dyn Fn([f64; 3]) -> bool + Sync + 'a>;

/// Receives values one by one: polar angle and azimuth of the light, then of the viewer, in radians; and the channels.
pub type Samples<'a> = Box<dyn Iterator<Item = ([f64; 4], &'a [f32])> + 'a>;

/// Access to measured data without knowing their representation.
///
/// Directions are unit vectors away from the surface, normal on +z; angles are in radians.
pub trait Representation: Debug + Send + Sync {
    /// The name of the representation.
    fn kind(&self) -> Kind;

    /// The meaning of the channels of a value.
    fn channels(&self) -> Channels;

    /// The aspects that were measured, in the order of the file: at least one, unless every block is missing.
    fn aspects(&self) -> Vec<Aspect>;

    /// `true` if values do not depend on the rotation of the sample.
    fn is_isotropic(&self) -> bool;

    /// The data prepared for evaluation.
    ///
    /// # Errors
    /// If they have no values for pairs of directions or are too large, or if this program was built without the
    /// feature of the representation.
    fn prepare(&self, _options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        Err(PrepareError::LeftOut(self.kind()))
    }

    /// The options that affect the result of [`prepare`](Self::prepare).
    fn uses(&self) -> Uses {
        Uses::default()
    }

    /// Converts the values at all nodes to other channels: `map` turns values `[...][channel]` into values of the new
    /// channels. `false` if the channels of this representation cannot be mapped one value at a time; the data are then
    /// unchanged.
    ///
    /// # Errors
    /// If a new value is not finite; the data are then unchanged.
    fn map_channels(&mut self, _channels: Channels, _map: &ValueMap<'_>) -> Result<bool, Invalid> {
        Ok(false)
    }

    /// `true` if the data distinguish light from the front and from the back.
    fn is_two_sided(&self) -> bool {
        false
    }

    /// `true` if the data are a delta function in direction, which has no value for a pair of directions.
    fn is_delta(&self) -> bool {
        false
    }

    /// The values, and facts about them.
    fn sections(&self) -> Vec<Section<'_>>;

    /// The directions of the light that were measured, polar angle and azimuth, by ascending polar angle; empty if the
    /// representation has no list of them.
    fn incidences(&self, _aspect: Aspect) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// The azimuth of the light to use, in radians, when only its polar angle is varied.
    fn azimuth(&self) -> f64 {
        0.0
    }

    /// The outgoing directions that were measured for light at a polar angle and an azimuth, as if light and viewer
    /// were both above the surface. Empty if the representation does not list directions.
    fn outgoing(&self, _light: [f64; 2]) -> Vec<[f64; 3]> {
        Vec::new()
    }

    /// A test of outgoing directions for light at a polar angle and an azimuth, as if both were above the surface:
    /// `true` if the value there was measured, and not only extrapolated.
    fn coverage(&self, _light: [f64; 2]) -> Coverage<'_> {
        Box::new(|_| true)
    }

    /// The kinks of the values for light at a polar angle and an azimuth, under these edges; `None` if none are known.
    fn kinks(&self, _edges: &Edges, _light: [f64; 2]) -> Option<Kinks> {
        None
    }

    /// The values as a grid of four angles, if they form one.
    fn grid(&self) -> Option<Grid<'_>> {
        None
    }

    /// The measured pairs of directions, by incident direction, if they are not on a grid.
    fn samples(&self) -> Option<Samples<'_>> {
        None
    }

    /// The values that the file marks as not measured; `None` if it marks none.
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

    /// The refractive index behind the surface, relative to that in front of it. Radiance changes with its square, so
    /// transmission is reciprocal only up to that factor.
    fn refractive_index(&self) -> f64 {
        1.0
    }

    /// `true` if the data contain information about polarised light that a value for a pair of directions cannot
    /// express.
    fn is_polarised(&self) -> bool {
        false
    }

    /// The measured part of the hemisphere, in words, if it is the same for every material of the representation.
    fn extent(&self) -> Option<&'static str> {
        None
    }

    /// Reflection or transmission: the scatter of the first of the [aspects](Self::aspects).
    fn scatter(&self) -> Scatter {
        self.aspects().first().map_or(Scatter::Reflection, |aspect| aspect.scatter)
    }
}
