//! Curves in the plane of incidence.

use lobe::Scatter;

use crate::evaluate::{Progress, evaluate};
use crate::geometry::{in_plane, incident};
use crate::subject::Subject;
use crate::view::View;

/// The values in the plane of incidence for one incidence.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The polar angle of the light in radians.
    pub sigma: f64,
    /// Reflection or transmission.
    pub scatter: Scatter,
    /// The viewing angle in radians, ascending, as in [`in_plane`](crate::in_plane()).
    pub theta: Vec<f64>,
    /// The quantity of the view at each angle, in 1/sr.
    pub f: Vec<f32>,
    /// Whether each value lies within the measurement, rather than in its continuation.
    pub is_measured: Vec<bool>,
}

/// Steps of the viewing angle in degrees: everywhere, and within [`NEAR`] of the mirror direction and of the light.
const STEP: f64 = 0.1;
const FINE: f64 = 0.02;
const NEAR: f64 = 2.0;
/// The last viewing angle in degrees. At the horizon there is no value.
const LAST: f64 = 89.9;
/// More curves than this cannot be distinguished.
pub(crate) const MOST: usize = 8;

/// The curves of a view: one per incidence, reflection before transmission.
pub fn curves(subject: &Subject, view: &View, progress: &dyn Progress) -> Vec<Curve> {
    let scatters = subject.scatters(view.side);
    let sigmas = view.incidences(subject, MOST);
    let plan: Vec<(Scatter, f64, Vec<f64>)> =
        scatters.iter().flat_map(|&scatter| sigmas.iter().map(move |&sigma| (scatter, sigma, angles(sigma)))).collect();
    progress.begin("curves", plan.iter().map(|(_, _, theta)| theta.len() as u64).sum());
    plan.into_iter()
        .map(|(scatter, sigma, theta)| {
            let wi = incident(view.side, sigma, view.psi);
            let pair = |at: usize| (wi, in_plane(view.side, scatter, theta[at], view.psi));
            let reduce = |texel: &[f32]| [view.quantity.reduce(texel)];
            let f =
                evaluate(subject.material(), theta.len(), pair, reduce, progress).into_iter().map(|[f]| f).collect();
            let is_measured = match subject.part(view.side, scatter) {
                Some(part) => {
                    let is_covered = part.coverage(sigma, view.psi);
                    let above = |theta: f64| in_plane(lobe::Side::Front, Scatter::Reflection, theta, view.psi);
                    theta.iter().map(|&theta| is_covered(above(theta))).collect()
                }
                None => vec![false; theta.len()],
            };
            Curve { sigma, scatter, theta, f, is_measured }
        })
        .collect()
}

/// The viewing angles for light at `sigma`, ascending, in radians.
fn angles(sigma: f64) -> Vec<f64> {
    let sigma = sigma.to_degrees();
    let mut angles: Vec<f64> = (0..=(2.0 * LAST / STEP).round() as usize).map(|i| STEP * i as f64 - LAST).collect();
    for centre in [-sigma, sigma] {
        let steps = (NEAR / FINE).round() as i32;
        angles.extend((-steps..=steps).map(|i| centre + FINE * f64::from(i)));
    }
    angles.retain(|angle| angle.abs() <= LAST);
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    angles.into_iter().map(f64::to_radians).collect()
}
