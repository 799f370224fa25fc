//! Shapes computed by formulas, with exact normals, texture coordinates and tangents.
//!
//! All are centred at the origin; +y is up. `segments` says how finely a shape is divided; a smaller number than the
//! minimum, 3 if the shape closes a circle, counts as the minimum.

mod builder;
mod knot;
mod lathe;
mod ring;
mod waves;

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::Geometry;
pub(crate) use builder::{Builder, Vertex};
pub(crate) use knot::torus;
pub use knot::torus_knot;
pub(crate) use lathe::{Piece, lathe};
pub use ring::ring;
pub use waves::waves;

/// A sphere with `segments` cells around and half as many from pole to pole.
///
/// u grows eastward (counterclockwise seen from +y) from 0 to 1, starting at +z; v grows from the south pole, 0, to the
/// north pole, 1. dp/du points east. At the poles, every triangle has its own vertex with the u of its middle.
pub fn sphere(radius: f32, segments: u32) -> Geometry {
    let (columns, rows) = (segments.max(3) as usize, (segments as usize / 2).max(2));
    let mut builder = Builder::default();
    builder.patch(columns, rows, |i, j| {
        let ([sine, cosine], [ring, height]) = (turn(i, columns), polar(j, rows));
        let normal = DVec3::new(ring * sine, height, ring * cosine);
        let u = if j == 0 {
            i as f64 + 0.5
        } else if j == rows {
            i as f64 - 0.5
        } else {
            i as f64
        };
        let east = if j == 0 || j == rows { direction(u / columns as f64) } else { [sine, cosine] };
        Vertex {
            position: normal * f64::from(radius),
            normal,
            tangent: DVec3::new(east[1], 0.0, -east[0]),
            uv: [u / columns as f64, j as f64 / rows as f64],
        }
    });
    builder.finish()
}

/// A square of side `size` in the plane y = 0, facing +y, with `segments` by `segments` cells. u runs along +x, v along
/// -z.
pub fn plane(size: f32, segments: u32) -> Geometry {
    let mut builder = Builder::default();
    let half = f64::from(size) / 2.0;
    square(&mut builder, DVec3::ZERO, DVec3::X * half, DVec3::NEG_Z * half, segments.max(1) as usize);
    builder.finish()
}

/// A disk in the plane y = 0, facing +y, with `segments` triangles. u runs along +x, v along -z; in texture
/// coordinates, the disk touches the edges of the unit square.
pub fn disk(radius: f32, segments: u32) -> Geometry {
    let columns = segments.max(3) as usize;
    let mut builder = Builder::default();
    builder.patch(columns, 1, |i, j| {
        let [sine, cosine] = turn(i, columns).map(|x| if j == 0 { x } else { 0.0 });
        Vertex {
            position: DVec3::new(sine, 0.0, cosine) * f64::from(radius),
            normal: DVec3::Y,
            tangent: DVec3::X,
            uv: [0.5 + 0.5 * sine, 0.5 - 0.5 * cosine],
        }
    });
    builder.finish()
}

/// A cuboid with edges of the given lengths along x, y and z; each face is a unit square of texture cut into `segments`
/// by `segments` cells.
pub fn cuboid(size: [f32; 3], segments: u32) -> Geometry {
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * crate::geometry::wide(size) / 2.0);
    let mut builder = Builder::default();
    // Right, left, up, down, front, back: the direction out of the face, u, v.
    for [out, u, v] in [[x, -z, y], [-x, z, y], [y, x, -z], [-y, x, z], [z, x, y], [-z, -x, y]] {
        square(&mut builder, out, u, v, segments.max(1) as usize);
    }
    builder.finish()
}

/// A photographer's backdrop: a floor that bends into a wall behind it, so that no horizon is visible. `size` is its
/// width and the height of the wall; the floor begins at z = `size` / 2 and bends up from z = -`size` / 6 on. u runs
/// along +x, v back and up.
pub fn cove(size: f32, segments: u32) -> Geometry {
    let steps = segments.max(3) as usize;
    let size = f64::from(size);
    let (half, bend) = (size / 2.0, size / 6.0);
    let length = half + bend + bend * PI / 2.0 + (size - bend);
    let mut builder = Builder::default();
    builder.patch(1, steps + 2, |i, j| {
        let share = j.saturating_sub(1).min(steps) as f64 / steps as f64;
        let [sine, cosine] = direction(share / 4.0);
        // Floor, bend and wall: height, depth, and length of the profile up to there.
        let (y, z, way) = if j == 0 {
            (0.0, half, 0.0)
        } else if j == steps + 2 {
            (size, -2.0 * bend, length)
        } else {
            (bend * (1.0 - cosine), -bend - bend * sine, half + bend + bend * share * PI / 2.0)
        };
        Vertex {
            position: DVec3::new(half * (2.0 * i as f64 - 1.0), y, z),
            normal: DVec3::new(0.0, cosine, sine),
            tangent: DVec3::X,
            uv: [i as f64, way / length],
        }
    });
    builder.finish()
}

/// A patch around `centre` that extends by `u` and `v` to both sides.
fn square(builder: &mut Builder, centre: DVec3, u: DVec3, v: DVec3, cells: usize) {
    let share = |i: usize| i as f64 / cells as f64;
    builder.patch(cells, cells, |i, j| Vertex {
        position: centre + u * (2.0 * share(i) - 1.0) + v * (2.0 * share(j) - 1.0),
        normal: u.cross(v).normalize(),
        tangent: u.normalize(),
        uv: [share(i), share(j)],
    });
}

/// Sine and cosine of the `i`-th of `n` equal steps around the circle. The last equals the first bit for bit, so that
/// closed surfaces have no gap.
pub(crate) fn turn(i: usize, n: usize) -> [f64; 2] {
    direction((i % n) as f64 / n as f64)
}

/// Sine and cosine of a fraction of a full turn.
fn direction(share: f64) -> [f64; 2] {
    [libm::sin(TAU * share), libm::cos(TAU * share)]
}

/// Radius and height of the `j`-th of `n` equal steps from the south pole to the north pole of the unit sphere.
fn polar(j: usize, n: usize) -> [f64; 2] {
    match j {
        0 => [0.0, -1.0],
        _ if j == n => [0.0, 1.0],
        _ => [libm::sin(PI * j as f64 / n as f64), -libm::cos(PI * j as f64 / n as f64)],
    }
}
