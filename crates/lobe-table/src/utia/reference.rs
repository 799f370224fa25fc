//! The evaluation of [`Data`] one query at a time in `f64`: the reference for the lanes.

use super::data::{Data, Decode, PHIS, PLANE, SCALE, STEPS, THETAS};
use crate::direction::{phi, theta, wrap};
use crate::grid::neighbours::{Neighbours, corners};
use crate::grid::weights::SUM;
use crate::passes::unit::SPHERICAL;

impl Data {
    /// The value for light from `wi` seen from `wo`; 0 if a direction is not above the surface.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3], decode: Decode) -> [f64; 3] {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return [0.0; 3];
        }
        // Rounding may move a direction just above the horizon beyond a quarter turn.
        let angles = |w: [f64; 3]| [theta(w).min(std::f64::consts::FRAC_PI_2), phi(w)];
        self.eval_angles(angles(wi), angles(wo), decode)
    }

    /// The value at zenith angles and azimuths `[theta, phi]` in radians.
    ///
    /// Linear in all four, with azimuths that wrap. Between 75 and 90 degrees, the value continues the line through 60
    /// and 75 degrees, as in the reader of the database; beyond 90 it is 0.
    pub fn eval_angles(&self, incident: [f64; 2], view: [f64; 2], decode: Decode) -> [f64; 3] {
        let quarter = std::f64::consts::FRAC_PI_2;
        if incident[0] > quarter || view[0] > quarter {
            return [0.0; 3];
        }
        let cell = [zenith(incident[0]), azimuth(incident[1]), zenith(view[0]), azimuth(view[1])];
        let mut sum = [0.0; 3];
        corners(&cell, |[theta_i, phi_i, theta_v, phi_v], weight| {
            let at = ((theta_i * PHIS + phi_i) * THETAS + theta_v) * PHIS + phi_v;
            for (channel, sum) in sum.iter_mut().enumerate() {
                let value = self.values[channel * PLANE + at];
                *sum += weight * if decode == Decode::Raw { value } else { value.max(0.0) / SCALE };
            }
        });
        match decode {
            Decode::Raw => sum,
            Decode::Srgb => sum.map(|v| 100.0 * if v > 0.0375 { ((v + 0.055) / 1.055).powf(2.4) } else { v / 12.92 }),
        }
    }

    /// The largest error of a [raw](Decode::Raw) value in the lanes of a [`Table`](crate::utia::Table), relative to the
    /// largest value.
    pub fn bound(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        // Beyond the last zenith angle, the magnitudes of the two extrapolation weights add up to more than 1.
        let stretch = |w: [f64; 3]| 1.0 + 2.0 * (zenith(theta(w)).weights[1] - 1.0).max(0.0);
        let cells = STEPS.iter().map(|step| 2.0 * SPHERICAL / step.to_radians());
        (cells.sum::<f64>() + SUM) * stretch(wi) * stretch(wo)
    }
}

/// The place among the zenith angles, whose last cell is extrapolated.
fn zenith(theta: f64) -> Neighbours {
    uniform(theta.to_degrees() / STEPS[0], THETAS - 2)
}

/// The place among the azimuths, which are periodic.
fn azimuth(phi: f64) -> Neighbours {
    let Neighbours { nodes: [lower, upper], weights } = uniform(wrap(phi).to_degrees() / STEPS[1], PHIS - 1);
    Neighbours { nodes: [lower, upper % PHIS], weights }
}

/// The cell of a place in steps, at most `last`.
fn uniform(at: f64, last: usize) -> Neighbours {
    let index = (at as usize).min(last);
    let fraction = at - index as f64;
    Neighbours { nodes: [index, index + 1], weights: [1.0 - fraction, fraction] }
}
