//! Resampling of any material into a table in specular coordinates.
//!
//! Nothing else in lobe resamples: a file is evaluated on its own grid. This is for programs that need another grid,
//! and it always reports the error of the table.

mod error;
mod knots;

pub use error::{Resampling, error};
pub use knots::{Bound, Chosen, Knots, PROBES, candidates, choose};

use lobe_model::goniometer::lift;
use lobe_table::specular::coords::angles_to_directions;
use lobe_table::{GridError, specular};

use crate::pairs::eval_pairs;
use crate::{Aspect, OnBackend};

/// Measures a material at every node of `knots`: sigma, psi, theta and phi in radians, as in [`specular::Data`].
/// `progress` is called from time to time with the finished share.
///
/// A node below 3.4 degrees of elevation takes the value at the same azimuth slightly higher (see [`lift`]): below the
/// horizon there is no value, but a table needs one there for interpolation near the horizon.
///
/// # Errors
/// [`GridError`] if the knots do not form a table, or a value of the material is not finite.
pub fn measure<'a>(
    scattering: impl Into<OnBackend<'a>>,
    aspect: Aspect,
    knots: [Vec<f64>; 4],
    progress: impl Fn(f64),
) -> Result<specular::Data, GridError> {
    let scattering = scattering.into();
    let [sigmas, psis, thetas, phis] = &knots;
    let mut values = Vec::new();
    for (index, &sigma) in sigmas.iter().enumerate() {
        for &psi in psis {
            let node = |&theta: &f64, &phi: &f64| pair(aspect, [sigma, psi, theta, phi]);
            let pairs: Vec<_> = thetas.iter().flat_map(|theta| phis.iter().map(move |phi| node(theta, phi))).collect();
            values.extend(eval_pairs(scattering, &pairs));
        }
        progress((index + 1) as f64 / sigmas.len() as f64);
    }
    specular::Data::new(aspect.scatter, knots, scattering.channels().clone(), values)
}

/// The directions at which the value of a node is measured.
fn pair(aspect: Aspect, angles: [f64; 4]) -> ([f64; 3], [f64; 3]) {
    let (wi, wo) = angles_to_directions(angles, |sigma| sigma);
    aspect.place(lift(wi), lift(wo))
}
