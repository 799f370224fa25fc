//! One sample at a time in `f64`: the reference for the lanes.

use std::f64::consts::TAU;

use super::PatchSampler;
use crate::Scatter;
use crate::bsdf::unit;
use crate::window::klems::{AngleBasis, Ring};

impl PatchSampler {
    /// The integral of luminance times `f` times cosine for light from `wi`, a unit vector on either side.
    pub fn brightness_reference(&self, wi: [f32; 3]) -> f32 {
        self.row(wi).map_or(0.0, |row| self.brightness[row])
    }

    /// A direction and its density, 1/sr, for light from `wi` and two numbers in `[0, 1)`; zeros if `wi` is in no
    /// patch.
    pub fn draw_reference(&self, wi: [f32; 3], [u, w]: [f32; 2]) -> ([f32; 3], f32) {
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
        // Rounding must not move a direction into the surface.
        let (sin, z) = ((1.0 - z2).max(0.0).sqrt(), z2.max(0.0).sqrt().max(1e-9));
        let side = f64::from(wi[2].signum()) * if self.scatter == Scatter::Reflection { 1.0 } else { -1.0 };
        let direction = [sin * cos_phi, sin * sin_phi, z * side].map(|x| x as f32);
        (direction, (mass / self.exit.projected_solid_angle(patch) * z) as f32)
    }

    /// The density, 1/sr, with which [`draw_reference`](Self::draw_reference) draws `wo` for light from `wi`.
    pub fn pdf_reference(&self, wi: [f32; 3], wo: [f32; 3]) -> f32 {
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
fn ring_of(basis: &AngleBasis, patch: usize) -> (Ring, usize) {
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
