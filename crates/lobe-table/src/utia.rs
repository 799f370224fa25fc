//! Anisotropic materials on the uniform grid of the UTIA database.
//!
//! Filip and Vavra, "Template-Based Sampling of Anisotropic BRDFs", Computer Graphics Forum 33(7), 2014: zenith angles
//! of 0, 15, ... 75 degrees and azimuths of 0, 7.5, ... 352.5 degrees for both directions.

use crate::direction::{phi, theta, wrap};
use crate::invalid::{Invalid, count};

/// How many zenith angles each direction has.
pub const THETAS: usize = 6;
/// How many azimuths each direction has.
pub const PHIS: usize = 48;
/// The values of one channel.
pub const PLANE: usize = THETAS * PHIS * THETAS * PHIS;

/// A material of the UTIA database.
///
/// The unit of the stored values is not documented, and the programs that read them disagree; see [`Decode`].
#[derive(Clone, Debug, PartialEq)]
pub struct Utia {
    values: Vec<f64>,
}

/// What to make of the stored values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Decode {
    /// The stored values, interpolated.
    #[default]
    Raw,
    /// The reading of Dupuy's BRDF library: negative values become zero and all are divided by 140; after the
    /// interpolation the sRGB curve, with its threshold at 0.0375, is undone and the result multiplied by 100.
    Srgb,
}

impl Utia {
    /// Checks that there are `[channel][theta_i][phi_i][theta_v][phi_v]` values, 3 x 6 x 48 x 6 x 48, all finite.
    ///
    /// # Errors
    /// [`Invalid`] names `values`.
    pub fn new(values: Vec<f64>) -> Result<Self, Invalid> {
        count("values", values.len(), &[3, THETAS, PHIS, THETAS, PHIS])?;
        match values.iter().position(|v| !v.is_finite()) {
            Some(at) => Err(Invalid::new("values", format!("{} at index {at}", values[at]), "finite numbers")),
            None => Ok(Utia { values }),
        }
    }

    /// All values as stored: `[channel][theta_i][phi_i][theta_v][phi_v]`.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The value for light from `wi` seen from `wo`; 0 where a direction is below the surface.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3], decode: Decode) -> [f64; 3] {
        self.eval_angles([theta(wi), phi(wi)], [theta(wo), phi(wo)], decode)
    }

    /// The value at zenith angles and azimuths `[theta, phi]` in radians.
    ///
    /// Linear in all four, with azimuths that wrap. Between 75 and 90 degrees the value continues the line through 60
    /// and 75 degrees, as the reader of the database does; beyond 90 it is 0.
    pub fn eval_angles(&self, incident: [f64; 2], view: [f64; 2], decode: Decode) -> [f64; 3] {
        let quarter = std::f64::consts::FRAC_PI_2;
        if incident[0] > quarter || view[0] > quarter {
            return [0.0; 3];
        }
        let cells = [zenith(incident[0]), azimuth(incident[1]), zenith(view[0]), azimuth(view[1])];
        let mut sum = [0.0; 3];
        for corner in 0..16 {
            let (mut at, mut weight) = (0, 1.0);
            for (axis, (size, (index, t))) in [THETAS, PHIS, THETAS, PHIS].into_iter().zip(cells).enumerate() {
                let upper = corner >> axis & 1;
                at = at * size + (index + upper) % size;
                weight *= if upper == 1 { t } else { 1.0 - t };
            }
            for (channel, sum) in sum.iter_mut().enumerate() {
                let value = self.values[channel * PLANE + at];
                *sum += weight * if decode == Decode::Raw { value } else { value.max(0.0) / 140.0 };
            }
        }
        match decode {
            Decode::Raw => sum,
            Decode::Srgb => sum.map(|v| 100.0 * if v > 0.0375 { ((v + 0.055) / 1.055).powf(2.4) } else { v / 12.92 }),
        }
    }
}

/// The cell among the zenith angles, clamped, and the place in it, which is not.
fn zenith(theta: f64) -> (usize, f64) {
    let x = theta.to_degrees() / 15.0;
    let index = (x as usize).min(THETAS - 2);
    (index, x - index as f64)
}

/// The cell among the azimuths, and the place in it.
fn azimuth(phi: f64) -> (usize, f64) {
    let x = wrap(phi).to_degrees() / 7.5;
    let index = (x as usize).min(PHIS - 1);
    (index, x - index as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The value is `theta_i + 10 theta_v` in degrees, plus 1000 for each step of `phi_v`.
    fn material() -> Utia {
        let value = |i: usize| {
            let (ti, tv, pv) = (i / (PHIS * THETAS * PHIS) % THETAS, i / PHIS % THETAS, i % PHIS);
            15.0 * ti as f64 + 150.0 * tv as f64 + 1000.0 * pv as f64
        };
        Utia::new((0..3 * PLANE).map(value).collect()).expect("a valid table")
    }

    #[test]
    fn zenith_angles_go_on_beyond_the_last_and_end_at_the_horizon() {
        let value =
            |ti: f64, tv: f64| material().eval_angles([ti.to_radians(), 1.0], [tv.to_radians(), 0.0], Decode::Raw)[0];
        assert!((value(20.0, 31.0) - 330.0).abs() < 1e-9);
        assert!((value(85.0, 89.0) - 975.0).abs() < 1e-9);
        assert_eq!(value(20.0, 90.1), 0.0);
    }

    #[test]
    fn azimuths_wrap() {
        let value = |phi: f64| material().eval_angles([0.0, 0.0], [0.0, phi.to_radians()], Decode::Raw)[1];
        assert!((value(355.0) - value(-5.0)).abs() < 1e-6);
        // Between the last azimuth, 352.5 degrees, and the first.
        assert!((value(356.25) - 0.5 * (47_000.0 + 0.0)).abs() < 1e-6);
        assert!(value(360.0).abs() < 1e-6 && value(-1e-300) == value(0.0));
    }

    #[test]
    fn decoding_undoes_the_curve() {
        let flat = |v: f64| {
            Utia::new(vec![v; 3 * PLANE]).expect("valid").eval([0.0, 0.6, 0.8], [0.0, 0.0, 1.0], Decode::Srgb)[2]
        };
        assert!((flat(140.0) - 100.0).abs() < 1e-9);
        assert!((flat(1.4) - 100.0 * 0.01 / 12.92).abs() < 1e-9);
        assert_eq!(flat(-5.0), 0.0);
    }

    #[test]
    fn directions_are_angles() {
        let (sin, cos) = 0.5f64.sin_cos();
        let (a, b) = (material().eval([sin, 0.0, cos], [0.0, sin, cos], Decode::Raw), std::f64::consts::FRAC_PI_2);
        let expected = material().eval_angles([0.5, 0.0], [0.5, b], Decode::Raw);
        assert!((a[0] - expected[0]).abs() < 1e-9);
        assert!(Utia::new(vec![0.0; 7]).is_err() && Utia::new(vec![f64::NAN; 3 * PLANE]).is_err());
    }
}
