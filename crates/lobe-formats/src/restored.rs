//! Angles of samples, written such that readers restore them bit for bit.
//!
//! Which of two equally good triangles a query is in depends on the last digit of an angle, so samples are interpolated
//! as before only if none of their angles changes.

use std::f64::consts::TAU;

use crate::angle::{Unit, exact_degrees};

/// The number of neighbours of a number that are tried.
const ULPS: usize = 40;

/// The angles of a file, as its reader converts them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Written {
    /// The unit of the angles.
    pub unit: Unit,
    /// What readers add to the azimuth of the light, in radians, after the conversion from the unit.
    pub turn: f64,
}

impl Written {
    /// The angles to write for `theta_i`, `phi_i`, `theta_o` and the azimuth of the viewer relative to that of the light,
    /// all in radians, with few digits; `None` if no angles are found from which a reader restores all bits.
    pub(crate) fn restoring(self, [theta_i, phi_i, theta_o, relative]: [f64; 4]) -> Option<[f64; 4]> {
        let to_radians = self.unit.radians();
        let (theta_i, theta_o) = (self.exact(theta_i)?, self.exact(theta_o)?);
        let light = self.exact_or_near(phi_i - self.turn, |written| written * to_radians + self.turn == phi_i)?;
        let is_restored = |phi_o: f64| (phi_o * to_radians - phi_i).rem_euclid(TAU).to_bits() == relative.to_bits();
        let viewer = outgoing(phi_i, relative).flat_map(|near| self.candidates(near)).find(|phi_o| is_restored(*phi_o));
        viewer.map(|phi_o| [theta_i, light, theta_o, phi_o])
    }

    /// The number for a polar angle, of which nothing is subtracted.
    fn exact(self, radians: f64) -> Option<f64> {
        match self.unit {
            Unit::Deg => exact_degrees(radians),
            unit => Some(radians / unit.radians()).filter(|written| written * unit.radians() == radians),
        }
    }

    fn exact_or_near(self, radians: f64, is_restored: impl Fn(f64) -> bool) -> Option<f64> {
        neighbours(radians).flat_map(|near| self.candidates(near)).find(|written| is_restored(*written))
    }

    /// Numbers of the unit that may be converted to these radians, those with few digits first.
    fn candidates(self, radians: f64) -> impl Iterator<Item = f64> {
        let near = radians / self.unit.radians();
        let written = match self.unit {
            Unit::Deg => {
                let near = radians.to_degrees();
                [(near * 1e9).round() / 1e9, near, near.next_up(), near.next_down()]
            }
            _ => [near, near, near.next_up(), near.next_down()],
        };
        written.into_iter()
    }
}

/// A number and those next to it, nearest first on each side.
fn neighbours(x: f64) -> impl Iterator<Item = f64> {
    let up = std::iter::successors(Some(x), |x| Some(x.next_up())).take(ULPS);
    let down = std::iter::successors(Some(x.next_down()), |x| Some(x.next_down())).take(ULPS);
    up.chain(down)
}

/// The outgoing azimuths from which a reader may have computed this difference to the incident one.
fn outgoing(phi_i: f64, relative: f64) -> impl Iterator<Item = f64> {
    let phi_o = phi_i + relative;
    // Subtracting a turn left the rounding of a larger number.
    [phi_o, phi_o - TAU, phi_o - 2.0 * TAU].into_iter().flat_map(neighbours).chain([0.0])
}
