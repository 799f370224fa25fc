//! The evaluation of a [`KlemsMatrix`] one query at a time in `f64`: the reference for the lanes.

use super::matrix::{AngleBasis, KlemsMatrix, SAME_BOUND};
use crate::direction::phi;
use crate::passes::unit::SPHERICAL;

impl AngleBasis {
    /// The patch that holds the unit vector `direction`, whose z must not be negative; `None` beyond the last ring.
    ///
    /// Neighbouring patches meet without a gap, so a change in the last bit of a direction on a bound changes its
    /// patch.
    pub fn patch(&self, direction: [f64; 3]) -> Option<usize> {
        let [x, y, z] = direction;
        let theta = z.clamp(-1.0, 1.0).acos().to_degrees();
        let mut first = 0;
        for (index, ring) in self.rings.iter().enumerate() {
            let is_horizon = index + 1 == self.rings.len() && ring.upper >= 90.0 - SAME_BOUND;
            if theta < ring.upper || (is_horizon && theta <= 90.0) {
                let turn = phi([x, y, z]).to_degrees().rem_euclid(360.0) / 360.0;
                let sector = (turn * f64::from(ring.patches) + 0.5) as usize;
                return Some(first + sector % ring.patches as usize);
            }
            first += ring.patches as usize;
        }
        None
    }

    /// All patches that may contain a direction in the lanes: its patch and, if it is within rounding of the border of
    /// another patch, that one too.
    fn candidates(&self, [x, y, z]: [f64; 3]) -> Vec<Option<usize>> {
        let (theta, phi) = (x.hypot(y).atan2(z), y.atan2(x));
        let mut found = Vec::new();
        for theta in [theta, (theta - SPHERICAL).max(0.0), theta + SPHERICAL] {
            for phi in [phi, phi - SPHERICAL, phi + SPHERICAL] {
                let direction = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos().max(0.0)];
                let patch = self.patch(direction);
                if !found.contains(&patch) {
                    found.push(patch);
                }
            }
        }
        found
    }
}

impl KlemsMatrix {
    /// The value for light from `wi` to `wo`, unit vectors that point away from the surface, each on either side.
    /// Zero if a direction is beyond the last ring of its basis.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        let incident = self.incident.patch([-wi[0], -wi[1], wi[2].abs()]);
        let exit = self.exit.patch([wo[0], wo[1], wo[2].abs()]);
        match (incident, exit) {
            (Some(incident), Some(exit)) => f64::from(self.values[incident * self.exit.patches + exit]),
            _ => 0.0,
        }
    }

    /// All values that [`eval`](Self::eval) may have in the lanes: that of the patches and, if a direction is within
    /// rounding of another patch, those of that patch too.
    pub fn candidates(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f64> {
        let exits = self.exit.candidates([wo[0], wo[1], wo[2].abs()]);
        let value = |incident: Option<usize>, exit: Option<usize>| match (incident, exit) {
            (Some(incident), Some(exit)) => f64::from(self.values[incident * self.exit.patches + exit]),
            _ => 0.0,
        };
        let incidents = self.incident.candidates([-wi[0], -wi[1], wi[2].abs()]);
        incidents.into_iter().flat_map(|incident| exits.iter().map(move |&exit| value(incident, exit))).collect()
    }
}
