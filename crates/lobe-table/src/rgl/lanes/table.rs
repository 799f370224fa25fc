//! [`Data`] laid out for the passes.

use super::factor::Factor;
use super::frame::Symmetry;
use super::spectra::Spectra;
use super::warp::Warp;
use crate::Channels;
use crate::grid::axis::Axis;
use crate::grid::edges::Edge;
use crate::invalid::Invalid;
use crate::rgl::Data;

/// Options for the evaluation of a [`Table`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// `true` if negative values, which the measurements contain, become zero. The default is `false`.
    pub clamp_negative: bool,
}

/// A material of the EPFL database, laid out for evaluation in SIMD lanes.
///
/// `wi` is the direction that the tables are indexed by, `wo` the other one: the same choice as in
/// [`Reference`](crate::rgl::Reference), with which the values agree. Both are unit vectors that point away from the
/// surface, normal on +z. Results are 0 unless both have `z > 0` and finite components. Values are `f` in 1/sr or, on
/// request, `f cos(theta_o)`, one per stored channel; densities are those of sampling `wo` for a `wi`, in 1/sr.
///
/// In strict form ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    pub(super) channels: Channels,
    pub(super) symmetry: Symmetry,
    pub(super) phi_i: Axis,
    pub(super) theta_i: Axis,
    pub(super) vndf: Warp,
    pub(super) luminance: Warp,
    pub(super) factor: Option<Factor>,
    pub(super) spectra: Spectra,
    /// `true` if anything depends on the azimuth of `wi`.
    pub(super) azimuthal: bool,
}

impl Table {
    /// Normalises the distributions and lays everything out: about 34 bytes per texel of the distributions, and 16
    /// bytes per texel of RGB.
    ///
    /// # Errors
    /// [`Invalid`] names the part of the material that is too large for a 32-bit index.
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

    /// The meaning of the channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// The number of channels.
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

    /// `true` if slices differ in azimuth, so that a blend has four slices instead of two.
    pub(super) fn blends_azimuths(&self) -> bool {
        self.phi_i.knots().len() > 1
    }
}
