//! Samples of lights, one per lane.

use lobe_lane::Lanes;

use crate::channels::Channels;
use crate::vectors::select;

/// A point on a light in each lane, sampled as seen from other points.
#[derive(Clone, Copy, Debug)]
pub struct LightSample<L: Lanes, S: Channels> {
    /// Toward the light, unit length.
    pub wi: [L::F; 3],
    /// Distance; may be infinite.
    pub distance: L::F,
    /// Radiance; for a light without extent, the irradiance of a surface that faces it.
    pub radiance: S::InLanes<L>,
    /// Density over solid angle, 1/sr; infinite for a light without extent.
    pub pdf: L::F,
    /// `true` if any light arrives; otherwise the other numbers are unspecified.
    pub valid: L::M,
}

impl<L: Lanes, S: Channels> LightSample<L, S> {
    /// The same radiance in all lanes.
    #[inline(always)]
    pub(crate) fn new(lanes: L, wi: [L::F; 3], distance: L::F, radiance: S, pdf: L::F, valid: L::M) -> Self {
        LightSample { wi, distance, radiance: radiance.in_lanes(lanes), pdf, valid }
    }

    /// The sample with its radiance multiplied.
    #[inline(always)]
    pub(crate) fn scaled(mut self, factor: L::F) -> Self {
        let radiance = self.radiance.as_mut();
        let mut k = 0;
        while k < radiance.len() {
            radiance[k] = radiance[k] * factor;
            k += 1;
        }
        self
    }

    /// `other` in the lanes of `mask`.
    #[inline(always)]
    pub(crate) fn or(mut self, lanes: L, mask: L::M, other: Self) -> Self {
        self.wi = select(lanes, mask, other.wi, self.wi);
        self.distance = lanes.select(mask, other.distance, self.distance);
        let (radiance, others) = (self.radiance.as_mut(), other.radiance.as_ref());
        let mut k = 0;
        while k < radiance.len() {
            radiance[k] = lanes.select(mask, others[k], radiance[k]);
            k += 1;
        }
        self.pdf = lanes.select(mask, other.pdf, self.pdf);
        self.valid = (mask & other.valid) | (!mask & self.valid);
        self
    }
}

/// A ray that has reached a light.
#[derive(Clone, Copy, Debug)]
pub struct LightRay {
    /// Its unit direction.
    pub wi: [f32; 3],
    /// Its length; infinite to the environment.
    pub distance: f32,
    /// The cosine between its reverse direction and the normal of the triangle, negative on the back.
    pub cos: f32,
}

/// The light that arrives along a [`LightRay`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Emitted<S> {
    pub radiance: S,
    /// The density, 1/sr, with which sampling lights finds the same point.
    pub pdf_li: f32,
}

/// Rays that leave a light, one per lane.
#[derive(Clone, Copy, Debug)]
pub struct EmissionSample<L: Lanes, S: Channels> {
    /// Their origins: on the light, or outside the scene for a light at infinity.
    pub origin: [L::F; 3],
    /// Their directions, of unit length.
    pub direction: [L::F; 3],
    /// The emitted light times the cosine to the normal at the origin: radiance for a light with extent, radiant
    /// intensity for a point light, irradiance for a directional light.
    pub emitted: S::InLanes<L>,
    /// The densities with which they were sampled.
    pub pdf: EmissionPdf<L::F>,
    /// `true` if they carry light; otherwise the other numbers are unspecified.
    pub valid: L::M,
}

/// Densities of rays that leave a light. A quantity that could have no other value (the position of a point light, the
/// direction of a directional one) has density 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionPdf<F> {
    /// Over area, in 1 per squared unit of length.
    pub position: F,
    /// Over solid angle, 1/sr.
    pub direction: F,
}

/// A sphere around everything that can be lit; lights at infinity emit through a disk of its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneBounds {
    /// Its centre.
    pub center: [f32; 3],
    /// Its radius.
    pub radius: f64,
}
