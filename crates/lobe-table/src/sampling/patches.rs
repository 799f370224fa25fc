//! Sampling of Klems matrices: a patch in proportion to the light that leaves through it, and a direction in the patch.
//!
//! Values are constant on a pair of patches, so the density is the values' own: in proportion to luminance times `f` times
//! cosine to the last digit, with a part of a cosine over the whole hemisphere mixed in.

use std::f64::consts::TAU;

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
}

impl PatchSampler {
    /// A sampler of the weighted sum of matrices, one per channel. `None` if their patches are not the same, or there
    /// are none.
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
        Ok(Some(PatchSampler { scatter, incident, exit, sums, brightness }))
    }

    /// Bytes of memory that the sampler takes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.sums.as_slice()) + size_of_val(self.brightness.as_slice())
    }

    /// The integral of luminance times `f` times cosine for light from `wi`, a unit vector on either side.
    pub fn brightness(&self, wi: [f32; 3]) -> f32 {
        self.row(wi).map_or(0.0, |row| self.brightness[row])
    }

    /// A direction and its density, 1/sr, for light from `wi` and two numbers in `[0, 1)`; zeros if `wi` lies in no
    /// patch.
    pub fn draw(&self, wi: [f32; 3], [u, w]: [f32; 2]) -> ([f32; 3], f32) {
        let Some(row) = self.row(wi) else { return ([0.0; 3], 0.0) };
        let sums = self.sums_of(row);
        let u = if u > 0.0 { u.min(1.0 - f32::EPSILON / 2.0) } else { 0.0 };
        let patch = sums.partition_point(|&sum| sum <= u).min(sums.len() - 1);
        let below = if patch == 0 { 0.0 } else { sums[patch - 1] };
        let mass = f64::from(sums[patch]) - f64::from(below);
        let within = if mass > 0.0 { ((f64::from(u) - f64::from(below)) / mass).clamp(0.0, 1.0) } else { 0.5 };
        let (ring, sector) = ring_of(&self.exit, patch);
        let turn = (sector as f64 - 0.5 + within) / f64::from(ring.patches);
        let cos2 = |degrees: f64| degrees.to_radians().cos().powi(2);
        let w = f64::from(if w > 0.0 { w.min(1.0) } else { 0.0 });
        let z2 = cos2(ring.lower) + w * (cos2(ring.upper) - cos2(ring.lower));
        let (sin_phi, cos_phi) = (turn * TAU).sin_cos();
        // Rounding must not put a direction into the surface.
        let (sin, z) = ((1.0 - z2).max(0.0).sqrt(), z2.max(0.0).sqrt().max(1e-9));
        let side = f64::from(wi[2].signum()) * if self.scatter == Scatter::Reflection { 1.0 } else { -1.0 };
        let direction = [sin * cos_phi, sin * sin_phi, z * side].map(|x| x as f32);
        (direction, (mass / self.exit.projected_solid_angle(patch) * z) as f32)
    }

    /// The density of [`draw`](Self::draw), 1/sr, with which it finds `wo` for light from `wi`.
    pub fn pdf(&self, wi: [f32; 3], wo: [f32; 3]) -> f32 {
        let sides = f64::from(wi[2]) * f64::from(wo[2]);
        if (self.scatter == Scatter::Reflection && sides <= 0.0)
            || (self.scatter == Scatter::Transmission && sides >= 0.0)
        {
            return 0.0;
        }
        let exit = unit(wo).and_then(|[x, y, z]| Some((self.exit.patch([x, y, z.abs()])?, z.abs())));
        let (Some(row), Some((patch, z))) = (self.row(wi), exit) else { return 0.0 };
        let sums = self.sums_of(row);
        let below = if patch == 0 { 0.0 } else { sums[patch - 1] };
        let mass = f64::from(sums[patch]) - f64::from(below);
        (mass / self.exit.projected_solid_angle(patch) * z) as f32
    }

    fn sums_of(&self, row: usize) -> &[f32] {
        &self.sums[row * self.exit.patches()..][..self.exit.patches()]
    }

    fn row(&self, wi: [f32; 3]) -> Option<usize> {
        let [x, y, z] = unit(wi)?;
        if z == 0.0 { None } else { self.incident.patch([-x, -y, z.abs()]) }
    }
}

/// The ring of a patch, and its sector in the ring.
fn ring_of(basis: &AngleBasis, patch: usize) -> (crate::window::klems::Ring, usize) {
    let mut first = 0;
    for ring in basis.rings() {
        let count = ring.patches as usize;
        if patch < first + count {
            return (*ring, patch - first);
        }
        first += count;
    }
    unreachable!("patch {patch} of a basis with {}", basis.patches())
}

/// A direction of length 1; `None` if it points nowhere.
fn unit(direction: [f32; 3]) -> Option<[f64; 3]> {
    let v = direction.map(f64::from);
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    (length.is_finite() && length > 0.0).then(|| v.map(|c| c / length))
}
