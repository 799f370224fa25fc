//! Surfaces of revolution around +y.

use glam::{DAffine3, DVec3};

use super::{Builder, Vertex, turn};

/// A smooth piece of a profile: points (radius, height) with the unit direction of the profile at each. Between pieces
/// the surface has an edge, unless their directions agree.
pub(crate) struct Piece(Vec<[[f64; 2]; 2]>);

impl Piece {
    /// A straight piece.
    pub fn line(from: [f64; 2], to: [f64; 2]) -> Piece {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        Piece([from, to].map(|point| [point, along.map(|x| x / length)]).into())
    }

    /// An arc in `steps` steps; angles in radians from the direction of the radius toward +y.
    pub fn arc(centre: [f64; 2], radius: f64, from: f64, to: f64, steps: usize) -> Piece {
        let sense = if to < from { -1.0 } else { 1.0 };
        let point = |k: usize| {
            let angle = from + (to - from) * (k as f64 / steps as f64);
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            [[centre[0] + radius * cosine, centre[1] + radius * sine], [-sense * sine, sense * cosine]]
        };
        Piece((0..=steps).map(point).collect())
    }
}

/// Rotates a profile, which runs from the bottom outward and up to the top, around +y in `segments` steps, and places
/// the surface. u grows eastward, v with the length of the profile, both from 0 to 1.
pub(crate) fn lathe(builder: &mut Builder, profile: &[Piece], segments: usize, place: DAffine3) {
    let points: Vec<[f64; 2]> =
        profile.iter().flat_map(|Piece(points)| points).map(|&[point, _]| snap(point)).collect();
    let mut lengths = vec![0.0];
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let step = ((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])).sqrt();
        lengths.push(lengths[lengths.len() - 1] + step);
    }
    let whole = lengths[lengths.len() - 1];
    let mut first = 0;
    for Piece(piece) in profile {
        builder.patch(segments, piece.len() - 1, |i, j| {
            let [sine, cosine] = turn(i, segments);
            let ([radius, height], [_, [outward, up]]) = (points[first + j], piece[j]);
            Vertex {
                position: place.transform_point3(DVec3::new(radius * sine, height, radius * cosine)),
                normal: place.transform_vector3(DVec3::new(up * sine, -outward, up * cosine)),
                tangent: place.transform_vector3(DVec3::new(cosine, 0.0, -sine)),
                uv: [i as f64 / segments as f64, lengths[first + j] / whole],
            }
        });
        first += piece.len();
    }
}

/// Rounds to a grid, so that two pieces that end at the same point by different formulas leave no gap.
fn snap(point: [f64; 2]) -> [f64; 2] {
    const GRID: f64 = (1u64 << 40) as f64;
    // `+ 0.0` turns -0 into +0.
    point.map(|x| (x * GRID).round() / GRID + 0.0)
}
