//! Measurements on a grid of ordinary spherical coordinates of both directions.

mod representation;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub use representation::KIND;

use crate::scattered::ANGLE_NAMES;
use crate::{Channels, GridError, Scatter};

/// A BRDF or BTDF on a grid of `theta_i`, `phi_i`, `theta_o`, `phi_o`, in radians.
///
/// Polar angles are in `[0, pi/2]`, from the normal on the side of their direction; azimuths in `[0, 2 pi]`; all strictly
/// ascending. A grid with one `phi_i` is isotropic: only the difference of the azimuths counts. Values are `f` in 1/sr,
/// without the cosine, `[theta_i][phi_i][theta_o][phi_o][channel]`.
///
/// It is evaluated in `f64`, a pair at a time, and has no form in lanes: the files are small, most are one of the several
/// measurements of a sheet, among which the sides of each pair choose, and what is to be fast is resampled into a
/// [`Table`](crate::specular::Table), whose coordinates follow the peak.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    scatter: Scatter,
    knots: [Vec<f64>; 4],
    channels: Channels,
    values: Vec<f32>,
    is_mirrored: bool,
}

const ROUNDING: f64 = 1e-5;

impl Data {
    /// Checks knots and values and keeps them.
    ///
    /// # Errors
    /// [`GridError`] names the axis, the position, what was found and what was expected.
    pub fn new(
        scatter: Scatter,
        knots: [Vec<f64>; 4],
        channels: Channels,
        values: Vec<f32>,
    ) -> Result<Self, GridError> {
        let mut expected = channels.count();
        if expected == 0 {
            return Err(GridError::Channels("no channels; expected at least one".into()));
        }
        for (of_axis, axis) in knots.iter().zip(ANGLE_NAMES) {
            let limit = if axis.starts_with("theta") { FRAC_PI_2 } else { TAU };
            if of_axis.is_empty() {
                return Err(GridError::NoKnots { axis });
            }
            for (index, &value) in of_axis.iter().enumerate() {
                if !value.is_finite() {
                    return Err(GridError::KnotNotFinite { axis, index, value });
                }
                if !(-ROUNDING..=limit + ROUNDING).contains(&value) {
                    return Err(GridError::KnotOutOfRange { axis, index, value, limit });
                }
                if index > 0 && value as f32 <= of_axis[index - 1] as f32 {
                    return Err(GridError::KnotsNotAscending { axis, index, previous: of_axis[index - 1], value });
                }
            }
            expected = expected.checked_mul(of_axis.len()).ok_or(GridError::TooLarge)?;
        }
        if values.len() != expected {
            return Err(GridError::ValueCount { found: values.len(), expected });
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(GridError::ValueNotFinite { index, value: values[index] });
        }
        Ok(Data { scatter, knots, channels, values, is_mirrored: false })
    }

    /// Takes the grid for one half of an isotropic material whose other half, across the plane of incidence, is its
    /// mirror image. `phi_o` then is the angle between the azimuths, held beyond its knots.
    ///
    /// # Errors
    /// [`GridError::KnotOutOfRange`] where there is a second `phi_i`, or a `phi_o` beyond half a turn.
    pub fn mirrored(self) -> Result<Self, GridError> {
        for (axis, limit, least) in [(1, 0.0, 1), (3, PI, 0)] {
            let beyond = self.knots[axis].iter().enumerate().skip(least).find(|(_, knot)| **knot > limit + ROUNDING);
            if let Some((index, &value)) = beyond {
                return Err(GridError::KnotOutOfRange { axis: ANGLE_NAMES[axis], index, value, limit });
            }
        }
        Ok(Data { is_mirrored: true, ..self })
    }

    /// `true` where the grid is one half of a material, see [`mirrored`](Self::mirrored).
    pub fn is_mirrored(&self) -> bool {
        self.is_mirrored
    }

    /// Reflection or transmission.
    pub fn scatter(&self) -> Scatter {
        self.scatter
    }

    /// The knots of `theta_i`, `phi_i`, `theta_o` and `phi_o`, in radians.
    pub fn knots(&self) -> &[Vec<f64>; 4] {
        &self.knots
    }

    /// What the channels stand for.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// All values, in 1/sr, `[theta_i][phi_i][theta_o][phi_o][channel]`.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// `true` where the value depends on the difference of the azimuths only.
    pub fn is_isotropic(&self) -> bool {
        self.knots[1].len() == 1
    }

    /// The channels of `f` in 1/sr for light from `wi` to `wo`, unit vectors that point away from the surface:
    /// multilinear in the angles. Polar angles beyond the knots are held, azimuths go round.
    ///
    /// Zero for directions that graze the surface, for two sides of a BRDF, and for one side of a BTDF. The two sides of
    /// the surface are taken for alike.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f32> {
        let count = self.channels.count();
        let (mut sum, mut out) = (vec![0.0; count], vec![0.0; count]);
        self.eval_into(wi, wo, &mut sum, &mut out);
        out
    }

    /// As [`eval`](Self::eval), into `out`; `sum` holds the channels while they are added up. Many pairs share both.
    ///
    /// # Panics
    /// Where one of the two is shorter than there are channels.
    pub fn eval_into(&self, wi: [f64; 3], wo: [f64; 3], sum: &mut [f64], out: &mut [f32]) {
        let count = self.channels.count();
        let (sum, out) = (&mut sum[..count], &mut out[..count]);
        sum.fill(0.0);
        let sides = wi[2] * wo[2];
        let is_measured = match self.scatter {
            Scatter::Reflection => sides > 0.0,
            Scatter::Transmission => sides < 0.0,
        };
        if !is_measured {
            return out.fill(0.0);
        }
        let polar = |[x, y, z]: [f64; 3]| x.hypot(y).atan2(z.abs());
        let azimuth = |[x, y, _]: [f64; 3]| y.atan2(x);
        let turn = match () {
            () if self.is_mirrored => azimuth(wi),
            () if self.is_isotropic() => azimuth(wi) - self.knots[1][0],
            () => 0.0,
        };
        let cells = [
            held(&self.knots[0], polar(wi)),
            periodic(&self.knots[1], azimuth(wi)),
            held(&self.knots[2], polar(wo)),
            match (azimuth(wo) - turn).rem_euclid(TAU) {
                between if self.is_mirrored => held(&self.knots[3], between.min(TAU - between)),
                azimuth => periodic(&self.knots[3], azimuth),
            },
        ];
        for corner in 0..16_usize {
            let (mut at, mut weight) = (0, 1.0);
            for (axis, [lower, upper]) in cells.iter().enumerate() {
                let (index, share) = if corner >> axis & 1 == 0 { lower } else { upper };
                at = at * self.knots[axis].len() + index;
                weight *= share;
            }
            let values = &self.values[at * count..][..count];
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * f64::from(*value));
        }
        out.iter_mut().zip(sum).for_each(|(out, value)| *out = *value as f32);
    }
}

/// The two knots around an angle, and their weights.
type Cell = [(usize, f64); 2];

fn held(knots: &[f64], x: f64) -> Cell {
    let upper = knots.partition_point(|&knot| knot <= x);
    if upper == 0 || upper == knots.len() {
        let nearest = upper.min(knots.len() - 1);
        return [(nearest, 1.0), (nearest, 0.0)];
    }
    let t = (x - knots[upper - 1]) / (knots[upper] - knots[upper - 1]);
    [(upper - 1, 1.0 - t), (upper, t)]
}

fn periodic(knots: &[f64], x: f64) -> Cell {
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let x = first + (x - first).rem_euclid(TAU);
    let gap = first + TAU - last;
    if x < last || knots.len() == 1 || gap <= ROUNDING {
        return held(knots, x);
    }
    let t = ((x - last) / gap).clamp(0.0, 1.0);
    [(knots.len() - 1, 1.0 - t), (0, t)]
}
