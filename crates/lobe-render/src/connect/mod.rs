//! Light paths that are kept, and connected or merged with paths from the camera.

mod mis;
mod pass;
mod vertex;

pub(crate) use mis::{Emission, Factors, Meeting, Mis};
pub(crate) use pass::{Pass, radius_of};
pub(crate) use vertex::{LightPart, LightVertex, SplatAt};

use crate::channels::Channels;
use crate::transport::Transport;

/// A transport whose light, throughput and scattering are all one value per channel, so that a path can be followed
/// from either end.
pub(crate) trait Unpolarised:
    Transport<
        Radiance = <Self as Transport>::Spectrum,
        Throughput = <Self as Transport>::Spectrum,
        Scattering = <Self as Transport>::Spectrum,
    >
{
}

impl<S: Channels, T: Transport<Spectrum = S, Radiance = S, Throughput = S, Scattering = S>> Unpolarised for T {}
