//! The adaptive parameterisation of the EPFL material database.
//!
//! Dupuy and Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM TOG 37(6),
//! 2018. A measurement is kept on the unit square, warped for every incident direction so that the samples lie where
//! the microfacet distribution of the material puts its energy.
//!
//! The direction that a table is indexed by is `wi`; the other one is `wo`. Renderers that trace from the camera put
//! the viewer into `wi`, so that [`Reference::sample`] yields the next direction of a path.
//!
//! [`Data`] is the data; [`Reference`] evaluates it one query at a time in `f64`; [`Table`]
//! evaluates many in SIMD lanes; [`Warp`] is the interpolant between.

#[cfg(feature = "rgl")]
mod lanes;
mod marginal;
#[cfg(feature = "rgl")]
mod prepared;
mod reference;
mod representation;

#[cfg(all(test, feature = "rgl"))]
mod tests;

#[cfg(feature = "rgl")]
pub use lanes::{Drawn, Options, Table, Wanted};
pub use marginal::{Blend, Warp};
pub use reference::{Reference, Sample, UniformOrder};
pub use representation::KIND;

use crate::Channels;
use crate::invalid::{Invalid, ascending, count, finite};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The least area that the unit square is stretched to, at the pole of the half vector, where it would vanish and densities
/// be infinite. It reaches 1.6e-7 rad around the pole, as far as directions in single precision are apart. The 1e-6 of the
/// loader of the database reach 1.5e-5 rad: where visible normals are dense there, a four-hundredth of all samples would
/// have a density that is too low.
const LEAST_AREA: f64 = 1e-9;

/// Images on the unit square, `[slice][row][column]`: the row is `u.y`, an azimuth; the column is `u.x`, a zenith angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Images {
    slices: usize,
    height: usize,
    width: usize,
    /// Shared, so that an evaluator may keep them too.
    texels: Arc<Vec<f32>>,
}

impl Images {
    /// Checks that the texels are finite and fill `[slices][height][width]`, with two rows and columns at least, so
    /// that there is a cell to interpolate in. `part` names the images in the error.
    ///
    /// # Errors
    /// [`Invalid`] says which of these does not hold.
    pub fn new(part: &'static str, [slices, height, width]: [usize; 3], texels: Vec<f32>) -> Result<Self, Invalid> {
        if slices == 0 || height < 2 || width < 2 {
            let found = format!("{slices} slices of {height} x {width} texels");
            return Err(Invalid::new(part, found, "at least one slice of at least 2 x 2 texels"));
        }
        count(part, texels.len(), &[slices, height, width])?;
        finite(part, &texels)?;
        Ok(Images { slices, height, width, texels: Arc::new(texels) })
    }

    /// How many images there are.
    pub fn slices(&self) -> usize {
        self.slices
    }

    /// Rows and columns of each image.
    pub fn size(&self) -> [usize; 2] {
        [self.height, self.width]
    }

    /// All texels, `[slice][row][column]`.
    pub fn texels(&self) -> &[f32] {
        &self.texels
    }

    /// The texels of one image, `[row][column]`.
    ///
    /// # Panics
    /// If there is no such slice.
    pub fn slice(&self, index: usize) -> &[f32] {
        &self.texels[index * self.height * self.width..][..self.height * self.width]
    }

    /// The bilinear value of one image at `u`, which is clamped to the unit square.
    ///
    /// # Panics
    /// If there is no such slice.
    pub fn bilinear(&self, index: usize, u: [f64; 2]) -> f64 {
        let image = self.slice(index);
        marginal::bilinear(self, u, |texel| f64::from(image[texel]))
    }
}

/// What [`Data`] is made of. P is the number of `phi_i`, T of `theta_i`, C of channels.
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
    /// `P x T` images: what the warped samples are drawn after, not normalised.
    pub luminance: Images,
    /// [`Channels::Rgb`], or [`Channels::Spectral`] with ascending wavelengths.
    pub channels: Channels,
    /// `P x T x C` images: `f cos(theta_o)` without the microfacet factor if [`jacobian`](Self::jacobian) is set.
    pub spectra: Images,
    /// Whether values are to be multiplied by `ndf / (4 sigma)`.
    pub jacobian: bool,
    /// Which texels of the spectra were measured, one bit each, as in the file. For display; no evaluation uses it.
    pub valid: Option<Vec<u8>>,
}

/// A material of the EPFL database.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    parts: Parts,
    reduction: u32,
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

    /// What the material is made of.
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

    /// By how much symmetry has reduced the stored azimuths: 1 stores the whole turn, 2 half of it (the material looks
    /// the same after a rotation by pi), 4 a quarter (it also equals its mirror images). 1 for isotropic materials.
    pub fn reduction(&self) -> u32 {
        self.reduction
    }
}

fn angles(part: &'static str, knots: &[f32], low: f64, high: f64) -> Result<(), Invalid> {
    // A knot may have been rounded up to f32.
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
    [1, 2, 4].into_iter().find(|n| f64::from(*n) == turns).ok_or_else(|| {
        Invalid::new("phi_i", format!("azimuths that span {span} rad"), "a whole turn, its half or its quarter")
    })
}
