//! The ball on which renderers show materials.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DMat3, DVec3};

use crate::Geometry;
use crate::shapes::{Builder, Piece, lathe, torus};

/// Steps around every part.
const SEGMENTS: usize = 80;
/// Radius of the groove around the ball.
const GROOVE: f64 = 0.11;
/// Radii of the ring that the ball rests on.
const RING: [f64; 2] = [0.5, 0.12];
/// Height of the middle of the ring.
const SEAT: f64 = 0.5;
/// How far the ball leans toward +z, in radians, so that its groove and knob are visible.
const LEAN: f64 = 0.45;

/// A material ball: a sphere of radius 1 with a groove around it and a knob on top, leaning toward +z on a ring that
/// lies on a pedestal. It stands on y = 0 and is 2.6 high.
///
/// Its groups, `ball`, `ring` and `pedestal`, carry materials of the same names. dp/du goes around every part.
pub fn ball() -> Geometry {
    let mut builder = Builder::default();
    // The sphere touches the ring: in the profile, the distance of the centres of both circles is the sum of their
    // radii.
    let [across, radius] = RING;
    let height = SEAT + ((1.0 + radius) * (1.0 + radius) - across * across).sqrt();
    let (sine, cosine) = (libm::sin(LEAN), libm::cos(LEAN));
    let lean = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cosine, sine), DVec3::new(0.0, -sine, cosine));
    lathe(&mut builder, &sphere(), SEGMENTS, DAffine3::from_mat3_translation(lean, DVec3::Y * height));
    builder.group("ball");
    torus(&mut builder, RING, SEAT, SEGMENTS, 20);
    builder.group("ring");
    lathe(&mut builder, &pedestal(), SEGMENTS, DAffine3::IDENTITY);
    builder.group("pedestal");
    builder.finish()
}

/// Profile of the ball around its own centre: sphere, groove, sphere, knob.
fn sphere() -> [Piece; 6] {
    // The groove is an arc around a point of the sphere; its edges are this angle from there.
    let edge = 2.0 * libm::asin(GROOVE / 2.0);
    let from = -(FRAC_PI_2 + edge / 2.0);
    let latitude = 1.15;
    let [neck, shoulder] = [libm::cos(latitude), libm::sin(latitude)];
    let (round, top) = (0.07, shoulder + 0.12);
    [
        Piece::arc([0.0, 0.0], 1.0, -FRAC_PI_2, -edge, 24),
        Piece::arc([1.0, 0.0], GROOVE, from, -4.0 * FRAC_PI_2 - from, 8),
        Piece::arc([0.0, 0.0], 1.0, edge, latitude, 18),
        Piece::line([neck, shoulder], [neck, top]),
        Piece::arc([neck - round, top], round, 0.0, FRAC_PI_2, 5),
        Piece::line([neck - round, top + round], [0.0, top + round]),
    ]
}

/// Profile of the pedestal: a plate with a rounded edge, and a fillet up to the surface that the ring lies on.
fn pedestal() -> [Piece; 6] {
    let (plate, bevel, fillet, neck) = (0.18, 0.06, 0.2, 0.66);
    let top = SEAT - RING[1];
    [
        Piece::line([0.0, 0.0], [1.0, 0.0]),
        Piece::line([1.0, 0.0], [1.0, plate - bevel]),
        Piece::arc([1.0 - bevel, plate - bevel], bevel, 0.0, FRAC_PI_2, 5),
        Piece::line([1.0 - bevel, plate], [neck + fillet, plate]),
        Piece::arc([neck + fillet, plate + fillet], fillet, -FRAC_PI_2, -2.0 * FRAC_PI_2, 8),
        Piece::line([neck, top], [0.0, top]),
    ]
}
