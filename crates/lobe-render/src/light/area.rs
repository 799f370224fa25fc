//! Triangles that radiate.

use super::Lit;
use crate::vec3::{Vec3, add, cross, dot, length, scale, sub, unit};

/// Triangles that radiate the same into all directions in front of them.
#[derive(Clone, Debug)]
pub struct AreaLight<const C: usize> {
    /// For each triangle a corner, the ways from there to the others, and the unit normal.
    triangles: Vec<[Vec3; 4]>,
    /// The sum of the areas up to and with each triangle, the last being 1.
    sums: Vec<f32>,
    area: f64,
    radiance: [f32; C],
    two_sided: bool,
}

impl<const C: usize> AreaLight<C> {
    /// A light of these triangles, counterclockwise seen from the front, with this radiance in W/(m^2 sr). `None` where
    /// they have no area.
    pub fn new(triangles: Vec<[[f32; 3]; 3]>, radiance: [f32; C], two_sided: bool) -> Option<Self> {
        let mut area = 0.0;
        let sums: Vec<f64> = triangles
            .iter()
            .map(|&triangle| {
                area += f64::from(length(normal(triangle))) / 2.0;
                area
            })
            .collect();
        let sound = area > 0.0 && area.is_finite();
        sound.then(|| AreaLight {
            sums: sums.into_iter().map(|sum| (sum / area) as f32).collect(),
            triangles: triangles.into_iter().map(parts).collect(),
            area,
            radiance,
            two_sided,
        })
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

    /// The density over solid angle, 1/sr, of drawing a place that far away, whose normal has that cosine to the way.
    pub(crate) fn pdf(&self, distance: f32, cos: f32) -> f32 {
        distance * distance / (cos.abs().max(1e-9) * self.area as f32)
    }

    /// Draws a place uniformly in area.
    pub(crate) fn draw(&self, from: Vec3, [u, v]: [f32; 2]) -> Option<Lit<C>> {
        let last = self.triangles.len() - 1;
        let index = self.sums.partition_point(|&sum| sum <= u).min(last);
        let before = if index == 0 { 0.0 } else { self.sums[index - 1] };
        let inside = ((u - before) / (self.sums[index] - before).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let [a, ab, ac, normal] = self.triangles[index];
        let root = inside.sqrt();
        let (wb, wc) = (root * (1.0 - v), root * v);
        let place = add(a, add(scale(ab, wb), scale(ac, wc)));
        let toward = sub(place, from);
        let distance = length(toward);
        if distance <= 0.0 {
            return None;
        }
        let wi = scale(toward, 1.0 / distance);
        let cos = -dot(normal, wi);
        let faces = cos > 1e-6 || self.two_sided && cos < -1e-6;
        let pdf = self.pdf(distance, cos);
        (faces && pdf.is_finite()).then_some(Lit { wi, distance, radiance: self.radiance, pdf: Some(pdf) })
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
    use super::*;

    #[test]
    fn drawing_integrates_the_solid_angle() {
        // A square of side 2 at distance 1 seen from below its centre: 4 atan(1 / sqrt(3)) = 2 pi / 3 sr.
        let [a, b, c, d] = [[-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]];
        let light = AreaLight::new(vec![[a, b, c], [a, c, d]], [1.0], false).unwrap();
        assert!((light.area() - 4.0).abs() < 1e-12);
        let n = 128;
        let mut angle = 0.0;
        for i in 0..n * n {
            let u = [((i / n) as f32 + 0.5) / n as f32, ((i % n) as f32 + 0.5) / n as f32];
            let lit = light.draw([0.0; 3], u).unwrap();
            angle += 1.0 / f64::from(lit.pdf.unwrap()) / f64::from(n * n);
        }
        assert!((angle - 2.0 * std::f64::consts::PI / 3.0).abs() < 2e-3, "{angle}");
        assert!(light.draw([0.0, 2.0, 0.0], [0.5; 2]).is_none(), "dark behind");
    }

    #[test]
    fn without_area_there_is_no_light() {
        assert!(AreaLight::new(vec![[[0.0; 3]; 3]], [1.0], false).is_none());
        assert!(AreaLight::new(vec![], [1.0], false).is_none());
    }
}
