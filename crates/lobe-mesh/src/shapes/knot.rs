//! Tubes around closed curves.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{Builder, Vertex, direction, turn};
use crate::Geometry;

/// Radius of the circle that a torus knot winds around, and radius of the tube of the torus that it lies on.
const RADII: [f64; 2] = [1.0, 0.42];

/// A tube of the given radius around the (`p`, `q`) torus knot, which goes `p` times around the axis and `q` times
/// through the hole of a torus with radii 1 and 0.42 around +y; it has `segments` cells along the knot and `around`
/// cells around the tube.
///
/// u grows along the knot, v around the tube, both from 0 to 1; dp/du is the direction of the knot.
pub fn torus_knot(p: u32, q: u32, radius: f32, segments: u32, around: u32) -> Geometry {
    let (p, q) = (f64::from(p), f64::from(q));
    let curve = |share: f64| {
        let ([sin_p, cos_p], [sin_q, cos_q]) = (direction(p * share), direction(q * share));
        let [ring, torus] = RADII;
        let reach = ring + torus * cos_q;
        let point = DVec3::new(reach * sin_p, torus * sin_q, reach * cos_p);
        let velocity = DVec3::new(
            p * reach * cos_p - q * torus * sin_q * sin_p,
            q * torus * cos_q,
            -p * reach * sin_p - q * torus * sin_q * cos_p,
        );
        [point, velocity.normalize()]
    };
    let mut builder = Builder::default();
    tube(&mut builder, curve, f64::from(radius), segments.max(3) as usize, around.max(3) as usize);
    builder.finish()
}

/// A torus around +y with its centre at `height`.
pub(crate) fn torus(builder: &mut Builder, [ring, radius]: [f64; 2], height: f64, segments: usize, around: usize) {
    let curve = |share: f64| {
        let [sine, cosine] = direction(share);
        [DVec3::new(ring * sine, height, ring * cosine), DVec3::new(cosine, 0.0, -sine)]
    };
    tube(builder, curve, radius, segments, around);
}

/// A tube around a closed curve, given as a function from the share of its length to point and unit direction.
fn tube(builder: &mut Builder, curve: impl Fn(f64) -> [DVec3; 2], radius: f64, segments: usize, around: usize) {
    let curve: Vec<[DVec3; 2]> = (0..segments).map(|i| curve(i as f64 / segments as f64)).collect();
    let sides = sides(&curve);
    builder.patch(segments, around, |i, j| {
        let ([point, along], side) = (curve[i % segments], sides[i % segments]);
        let [sine, cosine] = turn(j, around);
        let normal = side * cosine - along.cross(side) * sine;
        Vertex {
            position: point + normal * radius,
            normal,
            tangent: along,
            uv: [i as f64 / segments as f64, j as f64 / around as f64],
        }
    });
}

/// Unit vectors across a closed curve that turn about it as little as possible and still meet at the end. They are
/// carried along by double reflection (Wang, Jüttler, Zheng and Liu, "Computation of Rotation Minimizing Frames",
/// 2008), and the angle missing at the end is distributed evenly.
fn sides(curve: &[[DVec3; 2]]) -> Vec<DVec3> {
    let reflect = |v: DVec3, across: DVec3| match across.try_normalize() {
        Some(across) => v - across * (2.0 * across.dot(v)),
        None => v,
    };
    let carry = |side: DVec3, [p, t]: [DVec3; 2], [q, u]: [DVec3; 2]| {
        let chord = q - p;
        reflect(reflect(side, chord), u - reflect(t, chord))
    };
    let mut sides = vec![curve[0][1].any_orthonormal_vector()];
    for pair in curve.windows(2) {
        sides.push(carry(sides[sides.len() - 1], pair[0], pair[1]));
    }
    let end = carry(sides[sides.len() - 1], curve[curve.len() - 1], curve[0]);
    let [_, along] = curve[0];
    let missing = libm::atan2(end.cross(sides[0]).dot(along), end.dot(sides[0]));
    for (i, (side, [_, along])) in sides.iter_mut().zip(curve).enumerate() {
        let [sine, cosine] = direction(missing / TAU * i as f64 / curve.len() as f64);
        *side = (*side * cosine + along.cross(*side) * sine).normalize();
    }
    sides
}
