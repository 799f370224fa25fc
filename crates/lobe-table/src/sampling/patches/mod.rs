//! Sampling of Klems matrices: a patch in proportion to the light that leaves through it, and a direction in the patch.
//!
//! Values are constant on a pair of patches, so the density is exactly proportional to luminance times `f` times
//! cosine, with a share of a cosine distribution over the whole hemisphere mixed in.
//!
//! Batches are drawn in SIMD lanes; sampling one at a time in `f64` is the reference for them.

#[cfg(feature = "window")]
mod lanes;
#[cfg(not(feature = "window"))]
mod one_by_one;
mod reference;

use crate::window::klems::{AngleBasis, KlemsMatrix};
use crate::{DistributionError, Scatter};

/// Cumulative shares of the exit patches for each incident patch.
#[derive(Clone, Debug)]
pub struct PatchSampler {
    scatter: Scatter,
    incident: AngleBasis,
    exit: AngleBasis,
    /// `[incident patch][exit patch]`: up to and with that patch; the last of a row is 1.
    sums: Vec<f32>,
    /// Luminance times albedo of each incident patch.
    brightness: Vec<f32>,
    /// The tables in which lanes find patches, and directions in them.
    #[cfg(feature = "window")]
    lookup: lanes::Lookup,
}

impl PatchSampler {
    /// A sampler of the weighted sum of matrices, one per channel. `None` if their patches differ, there are none, or
    /// single precision does not distinguish their rings.
    ///
    /// # Errors
    /// If `defensive`, the part of a cosine, is not in `(0, 1]`.
    pub fn new(
        scatter: Scatter,
        channels: &[(&KlemsMatrix, f32)],
        defensive: f32,
    ) -> Result<Option<Self>, DistributionError> {
        if !(defensive > 0.0 && defensive <= 1.0) {
            return Err(DistributionError::Defensive { found: defensive });
        }
        let Some((first, _)) = channels.first() else { return Ok(None) };
        let (incident, exit) = (first.incident().clone(), first.exit().clone());
        if channels.iter().any(|(matrix, _)| *matrix.incident() != incident || *matrix.exit() != exit) {
            return Ok(None);
        }
        #[cfg(feature = "window")]
        let Some(lookup) = lanes::Lookup::new(&incident, &exit) else { return Ok(None) };
        let count = exit.patches();
        let angles: Vec<f64> = (0..count).map(|patch| exit.projected_solid_angle(patch)).collect();
        let all: f64 = angles.iter().sum();
        let (mut sums, mut brightness) = (Vec::with_capacity(incident.patches() * count), Vec::new());
        for row in 0..incident.patches() {
            let light = |patch: usize| {
                let values = channels.iter().map(|(matrix, weight)| weight * matrix.values()[row * count + patch]);
                f64::from(values.sum::<f32>().max(0.0)) * angles[patch]
            };
            let total: f64 = (0..count).map(light).sum();
            let defensive = if total > 0.0 { f64::from(defensive) } else { 1.0 };
            let mut below = 0.0;
            for (patch, angle) in angles.iter().enumerate() {
                let share = if total > 0.0 { light(patch) / total } else { 0.0 };
                below += (1.0 - defensive) * share + defensive * angle / all;
                sums.push(below as f32);
            }
            sums[(row + 1) * count - 1] = 1.0;
            brightness.push(total as f32);
        }
        Ok(Some(PatchSampler {
            scatter,
            incident,
            exit,
            sums,
            brightness,
            #[cfg(feature = "window")]
            lookup,
        }))
    }

    /// Bytes of memory that the sampler takes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.sums.as_slice()) + size_of_val(self.brightness.as_slice())
    }
}
