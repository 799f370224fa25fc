//! [`Data`] made ready to be evaluated in SIMD lanes.
//!
//! A block of queries goes through short passes, as in a [`Table`](crate::specular::Table):
//!
//! 1. `frame`: directions to the half vector, moved to the azimuths that are stored;
//! 2. `angles`: inverse trigonometry, and positions on the unit square;
//! 3. the slices to blend, by zenith angle and azimuth of `wi`;
//! 4. `invert`: the position of the half vector back to the uniform position that the visible normals warp to it;
//! 5. `factor`: `ndf / (4 sigma)`, if the material requires it;
//! 6. `spectra`: the texels at the uniform position, weighted and summed.
//!
//! Sampling goes the other way: `draw` warps uniform numbers by the luminance and then by the visible normals, `reflect`
//! turns the half vector into a direction, and the last two passes are the same.

mod angles;
mod batch;
mod draw;
mod factor;
mod frame;
mod grid;
mod invert;
mod reflect;
mod sample;
mod spectra;
mod warp;

use super::Data;
use crate::Channels;
use crate::grid::axis::Axis;
use crate::grid::edges::Edge;
use crate::invalid::Invalid;
use factor::Factor;
use frame::Symmetry;
use spectra::Spectra;
use warp::Warp;

pub use batch::Wanted;
pub use sample::Drawn;

/// How a [`Table`] is to be evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Whether values below zero, which the measurements have, become zero. Off by default.
    pub clamp_negative: bool,
}

/// A material of the EPFL database, laid out for evaluation in SIMD lanes.
///
/// `wi` is the direction that the tables are indexed by, `wo` the other one: the same choice as in
/// [`Reference`](super::Reference), with whose values these agree. Both are unit vectors that point away from the surface,
/// normal on +z. Results are 0 unless both have `z > 0`, and if a component is not finite. Values are `f` in 1/sr or,
/// on request, `f cos(theta_o)`, one for each stored channel; densities are those of sampling `wo` for a `wi`, in 1/sr.
///
/// In strict form ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    channels: Channels,
    symmetry: Symmetry,
    phi_i: Axis,
    theta_i: Axis,
    vndf: Warp,
    luminance: Warp,
    factor: Option<Factor>,
    spectra: Spectra,
    /// Whether anything depends on the azimuth of `wi`.
    azimuthal: bool,
}

impl Table {
    /// Normalises the distributions and lays everything out: about 34 bytes a texel of the distributions, and 16 bytes a
    /// texel of RGB.
    ///
    /// # Errors
    /// [`Invalid`] names the part of the material that is larger than the 32-bit index of a lane reaches.
    pub fn new(rgl: &Data, options: Options) -> Result<Self, Invalid> {
        let parts = rgl.parts();
        let axis = |part: &'static str, knots: &[f32]| {
            let knots: Vec<f64> = knots.iter().map(|knot| f64::from(*knot)).collect();
            Axis::new(&knots, Edge::Clamp).map_err(|error| Invalid::new(part, error.to_string(), "ascending knots"))
        };
        let slices = [parts.phi_i.len(), parts.theta_i.len()];
        let floor = if options.clamp_negative { 0.0 } else { f32::MIN };
        let factor = if parts.jacobian { Some(Factor::new(&parts.ndf, &parts.sigma)?) } else { None };
        let azimuthal = parts.phi_i.len() > 1 || factor.as_ref().is_some_and(|factor| factor.azimuthal);
        Ok(Table {
            azimuthal,
            channels: parts.channels.clone(),
            symmetry: Symmetry { isotropic: rgl.is_isotropic(), reduction: rgl.reduction() },
            phi_i: axis("phi_i", &parts.phi_i)?,
            theta_i: axis("theta_i", &parts.theta_i)?,
            vndf: Warp::new("vndf", &parts.vndf, slices)?,
            luminance: Warp::new("luminance", &parts.luminance, slices)?,
            factor,
            spectra: Spectra::new(&parts.spectra, slices, parts.channels.count(), floor)?,
        })
    }

    /// What the channels mean.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// How many channels there are.
    pub fn channel_count(&self) -> usize {
        self.spectra.channels
    }

    /// `true` if the values do not depend on the rotation of the sample.
    pub fn is_isotropic(&self) -> bool {
        self.symmetry.isotropic
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        let axes = self.phi_i.bytes() + self.theta_i.bytes();
        let factor = self.factor.as_ref().map_or(0, Factor::bytes);
        axes + self.vndf.bytes() + self.luminance.bytes() + factor + self.spectra.bytes()
    }

    /// Whether slices differ in azimuth, so that a blend has four of them and not two.
    fn blends_azimuths(&self) -> bool {
        self.phi_i.knots().len() > 1
    }
}
