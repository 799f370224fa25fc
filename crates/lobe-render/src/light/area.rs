//! Area lights: triangles that radiate.

use lobe_lane::{Block, Floats, Lanes};

use super::cdf::Cdf;
use super::sample::{EmissionPdf, EmissionSample, LightSample};
use crate::channels::Channels;
use crate::vec3::{Vec3, cross, length, sub, unit};
use crate::vectors::{self, add, cosine_hemisphere, dot, frame_of, to_world};

/// Triangles with the same radiance in all directions in front of them.
#[derive(Clone, Debug)]
pub struct AreaLight<S: Channels = [f32; 3]> {
    /// For each triangle, one corner, the edges from there to the others, and the unit normal.
    triangles: Vec<[Vec3; 4]>,
    areas: Cdf,
    area: f64,
    radiance: S,
    two_sided: bool,
}

impl<S: Channels> AreaLight<S> {
    /// A light of these triangles, counterclockwise seen from the front, with this radiance in W/(m^2 sr). `None` if
    /// they have no area.
    pub fn new(triangles: Vec<[[f32; 3]; 3]>, radiance: S, two_sided: bool) -> Option<Self> {
        let areas: Vec<f64> = triangles.iter().map(|&corners| f64::from(length(normal(corners))) / 2.0).collect();
        let area: f64 = areas.iter().sum();
        if !(area > 0.0 && area.is_finite()) {
            return None;
        }
        let areas = Cdf::new(areas.len(), &areas);
        let triangles = triangles.into_iter().map(parts).collect();
        Some(AreaLight { triangles, areas, area, radiance, two_sided })
    }

    /// Radiance in W/(m^2 sr).
    pub fn radiance(&self) -> S {
        self.radiance
    }

    /// `true` if the backs of the triangles radiate as well.
    pub fn is_two_sided(&self) -> bool {
        self.two_sided
    }

    /// Total area of the triangles.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The radiance toward a viewer in front or behind.
    pub(crate) fn emitted(&self, front: bool) -> S {
        if self.two_sided || front { self.radiance } else { S::ZERO }
    }

    /// The density over solid angle, 1/sr, of sampling points at that distance whose normals have that cosine to the
    /// ray.
    #[inline(always)]
    pub(crate) fn pdf_li<L: Lanes>(&self, lanes: L, distance: L::F, cos: L::F) -> L::F {
        distance * distance / (cos.abs().max(lanes.splat(1e-9)) * lanes.splat(self.area as f32))
    }

    /// The factor that turns the density of a direction sampled by [`sample_le`](AreaLight::sample_le) into its cosine.
    pub(crate) fn cosine_over_pdf(&self) -> f32 {
        if self.two_sided { std::f32::consts::TAU } else { std::f32::consts::PI }
    }

    /// Samples points uniformly in area. Returns them and the normals of their triangles.
    #[inline(always)]
    fn sample_points<L: Lanes>(&self, lanes: L, [u, v]: [L::F; 2]) -> ([L::F; 3], [L::F; 3]) {
        let (index, inside) = self.areas.sample(lanes, lanes.splat_int(0), u);
        let block = Block::new(self.triangles.as_flattened().as_flattened(), [0, 4, 8]);
        let [a, b, c] = lanes.gather_quads(&block, index * lanes.splat_int(12));
        let [corner, ab] = [[a[0], a[1], a[2]], [a[3], b[0], b[1]]];
        let [ac, normal] = [[b[2], b[3], c[0]], [c[1], c[2], c[3]]];
        let one = lanes.splat(1.0);
        let root = inside.sqrt();
        let (wb, wc) = (root * (one - v), root * v);
        (add::<L>(corner, add::<L>(vectors::scale::<L>(ab, wb), vectors::scale::<L>(ac, wc))), normal)
    }

    /// Samples points uniformly in area, as seen from the points `from`.
    #[inline(always)]
    pub(crate) fn sample_li<L: Lanes>(&self, lanes: L, from: [L::F; 3], u: [L::F; 2]) -> LightSample<L, S> {
        let (position, normal) = self.sample_points(lanes, u);
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let toward = vectors::sub::<L>(position, from);
        let distance = dot::<L>(toward, toward).sqrt();
        let wi = vectors::scale::<L>(toward, one / distance);
        let cos = -dot::<L>(normal, wi);
        let facing = if self.two_sided { cos.abs() } else { cos };
        let pdf = self.pdf_li(lanes, distance, cos);
        let valid = zero.lt(distance) & lanes.splat(1e-6).lt(facing) & pdf.lt(lanes.splat(f32::INFINITY));
        LightSample::new(lanes, wi, distance, self.radiance, pdf, valid)
    }

    /// Samples rays that leave the triangles: uniform in area, in proportion to the cosine in direction. The first half
    /// of the third number leaves the front of a two-sided light, the second half its back.
    #[inline(always)]
    pub(crate) fn sample_le<L: Lanes>(&self, lanes: L, [u, v, s, t]: [L::F; 4]) -> EmissionSample<L, S> {
        let (origin, mut normal) = self.sample_points(lanes, [u, v]);
        let (two, half) = (lanes.splat(2.0), lanes.splat(0.5));
        let mut s = s;
        if self.two_sided {
            let front = s.lt(half);
            normal = vectors::select(lanes, front, normal, vectors::neg::<L>(normal));
            s = two * lanes.select(front, s, s - half);
        }
        let local = cosine_hemisphere(lanes, [s, t]);
        let direction = to_world::<L>(frame_of(lanes, normal), local);
        let cos = dot::<L>(normal, direction);
        let mut emitted = self.radiance.in_lanes(lanes);
        for channel in emitted.as_mut() {
            *channel = *channel * cos;
        }
        let valid = lanes.splat(1e-6).lt(cos);
        EmissionSample { origin, direction, emitted, pdf: self.pdf_le(lanes, cos), valid }
    }

    /// The densities with which [`sample_le`](AreaLight::sample_le) samples rays with that cosine to the normal.
    #[inline(always)]
    pub(crate) fn pdf_le<L: Lanes>(&self, lanes: L, cos: L::F) -> EmissionPdf<L::F> {
        use std::f32::consts::FRAC_1_PI;
        let zero = lanes.splat(0.0);
        let direction = if self.two_sided {
            lanes.splat(0.5 * FRAC_1_PI) * cos.abs()
        } else {
            lanes.splat(FRAC_1_PI) * cos.max(zero)
        };
        EmissionPdf { position: lanes.splat((1.0 / self.area) as f32), direction }
    }
}

/// One corner, the edges from there to the others, and the unit normal; 0 if there is no area.
fn parts([a, b, c]: [Vec3; 3]) -> [Vec3; 4] {
    let normal = unit(normal([a, b, c])).unwrap_or([0.0; 3]);
    [a, sub(b, a), sub(c, a), normal]
}

/// Normal of a triangle, with a length of twice its area.
fn normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    cross(sub(b, a), sub(c, a))
}

#[cfg(test)]
mod tests {
    use lobe_lane::Mask;
    use lobe_scalar::Scalar;

    use super::*;

    #[test]
    fn sampling_integrates_the_solid_angle() {
        // A square of side 2 at distance 1 seen from below its centre: 4 atan(1 / sqrt(3)) = 2 pi / 3 sr.
        let [a, b, c, d] = [[-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]];
        let light = AreaLight::new(vec![[a, b, c], [a, c, d]], [1.0], false).unwrap();
        assert!((light.area() - 4.0).abs() < 1e-12);
        let n = 128;
        let mut angle = 0.0;
        let lanes = Scalar::<1>;
        for i in 0..n * n {
            let u = [((i / n) as f32 + 0.5) / n as f32, ((i % n) as f32 + 0.5) / n as f32];
            let sample = light.sample_li(lanes, lanes.splat_xyz([0.0; 3]), u.map(|u| lanes.splat(u)));
            assert!(sample.valid.all());
            angle += 1.0 / f64::from(lanes.extract(sample.pdf, 0)) / f64::from(n * n);
        }
        assert!((angle - 2.0 * std::f64::consts::PI / 3.0).abs() < 2e-3, "{angle}");
        let behind = light.sample_li(lanes, lanes.splat_xyz([0.0, 2.0, 0.0]), [lanes.splat(0.5); 2]);
        assert!(!behind.valid.any(), "dark behind");
    }

    #[test]
    fn triangles_without_area_are_not_a_light() {
        assert!(AreaLight::new(vec![[[0.0; 3]; 3]], [1.0], false).is_none());
        assert!(AreaLight::new(vec![], [1.0], false).is_none());
    }
}
