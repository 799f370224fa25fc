//! The evaluation of [`Data`] one query at a time in `f64`: what the lanes are compared with.

use std::f64::consts::TAU;

use super::Data;
use crate::direction::phi;
use crate::grid::neighbours::{Neighbours, corners};
use crate::{Edge, Scatter};

impl Data {
    /// The channels of `f` in 1/sr for light from `wi` to `wo`, unit vectors that point away from the surface:
    /// multilinear in the angles. Polar angles beyond the knots are held, azimuths go round.
    ///
    /// Zero for directions that graze the surface, for two sides of a BRDF, and for one side of a BTDF. The two sides of
    /// the surface are taken to be alike.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f64> {
        let mut out = vec![0.0; self.channels().count()];
        self.eval_into(wi, wo, &mut out);
        out
    }

    /// As [`eval`](Self::eval), into `out`, one value per channel.
    ///
    /// # Panics
    /// If `out` is not as long as there are channels.
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

    /// The angle that is looked up among `phi_o`: the azimuth of `wo`, turned with `wi` if the material is isotropic. The
    /// unsigned angle between both azimuths, if the grid is one half.
    fn azimuth(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        if self.is_mirrored() {
            let between = (phi(wo) - phi(wi)).rem_euclid(TAU);
            return between.min(TAU - between);
        }
        let turn = if self.is_isotropic() { phi(wi) - self.knots()[1][0] } else { 0.0 };
        phi(wo) - turn
    }
}

/// The angle from the normal, on either side of the surface.
fn polar([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(y).atan2(z.abs())
}

/// The place among azimuths, which go round.
fn circular(knots: &[f64], azimuth: f64) -> Neighbours {
    Neighbours::find(knots, Edge::Periodic, azimuth).unwrap_or(Neighbours::ONLY)
}
