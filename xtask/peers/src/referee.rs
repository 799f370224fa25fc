//! Tests rays against all triangles of a mesh in double precision, if answers in single precision differ.

use std::rc::Rc;

use lobe_benches::tracing::RaySet;
use lobe_trace::Mesh;

use super::comparison::{Agreement, Judge};

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// How far outside a triangle, relative to its heights, a ray may seem inside in single precision. A triangle that is a
/// hundred times smaller than its coordinates loses two digits of seven, and more if seen edge-on.
const EDGE: f64 = 1e-3;

/// A ray and a triangle's plane.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    t: f64,
    /// The least of the three weights: negative outside the triangle.
    inside: f64,
    /// How far t moves if the plane moves by half a unit in the last place of single precision: far if the ray is
    /// nearly parallel to it.
    doubt: f64,
}

/// By the volumes between the ray and each edge. Both triangles of an edge get the same volume, to the last bit except
/// for its sign, so no ray slips between them.
fn meet(origin: V, direction: V, corners: [[f32; 3]; 3]) -> Meeting {
    let [a, b, c] = corners.map(|corner| std::array::from_fn(|axis| f64::from(corner[axis]) - origin[axis]));
    let volumes = [(b, c), (c, a), (a, b)].map(|(from, to)| dot(direction, cross(from, to)));
    let sum = volumes[0] + volumes[1] + volumes[2];
    let [u, v, w] = volumes.map(|volume| volume / sum);
    let t = (u * dot(a, direction) + v * dot(b, direction) + w * dot(c, direction)) / dot(direction, direction);
    let [side, other] = [b, c].map(|corner| std::array::from_fn(|axis| corner[axis] - a[axis]));
    let normal = cross(side, other);
    let reach =
        corners.as_flattened().iter().map(|x| f64::from(x.abs())).chain(origin.map(f64::abs)).fold(0.0, f64::max);
    let doubt = 0.5 * f64::from(f32::EPSILON) * reach * dot(normal, normal).sqrt() / sum.abs();
    // A ray within the plane has NaN weights, which a minimum would ignore.
    Meeting { t, inside: if sum == 0.0 { f64::NEG_INFINITY } else { u.min(v).min(w) }, doubt }
}

/// Decides about answers to rays: t and the two halves of the triangle's index, -1 for a miss; or 1 or 0 if any hit is
/// enough.
///
/// A correct answer names a triangle that is hit, at least at its edge, and whose t is within `agreement` of the t of
/// the nearest hit; the t of the answer agrees with the triangle within the accuracy of single precision.
pub struct Referee {
    /// All triangles.
    pub mesh: Rc<Mesh>,
    /// All rays.
    pub set: Rc<RaySet>,
    /// The tolerance of t.
    pub agreement: Agreement,
}

impl Referee {
    fn meet(&self, ray: usize, triangle: usize) -> Meeting {
        let rays = &self.set.rays;
        let [origin, direction] =
            [&rays.origin, &rays.direction].map(|rows| std::array::from_fn(|axis| f64::from(rows[axis][ray])));
        meet(origin, direction, self.mesh.corners(triangle))
    }

    /// The t of the nearest hit.
    fn nearest(&self, ray: usize) -> Option<f64> {
        let within = f64::from(self.set.rays.t_min[ray])..=f64::from(self.set.rays.t_max[ray]);
        let meetings = (0..self.mesh.triangles().len()).map(|triangle| self.meet(ray, triangle));
        let hits = meetings.filter(|meeting| meeting.inside >= 0.0 && within.contains(&meeting.t));
        hits.map(|meeting| meeting.t).min_by(f64::total_cmp)
    }
}

impl Judge for Referee {
    fn questions(&self) -> usize {
        self.set.rays.len()
    }

    fn is_right(&self, ray: usize, answer: &[f32]) -> bool {
        let nearest = self.nearest(ray);
        if self.set.any {
            return answer[0] == f32::from(u8::from(nearest.is_some()));
        }
        let Some(nearest) = nearest else { return answer[0] == -1.0 };
        let triangle = answer[1] + 4096.0 * answer[2];
        if !(0.0..self.mesh.triangles().len() as f32).contains(&triangle) {
            return false;
        }
        let named = self.meet(ray, triangle as usize);
        let close = self.agreement.relative * nearest.max(self.agreement.floor);
        let is_nearest = named.inside >= -EDGE && (named.t - nearest).abs() <= close;
        is_nearest && (f64::from(answer[0]) - named.t).abs() <= close + named.doubt
    }
}

#[cfg(test)]
mod tests {
    use lobe_trace::{RayClass, RaySoA};

    use super::*;

    const CLOSE: Agreement = Agreement { relative: 1e-5, floor: 0.1, outliers: 0.0 };

    /// A unit square of two triangles, 0 beyond its diagonal and 1, at z = 1, a larger triangle 2 at z = 1.01, and a
    /// steep one next to it.
    fn square(any: bool, rays: &[[f32; 2]]) -> Referee {
        let mut positions: Vec<[f32; 3]> =
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| [x, y, 1.0]).into();
        positions.extend([[-5.0, -5.0], [5.0, -5.0], [0.0, 5.0]].map(|[x, y]| [x, y, 1.01]));
        positions.extend([[3.0, 3.5, 1.0], [3.0, 4.5, 1.0], [3.0 + 1.0 / 1024.0, 4.0, 2.0]]);
        let mesh = Mesh::new(positions, vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [7, 8, 9]]).unwrap();
        let mut all = RaySoA::with_capacity(rays.len());
        rays.iter().for_each(|&[x, y]| all.push([x, y, 0.0], [0.0, 0.0, 1.0], 0.0, if any { 1.005 } else { 9.0 }));
        let set = RaySet { name: "some", class: RayClass::Camera, any, rays: all };
        Referee { mesh: Rc::new(mesh), set: Rc::new(set), agreement: CLOSE }
    }

    #[test]
    fn the_nearest_hit_is_right_and_nothing_else() {
        let referee = square(false, &[[0.7, 0.2], [7.0, 7.0]]);
        assert_eq!(referee.questions(), 2);
        assert!(referee.is_right(0, &[1.0, 0.0, 0.0]) && referee.is_right(0, &[1.000_005, 0.0, 0.0]));
        for wrong in [[1.000_05, 0.0, 0.0], [1.01, 2.0, 0.0], [1.0, 1.0, 0.0], [1.0, 2.0, 0.0], [1.0, 0.0, 1.0]] {
            assert!(!referee.is_right(0, &wrong), "{wrong:?}");
        }
        assert!(!referee.is_right(0, &[-1.0; 3]) && !referee.is_right(0, &[f32::NAN; 3]));
        assert!(referee.is_right(1, &[-1.0; 3]) && !referee.is_right(1, &[1.0, 0.0, 0.0]));
    }

    #[test]
    fn at_an_edge_both_triangles_are_right_and_those_behind_are_not() {
        let referee = square(false, &[[0.5, 0.5], [0.300_01, 0.3]]);
        for ray in [0, 1] {
            assert!(referee.is_right(ray, &[1.0, 0.0, 0.0]) && referee.is_right(ray, &[1.0, 1.0, 0.0]));
            assert!(!referee.is_right(ray, &[1.01, 2.0, 0.0]));
        }
    }

    #[test]
    fn along_a_triangle_t_is_known_less_well() {
        let referee = square(false, &[[3.0 + 1.0 / 2048.0, 4.0]]);
        // At 45 degrees it would be 3e-7.
        assert!(referee.is_right(0, &[1.5, 3.0, 0.0]) && referee.is_right(0, &[1.5002, 3.0, 0.0]));
        assert!(!referee.is_right(0, &[1.5005, 3.0, 0.0]) && !referee.is_right(0, &[1.4995, 3.0, 0.0]));
    }

    #[test]
    fn if_any_hit_is_enough_those_up_to_the_end_count() {
        let referee = square(true, &[[0.7, 0.2], [1.5, 0.2]]);
        assert!(referee.is_right(0, &[1.0]) && !referee.is_right(0, &[0.0]));
        assert!(referee.is_right(1, &[0.0]) && !referee.is_right(1, &[1.0]), "the large triangle lies beyond the end");
    }
}
