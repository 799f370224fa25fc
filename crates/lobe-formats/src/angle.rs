//! The angles of tables, and their units.

use std::f64::consts::PI;

use crate::words::words;

words! {
    /// An angle of a table.
    Angle:
    /// The polar angle of the light.
    ThetaI = "theta_i",
    /// Its azimuth.
    PhiI = "phi_i",
    /// The polar angle of the viewer.
    ThetaO = "theta_o",
    /// Its azimuth.
    PhiO = "phi_o",
    /// The polar angle of the light, in specular coordinates.
    Sigma = "sigma",
    /// Its azimuth.
    Psi = "psi",
    /// The angle between the viewer and the mirror direction.
    Theta = "theta",
    /// The azimuth about the mirror direction.
    Phi = "phi",
}

words! {
    /// A unit of angles.
    Unit:
    /// Degrees.
    Deg = "deg" or "degree" or "degrees" or "°" or "º" or "˚" or "grad",
    /// Radians.
    Rad = "rad" or "radian" or "radians",
    /// Thousandths of a radian.
    Mrad = "mrad",
}

impl Unit {
    /// The factor that converts it to radians.
    pub fn radians(self) -> f64 {
        match self {
            Unit::Deg => PI / 180.0,
            Unit::Rad => 1.0,
            Unit::Mrad => 1e-3,
        }
    }
}

/// Radians in degrees, rounded to a billionth: 15 degrees must be written as 15, although they are 14.999999999999998
/// after conversion to radians and back.
pub(crate) fn degrees(radians: f64) -> f64 {
    (radians.to_degrees() * 1e9).round() / 1e9
}

/// Degrees that readers convert to the same radians, with as few digits as possible; `None` if there are none.
pub(crate) fn exact_degrees(radians: f64) -> Option<f64> {
    let near = radians.to_degrees();
    let candidates = [degrees(radians), near, near.next_up(), near.next_down()];
    candidates.into_iter().find(|degrees| (degrees * Unit::Deg.radians()).to_bits() == radians.to_bits())
}
