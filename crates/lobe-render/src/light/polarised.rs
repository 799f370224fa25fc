//! The polarisation of emitted light.

use crate::vec3::{Vec3, cross, dot, scale, sub, unit};

/// The polarisation of the light that a lamp or a sky emits, the same in all channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightPolarisation {
    /// As if the light had passed through sheets in front of the lamp.
    Axis {
        /// A direction of the world; the x axis of Stokes vectors is its part across a ray.
        axis: Vec3,
        /// S1, S2 and S3 over S0.
        stokes: [f32; 3],
    },
    /// Of a clear sky, whose light was scattered once by small particles (Rayleigh): across the plane of the sun and the
    /// ray, most at a right angle to the sun.
    Sky {
        /// A unit vector toward the sun.
        sun: Vec3,
        /// The degree of polarisation at a right angle to the sun.
        degree: f32,
    },
}

impl LightPolarisation {
    /// S1, S2 and S3 over S0 of light that travels along a unit direction, for the x axis `basis`, which is across that
    /// direction.
    pub(crate) fn along(&self, direction: Vec3, basis: Vec3) -> [f32; 3] {
        let (axis, [s1, s2, s3]) = match *self {
            LightPolarisation::Axis { axis, stokes } => {
                (unit(sub(axis, scale(direction, dot(axis, direction)))), stokes)
            }
            LightPolarisation::Sky { sun, degree } => {
                let cos = dot(sun, direction);
                let share = degree * (1.0 - cos * cos) / (1.0 + cos * cos);
                (unit(cross(sun, direction)), [share, 0.0, 0.0])
            }
        };
        // A ray along the axis has no part across it.
        let Some(axis) = axis else { return [0.0, 0.0, s3] };
        let (cos, sin) = (dot(axis, basis), dot(direction, cross(axis, basis)));
        let (cos, sin) = (cos * cos - sin * sin, 2.0 * cos * sin);
        [cos * s1 + sin * s2, cos * s2 - sin * s1, s3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f32; 3], b: [f32; 3]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
    }

    #[test]
    fn components_follow_the_basis() {
        let light = LightPolarisation::Axis { axis: [2.0, 0.0, 5.0], stokes: [0.6, 0.2, -0.3] };
        let down = [0.0, 0.0, -1.0];
        assert!(near(light.along(down, [1.0, 0.0, 0.0]), [0.6, 0.2, -0.3]));
        assert!(near(light.along(down, [0.0, 1.0, 0.0]), [-0.6, -0.2, -0.3]));
        // A basis turned by 45 degrees about the direction: S2 takes the place of S1.
        let diagonal = [0.5f32.sqrt(), -(0.5f32.sqrt()), 0.0];
        assert!(near(light.along(down, diagonal), [0.2, -0.6, -0.3]), "{:?}", light.along(down, diagonal));
        let along = LightPolarisation::Axis { axis: [0.0, 0.0, 1.0], stokes: [1.0, 0.0, 0.0] };
        assert_eq!(along.along(down, [1.0, 0.0, 0.0]), [0.0; 3]);
    }

    #[test]
    fn skies_are_polarised_across_the_sun() {
        let sky = LightPolarisation::Sky { sun: [0.0, 0.0, 1.0], degree: 0.8 };
        // At a right angle to the sun, along sun x direction.
        assert!(near(sky.along([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.8, 0.0, 0.0]));
        assert!(near(sky.along([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]), [-0.8, 0.0, 0.0]));
        assert_eq!(sky.along([0.0, 0.0, -1.0], [1.0, 0.0, 0.0]), [0.0; 3]);
        let at_60 = sky.along([0.75f32.sqrt(), 0.0, -0.5], [0.0, 1.0, 0.0]);
        assert!((at_60[0] - 0.8 * 0.75 / 1.25).abs() < 1e-6);
    }
}
