//! Specular coordinates: a pair of directions as four angles about the mirror direction.
//!
//! `sigma` is the polar angle of `wi`, `psi` its azimuth (the rotation of the sample), `theta` the angle between `wo`
//! and the *zenith* of the scattered light, and `phi` the azimuth of `wo` about that zenith. The zenith is in the plane
//! of `wi` and the normal, on the other side of the normal, at the polar angle `zenith(sigma)`, which is `sigma` itself
//! (the mirror direction) unless a BTDF has refraction offsets. `phi` is 0 from the zenith toward the normal,
//! grows right-handed about the zenith, and is `pi` toward the horizon. So `theta = 2 sigma, phi = 0` is the direction
//! back to the light. (Adinetz et al. 2005, section 2; the same axes as libbsdf's `SpecularCoordinateSystem`.)
//!
//! Transmission uses the same geometry, with the transmitted direction mirrored to the upper hemisphere.
//!
//! This is the `f64` form; directions are unit vectors, `[x, y, z]` with the normal on +z.

use std::f64::consts::{FRAC_PI_2, TAU};

/// Converts four angles to two unit vectors, `(wi, wo)`. `angles` are sigma, psi, theta and phi in radians.
///
/// `zenith` maps sigma to the polar angle of the zenith and is clamped to `[0, pi/2]`; `|sigma| sigma` for the mirror
/// direction. `wo` may be below the horizon.
pub fn angles_to_directions(angles: [f64; 4], zenith: impl Fn(f64) -> f64) -> ([f64; 3], [f64; 3]) {
    let [sigma, psi, theta, phi] = angles;
    let (sin_psi, cos_psi) = psi.sin_cos();
    let (sin_sigma, cos_sigma) = sigma.sin_cos();
    let wi = [sin_sigma * cos_psi, sin_sigma * sin_psi, cos_sigma];

    let (sin_zenith, cos_zenith) = zenith(sigma).clamp(0.0, FRAC_PI_2).sin_cos();
    let (sin_theta, cos_theta) = theta.sin_cos();
    let (sin_phi, cos_phi) = phi.sin_cos();
    let local = [sin_theta * cos_phi, sin_theta * sin_phi, cos_theta];
    let x = cos_zenith * local[0] - sin_zenith * local[2];
    let z = sin_zenith * local[0] + cos_zenith * local[2];
    let y = local[1];
    (wi, [cos_psi * x - sin_psi * y, sin_psi * x + cos_psi * y, z])
}

/// Converts two unit vectors to four angles, sigma, psi, theta and phi in radians; psi and phi are in `[0, 2 pi)`.
///
/// `zenith` as in [`angles_to_directions`]. The difference of `wo` and the zenith, not their dot product, gives theta
/// and phi, so that both keep their accuracy at the mirror peak. An undefined angle is 0: psi with `wi` at the normal,
/// phi with `wo` at the zenith or opposite to it.
pub fn directions_to_angles(wi: [f64; 3], wo: [f64; 3], zenith: impl Fn(f64) -> f64) -> [f64; 4] {
    let across = wi[0].hypot(wi[1]);
    let sigma = across.atan2(wi[2]);
    let psi = azimuth(wi[1], wi[0]);
    let (cos_psi, sin_psi) = if across > 0.0 { (wi[0] / across, wi[1] / across) } else { (1.0, 0.0) };

    let polar = zenith(sigma).clamp(0.0, FRAC_PI_2);
    // Without an offset, the components of wi are used directly, and a wo that is their exact mirror image gives theta
    // 0.
    let (sin_zenith, cos_zenith) = if polar == sigma { (across, wi[2]) } else { polar.sin_cos() };
    let axis = if polar == sigma {
        [-wi[0], -wi[1], wi[2]]
    } else {
        [-sin_zenith * cos_psi, -sin_zenith * sin_psi, cos_zenith]
    };
    let difference = [wo[0] - axis[0], wo[1] - axis[1], wo[2] - axis[2]];
    let sum = [wo[0] + axis[0], wo[1] + axis[1], wo[2] + axis[2]];
    // Half the angle between two unit vectors has the tangent |a - b| / |a + b| (Kahan): accurate from 0 to pi.
    let theta = 2.0 * length(difference).atan2(length(sum));

    // The components perpendicular to the axis are the same for wo, wo - axis and wo + axis; the shortest loses the
    // fewest digits.
    let offset = if theta < FRAC_PI_2 { difference } else { sum };
    let x = cos_psi * offset[0] + sin_psi * offset[1];
    let y = cos_psi * offset[1] - sin_psi * offset[0];
    let phi = azimuth(y, cos_zenith * x + sin_zenith * offset[2]);
    [sigma, psi, theta, phi]
}

/// `atan2(y, x)` in `[0, 2 pi)`, and 0 for the zero vector with any signs.
fn azimuth(y: f64, x: f64) -> f64 {
    if x == 0.0 && y == 0.0 {
        return 0.0;
    }
    let angle = y.atan2(x);
    let turned = if angle < 0.0 { angle + TAU } else { angle };
    // A tiny negative angle rounds up to the full circle.
    if turned < TAU { turned } else { 0.0 }
}

fn length(v: [f64; 3]) -> f64 {
    v[0].hypot(v[1]).hypot(v[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn degrees(angles: [f64; 4]) -> [f64; 4] {
        angles.map(f64::to_degrees)
    }

    fn assert_close<const N: usize>(got: [f64; N], expected: [f64; N], tolerance: f64) {
        for i in 0..N {
            assert!((got[i] - expected[i]).abs() <= tolerance, "{got:?} is not {expected:?} within {tolerance}");
        }
    }

    /// Positions of `wo` for a light at 30 degrees, computed by another implementation of these coordinates.
    #[test]
    fn phi_zero_is_toward_the_normal_and_grows_right_handed() {
        let cases = [
            ([30.0, 0.0, 20.0, 0.0], [-0.1736, 0.0, 0.9848]),
            ([30.0, 0.0, 20.0, 90.0], [-0.4698, 0.3420, 0.8138]),
            ([30.0, 0.0, 20.0, 180.0], [-0.7660, 0.0, 0.6428]),
            ([30.0, 0.0, 20.0, 270.0], [-0.4698, -0.3420, 0.8138]),
            ([30.0, 0.0, 60.0, 0.0], [0.5, 0.0, 0.8660]),
        ];
        for (angles, expected) in cases {
            let (wi, wo) = angles_to_directions(angles.map(f64::to_radians), |s| s);
            assert_close(wi, [0.5, 0.0, 0.75_f64.sqrt()], 1e-15);
            assert_close(wo, expected, 5e-5);
            assert_close(degrees(directions_to_angles(wi, wo, |s| s)), angles, 1e-13);
        }
    }

    #[test]
    fn angles_survive_a_round_trip() {
        let zeniths: [fn(f64) -> f64; 2] = [|s| s, |s| (s.sin() / 1.5).asin()];
        for zenith in zeniths {
            for sigma in [1e-3, 0.3, 1.0, 1.5, FRAC_PI_2] {
                for psi in [0.0, 1.0, PI, 4.0, 6.2] {
                    for theta in [1e-9, 1e-4, 0.5, FRAC_PI_2, 2.0, PI - 1e-3] {
                        for phi in [0.0, 0.1, 2.0, PI, 3.5, 6.2] {
                            let angles = [sigma, psi, theta, phi];
                            let (wi, wo) = angles_to_directions(angles, zenith);
                            let back = directions_to_angles(wi, wo, zenith);
                            // phi is as accurate as the rounding of the directions allows: 1e-16 over sin(theta).
                            let sharp = 1e-14 + 1e-15 / theta.sin();
                            assert!((back[0] - sigma).abs() < 1e-14 && (back[2] - theta).abs() < 1e-14);
                            for axis in [1, 3] {
                                let apart = (back[axis] - angles[axis]).abs();
                                let tolerance = if axis == 1 { 1e-12 } else { sharp };
                                assert!(apart.min(TAU - apart) < tolerance, "{angles:?} came back as {back:?}");
                            }
                        }
                    }
                }
            }
        }
    }

    /// `acos` of the dot product would give 0 or 1.5e-8 here.
    #[test]
    fn theta_is_accurate_at_the_mirror_peak() {
        let sigma: f64 = 0.7;
        let wi = [sigma.sin(), 0.0, sigma.cos()];
        for theta in [1e-12, 1e-9, 1e-6] {
            let wo = [-(sigma - theta).sin(), 0.0, (sigma - theta).cos()];
            let angles = directions_to_angles(wi, wo, |s| s);
            assert!((angles[2] - theta).abs() < 2e-16, "{theta} gave {}", angles[2]);
            assert!((angles[3]).min(TAU - angles[3]) < 1e-3);
        }
    }

    /// One unit in the last place toward +z off the mirror direction is phi 0, for light from anywhere.
    #[test]
    fn phi_is_accurate_at_the_mirror_peak() {
        for step in 1..200 {
            let (wi, _) = angles_to_directions([f64::from(step) * 0.007, f64::from(step), 0.0, 0.0], |s| s);
            let [_, _, theta, phi] = directions_to_angles(wi, [-wi[0], -wi[1], wi[2].next_up()], |s| s);
            assert!(theta > 0.0 && theta < 2e-16 && phi.min(TAU - phi) < 1e-9, "theta {theta}, phi {phi} at {wi:?}");
        }
    }

    #[test]
    fn undefined_angles_are_zero() {
        let up = [-0.0, 0.0, 1.0];
        assert_eq!(directions_to_angles(up, up, |s| s), [0.0; 4]);
        let slant: f64 = 0.6;
        let wi = [0.0, slant.sin(), slant.cos()];
        let mirror = [0.0, -slant.sin(), slant.cos()];
        let [_, psi, theta, phi] = directions_to_angles(wi, mirror, |s| s);
        assert_eq!((psi, theta, phi), (FRAC_PI_2, 0.0, 0.0));
        let [_, _, theta, phi] = directions_to_angles(wi, mirror.map(|c| -c), |s| s);
        assert_eq!((theta, phi), (PI, 0.0));
        // An angle just below zero must not become the full circle.
        let [_, psi, ..] = directions_to_angles([1.0, -1e-20, 0.0], [0.0, 0.0, 1.0], |s| s);
        assert_eq!(psi, 0.0);
    }
}
