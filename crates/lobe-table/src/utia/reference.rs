//! The evaluation of [`Data`] one query at a time in `f64`: what the lanes are compared with.

use super::{Data, Decode, PHIS, PLANE, SCALE, STEPS, THETAS};
use crate::direction::{phi, theta, wrap};
use crate::passes::unit::SPHERICAL;
use crate::passes::weights::SUM;

impl Data {
    /// The value for light from `wi` seen from `wo`; 0 where a direction is not above the surface.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3], decode: Decode) -> [f64; 3] {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return [0.0; 3];
        }
        // Rounding may put a direction that is just above the horizon just beyond a quarter turn.
        let angles = |w: [f64; 3]| [theta(w).min(std::f64::consts::FRAC_PI_2), phi(w)];
        self.eval_angles(angles(wi), angles(wo), decode)
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
                *sum += weight * if decode == Decode::Raw { value } else { value.max(0.0) / SCALE };
            }
        }
        match decode {
            Decode::Raw => sum,
            Decode::Srgb => sum.map(|v| 100.0 * if v > 0.0375 { ((v + 0.055) / 1.055).powf(2.4) } else { v / 12.92 }),
        }
    }

    /// How far a [raw](Decode::Raw) value may be off in the lanes of a [`Table`](crate::utia::Table), in parts of the largest
    /// one.
    pub fn bound(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        // Beyond the last zenith angle the sizes of the two weights of the line that goes on add up to more than 1.
        let stretch = |w: [f64; 3]| 1.0 + 2.0 * (zenith(theta(w)).1 - 1.0).max(0.0);
        let cells = STEPS.iter().map(|step| 2.0 * SPHERICAL / step.to_radians());
        (cells.sum::<f64>() + SUM) * stretch(wi) * stretch(wo)
    }
}

/// The cell among the zenith angles, clamped, and the place in it, which is not.
fn zenith(theta: f64) -> (usize, f64) {
    let x = theta.to_degrees() / STEPS[0];
    let index = (x as usize).min(THETAS - 2);
    (index, x - index as f64)
}

/// The cell among the azimuths, and the place in it.
fn azimuth(phi: f64) -> (usize, f64) {
    let x = wrap(phi).to_degrees() / STEPS[1];
    let index = (x as usize).min(PHIS - 1);
    (index, x - index as f64)
}
