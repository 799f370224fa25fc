//! Triangles that radiate.

use lobe_lane::{Block, Floats, Lanes};

use super::LightSample;
use super::cdf::Cdf;
use crate::vec3::{Vec3, cross, length, sub, unit};
use crate::vectors::{self, add, dot};

/// Triangles that radiate the same into all directions in front of them.
#[derive(Clone, Debug)]
pub struct AreaLight<const C: usize> {
    /// For each triangle a corner, the ways from there to the others, and the unit normal.
    triangles: Vec<[Vec3; 4]>,
    areas: Cdf,
    area: f64,
    radiance: [f32; C],
    two_sided: bool,
}

impl<const C: usize> AreaLight<C> {
    /// A light of these triangles, counterclockwise seen from the front, with this radiance in W/(m^2 sr). `None` where
    /// they have no area.
    pub fn new(triangles: Vec<[[f32; 3]; 3]>, radiance: [f32; C], two_sided: bool) -> Option<Self> {
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
    pub fn radiance(&self) -> [f32; C] {
        self.radiance
    }

    /// Area of all triangles.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// What leaves toward a viewer in front, or behind.
    pub(crate) fn emitted(&self, front: bool) -> [f32; C] {
        if self.two_sided || front { self.radiance } else { [0.0; C] }
    }

    /// The density over solid angle, 1/sr, of drawing places that far away, whose normals have those cosines to the way.
    #[inline(always)]
    pub(crate) fn pdf<L: Lanes>(&self, lanes: L, distance: L::F, cos: L::F) -> L::F {
        distance * distance / (cos.abs().max(lanes.splat(1e-9)) * lanes.splat(self.area as f32))
    }

    /// Draws places uniformly in area.
    #[inline(always)]
    pub(crate) fn sample_li<L: Lanes>(&self, lanes: L, from: [L::F; 3], [u, v]: [L::F; 2]) -> LightSample<L, C> {
        let (index, inside) = self.areas.sample(lanes, lanes.splat_int(0), u);
        let block = Block::new(self.triangles.as_flattened().as_flattened(), [0, 4, 8]);
        let [a, b, c] = lanes.gather_quads(&block, index * lanes.splat_int(12));
        let [corner, ab] = [[a[0], a[1], a[2]], [a[3], b[0], b[1]]];
        let [ac, normal] = [[b[2], b[3], c[0]], [c[1], c[2], c[3]]];
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let root = inside.sqrt();
        let (wb, wc) = (root * (one - v), root * v);
        let place = add::<L>(corner, add::<L>(vectors::scale::<L>(ab, wb), vectors::scale::<L>(ac, wc)));
        let toward = vectors::sub::<L>(place, from);
        let distance = dot::<L>(toward, toward).sqrt();
        let wi = vectors::scale::<L>(toward, one / distance);
        let cos = -dot::<L>(normal, wi);
        let facing = if self.two_sided { cos.abs() } else { cos };
        let pdf = self.pdf(lanes, distance, cos);
        let valid = zero.lt(distance) & lanes.splat(1e-6).lt(facing) & pdf.lt(lanes.splat(f32::INFINITY));
        LightSample::new(lanes, wi, distance, self.radiance, pdf, valid)
    }
}

/// A corner, the ways from there to the others, and the unit normal; 0 where there is no area.
fn parts([a, b, c]: [Vec3; 3]) -> [Vec3; 4] {
    let normal = unit(normal([a, b, c])).unwrap_or([0.0; 3]);
    [a, sub(b, a), sub(c, a), normal]
}

/// Normal of a triangle, twice its area long.
fn normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    cross(sub(b, a), sub(c, a))
}

#[cfg(test)]
mod tests {
    use lobe_lane::Mask;
    use lobe_scalar::Scalar;

    use super::*;

    #[test]
    fn drawing_integrates_the_solid_angle() {
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
    fn without_area_there_is_no_light() {
        assert!(AreaLight::new(vec![[[0.0; 3]; 3]], [1.0], false).is_none());
        assert!(AreaLight::new(vec![], [1.0], false).is_none());
    }
}
