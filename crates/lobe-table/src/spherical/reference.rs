//! The evaluation of [`Data`] one query at a time in `f64`: the reference for the lanes.

use std::f64::consts::TAU;

use super::data::Data;
use crate::direction::phi;
use crate::grid::edges::ROUNDING;
use crate::grid::neighbours::{Neighbours, corners};
use crate::grid::weights::SUM;
use crate::passes::unit::{POLE, SPHERICAL};
use crate::{Edge, Scatter};

impl Data {
    /// The channels of `f` in 1/sr for light from `wi` to `wo`, unit vectors that point away from the surface:
    /// multilinear in the angles. Values are constant beyond the knots of polar angles, and azimuths are periodic.
    ///
    /// Zero for directions that graze the surface, for directions on opposite sides of a BRDF, and on the same side of
    /// a BTDF. The two sides of the surface are assumed to be alike.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f64> {
        let mut out = vec![0.0; self.channels().count()];
        self.eval_into(wi, wo, &mut out);
        out
    }

    /// Like [`eval`](Self::eval), into `out`, one value per channel.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    pub fn eval_into(&self, wi: [f64; 3], wo: [f64; 3], out: &mut [f64]) {
        let channels = self.channels().count();
        assert_eq!(out.len(), channels, "one output per channel");
        out.fill(0.0);
        let sides = wi[2] * wo[2];
        let is_measured = match self.scatter() {
            Scatter::Reflection => sides > 0.0,
            Scatter::Transmission => sides < 0.0,
        };
        if !is_measured {
            return;
        }
        let knots = self.knots();
        let cell = [
            Neighbours::held(&knots[0], polar(wi)),
            circular(&knots[1], phi(wi)),
            Neighbours::held(&knots[2], polar(wo)),
            match self.azimuth(wi, wo) {
                between if self.is_mirrored() => Neighbours::held(&knots[3], between),
                azimuth => circular(&knots[3], azimuth),
            },
        ];
        corners(&cell, |node, weight| {
            let at = node.iter().zip(knots).fold(0, |at, (node, knots)| at * knots.len() + node);
            for (sum, value) in out.iter_mut().zip(&self.values()[at * channels..]) {
                *sum += weight * f64::from(*value);
            }
        });
    }

    /// The largest error of a value in the lanes of a [`Table`](super::Table), relative to the largest magnitude.
    pub fn bound(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        // Near the pole, lanes set the azimuth to 0. Knots of a full circle may have different values at both ends.
        let at_pole = |[x, y, _]: [f64; 3]| (f64::MIN_POSITIVE..2.0 * f64::from(POLE)).contains(&x.hypot(y));
        let at_seam = |knots: &[f64], azimuth: f64| {
            let from_seam = (azimuth - knots[0]).rem_euclid(TAU);
            knots.len() > 1 && seam(knots) <= ROUNDING && from_seam.min(TAU - from_seam) <= 2.0 * AZIMUTH + ROUNDING
        };
        let seams = (!self.is_mirrored() && at_seam(&self.knots()[3], self.azimuth(wi, wo)))
            || at_seam(&self.knots()[1], phi(wi));
        if at_pole(wi) || at_pole(wo) || seams {
            return 2.0;
        }
        let errors = [SPHERICAL, AZIMUTH, SPHERICAL, AZIMUTH];
        let slopes = self.knots().iter().zip(errors).map(|(knots, error)| error / narrowest(knots));
        // Two neighbours of opposite signs differ by twice the largest magnitude.
        (2.0 * slopes.sum::<f64>() + SUM).min(2.0)
    }

    /// The angle that is looked up among `phi_o`: the azimuth of `wo`, relative to `wi` if the material is isotropic;
    /// the unsigned angle between both azimuths if the grid is one half.
    fn azimuth(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        if self.is_mirrored() {
            let between = (phi(wo) - phi(wi)).rem_euclid(TAU);
            return between.min(TAU - between);
        }
        let turn = if self.is_isotropic() { phi(wi) - self.knots()[1][0] } else { 0.0 };
        phi(wo) - turn
    }
}

/// The largest error of azimuths in lanes: those of two directions, and of a knot rounded to `f32`.
const AZIMUTH: f64 = 2.0 * SPHERICAL;

/// The gap between the last azimuth and the first one, a turn later.
fn seam(knots: &[f64]) -> f64 {
    knots[0] + TAU - knots[knots.len() - 1]
}

/// The width of the narrowest cell, including the one across the seam.
fn narrowest(knots: &[f64]) -> f64 {
    let widths = knots.windows(2).map(|ends| ends[1] - ends[0]);
    widths.chain(Some(seam(knots)).filter(|seam| *seam > ROUNDING)).fold(f64::INFINITY, f64::min)
}

/// The angle from the normal, on either side of the surface.
fn polar([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(y).atan2(z.abs())
}

/// The place among azimuths, which are periodic.
fn circular(knots: &[f64], azimuth: f64) -> Neighbours {
    Neighbours::find(knots, Edge::Periodic, azimuth).unwrap_or(Neighbours::ONLY)
}
