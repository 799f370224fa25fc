//! A material of the database: images on the unit square.

use super::images::Images;
use crate::Channels;
use crate::invalid::{Invalid, ascending};
use std::f64::consts::{PI, TAU};

/// The least area to which the unit square is mapped, at the pole of the half vector, where the area would vanish and
/// densities be infinite. It has an effect up to 1.6e-7 rad around the pole, the distance between directions in single
/// precision. The 1e-6 in the loader of the database has an effect up to 1.5e-5 rad: if visible normals are dense
/// there, a four-hundredth of all samples would have too low a density.
pub(super) const LEAST_AREA: f64 = 1e-9;

/// The parts of [`Data`]. P is the number of `phi_i`, T of `theta_i`, C of channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// Free text.
    pub description: String,
    /// Azimuths of `wi` in radians, ascending. One or two of them mean an isotropic material.
    pub phi_i: Vec<f32>,
    /// Zenith angles of `wi` in radians, ascending.
    pub theta_i: Vec<f32>,
    /// One image: the microfacet distribution.
    pub ndf: Images,
    /// One image: the projected area of the microfacets.
    pub sigma: Images,
    /// `P x T` images: the distribution of visible normals, not normalised.
    pub vndf: Images,
    /// `P x T` images: the density from which warped samples are drawn, not normalised.
    pub luminance: Images,
    /// [`Channels::Rgb`], or [`Channels::Spectral`] with ascending wavelengths.
    pub channels: Channels,
    /// `P x T x C` images: `f cos(theta_o)` without the microfacet factor if [`jacobian`](Self::jacobian) is set.
    pub spectra: Images,
    /// `true` if values are to be multiplied by `ndf / (4 sigma)`.
    pub jacobian: bool,
    /// Which texels of the spectra were measured, one bit each, as in the file. For display; no evaluation uses it.
    pub valid: Option<Vec<u8>>,
}

/// A material of the EPFL database.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    pub(super) parts: Parts,
    pub(super) reduction: u32,
}

impl Data {
    /// Checks that the parts fit together.
    ///
    /// # Errors
    /// [`Invalid`] names the part after its field in the file.
    pub fn new(parts: Parts) -> Result<Self, Invalid> {
        ascending("phi_i", &parts.phi_i)?;
        ascending("theta_i", &parts.theta_i)?;
        angles("phi_i", &parts.phi_i, -TAU, TAU)?;
        angles("theta_i", &parts.theta_i, 0.0, PI / 2.0)?;
        let incident = parts
            .phi_i
            .len()
            .checked_mul(parts.theta_i.len())
            .ok_or_else(|| Invalid::new("phi_i", "more knots than memory can address", "a table that fits"))?;
        let channels = match &parts.channels {
            Channels::Rgb => 3,
            Channels::Spectral(nm) => {
                let ascending = nm.windows(2).all(|pair| pair[0] < pair[1]);
                if nm.is_empty() || !ascending || !nm.iter().all(|nm| nm.is_finite() && *nm > 0.0) {
                    return Err(Invalid::new("wavelengths", format!("{nm:?}"), "ascending positive numbers of nm"));
                }
                nm.len()
            }
            other => return Err(Invalid::new("channels", format!("{other:?}"), "RGB or wavelengths")),
        };
        let spectra = if parts.channels == Channels::Rgb { "rgb" } else { "spectra" };
        slices("ndf", &parts.ndf, Some(1))?;
        slices("sigma", &parts.sigma, Some(1))?;
        slices("vndf", &parts.vndf, Some(incident))?;
        slices("luminance", &parts.luminance, Some(incident))?;
        slices(spectra, &parts.spectra, incident.checked_mul(channels))?;
        if parts.jacobian && parts.sigma.texels.iter().any(|area| *area <= 0.0) {
            return Err(Invalid::new("sigma", "an area that is not positive", "positive areas to divide by"));
        }
        let reduction = reduction(&parts.phi_i)?;
        Ok(Data { parts, reduction })
    }

    /// The parts of the material.
    pub fn parts(&self) -> &Parts {
        &self.parts
    }

    /// Gives the parts back.
    pub fn into_parts(self) -> Parts {
        self.parts
    }

    /// `true` if the values do not depend on the rotation of the sample.
    pub fn is_isotropic(&self) -> bool {
        self.parts.phi_i.len() <= 2
    }

    /// The factor by which symmetry reduces the stored azimuths: 1 means the full turn, 2 half of it (the material is
    /// unchanged when rotated by pi), 4 a quarter (it is also unchanged when mirrored). It is 1 for isotropic
    /// materials.
    pub fn reduction(&self) -> u32 {
        self.reduction
    }
}

fn angles(part: &'static str, knots: &[f32], low: f64, high: f64) -> Result<(), Invalid> {
    // A knot may have been rounded up to `f32`.
    let rounding = 1e-5;
    match knots.iter().find(|x| f64::from(**x) < low - rounding || f64::from(**x) > high + rounding) {
        Some(x) => Err(Invalid::new(part, format!("{x} rad"), format!("angles in [{low}, {high}] rad"))),
        None => Ok(()),
    }
}

fn slices(part: &'static str, images: &Images, expected: Option<usize>) -> Result<(), Invalid> {
    if expected == Some(images.slices) {
        return Ok(());
    }
    let expected = expected.map_or("fewer".into(), |n| format!("{n}"));
    Err(Invalid::new(part, format!("{} slices", images.slices), format!("{expected} slices")))
}

fn reduction(phi_i: &[f32]) -> Result<u32, Invalid> {
    let [first, .., last] = phi_i else { return Ok(1) };
    if phi_i.len() <= 2 {
        return Ok(1);
    }
    let span = f64::from(*last) - f64::from(*first);
    let turns = (TAU / span).round();
    [1, 2, 4]
        .into_iter()
        .find(|n| f64::from(*n) == turns)
        .ok_or_else(|| Invalid::new("phi_i", format!("azimuths that span {span} rad"), "a full, half or quarter turn"))
}
