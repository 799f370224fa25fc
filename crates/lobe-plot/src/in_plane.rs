//! Curves in the plane of incidence.

use lobe::{Scatter, Side};

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
    /// `true` if each value is measured rather than extrapolated.
    pub is_measured: Vec<bool>,
    /// The positions in `theta` of the angles at which the material was measured.
    pub points: Vec<usize>,
}

/// Steps of the viewing angle in degrees: everywhere, and within [`NEAR`] of the mirror direction and of the light.
const STEP: f64 = 0.1;
const FINE: f64 = 0.02;
const NEAR: f64 = 2.0;
/// The last viewing angle in degrees. At the horizon there is no value.
const LAST: f64 = 89.9;
/// More curves than this cannot be distinguished.
pub(crate) const MOST: usize = 8;
/// Angles nearer to each other than this, in degrees, are equal.
const SAME: f64 = 1e-6;

/// The curves of a view: one per incidence, reflection before transmission.
pub fn curves(subject: &Subject, view: &View, progress: &dyn Progress) -> Vec<Curve> {
    let sigmas = view.incidences(subject, MOST);
    let reduce = |texel: &[f32]| [view.quantity.reduce(texel)];
    let of_each = reduced(subject, view, &sigmas, reduce, progress);
    of_each.into_iter().map(|[curve]| curve).collect()
}

/// The curves of up to [`MOST`] channels, one list of curves per incidence, reflection before transmission.
pub(crate) fn channel_curves(
    subject: &Subject,
    view: &View,
    sigmas: &[f64],
    channels: &[usize],
    progress: &dyn Progress,
) -> Vec<Vec<Curve>> {
    let reduce = |texel: &[f32]| std::array::from_fn(|at| channels.get(at).map_or(0.0, |&channel| texel[channel]));
    let of_each = reduced::<MOST>(subject, view, sigmas, reduce, progress);
    of_each.into_iter().map(|curves| curves.into_iter().take(channels.len()).collect()).collect()
}

/// The curves of the `N` numbers to which values are reduced.
fn reduced<const N: usize>(
    subject: &Subject,
    view: &View,
    sigmas: &[f64],
    reduce: impl Fn(&[f32]) -> [f32; N] + Sync,
    progress: &dyn Progress,
) -> Vec<[Curve; N]> {
    let scatters = subject.scatters(view.side);
    let plan: Vec<(Scatter, f64, Angles)> = scatters
        .iter()
        .flat_map(|&scatter| sigmas.iter().map(move |&sigma| (scatter, sigma)))
        .map(|(scatter, sigma)| (scatter, sigma, angles(subject, view, scatter, sigma)))
        .collect();
    progress.begin("curves", plan.iter().map(|(.., angles)| angles.theta.len() as u64).sum());
    plan.into_iter()
        .map(|(scatter, sigma, Angles { theta, points })| {
            let wi = incident(view.side, sigma, view.psi);
            let pair = |at: usize| (wi, in_plane(view.side, scatter, theta[at], view.psi));
            let values = evaluate(subject.material(), theta.len(), pair, &reduce, progress);
            let is_measured = match subject.part(view.side, scatter) {
                Some(part) => {
                    let is_covered = part.coverage(sigma, view.psi);
                    let above = |theta: f64| in_plane(Side::Front, Scatter::Reflection, theta, view.psi);
                    theta.iter().map(|&theta| is_covered(above(theta))).collect()
                }
                None => vec![false; theta.len()],
            };
            let curve = Curve { sigma, scatter, theta, f: Vec::new(), is_measured, points };
            std::array::from_fn(|n| Curve { f: values.iter().map(|value| value[n]).collect(), ..curve.clone() })
        })
        .collect()
}

/// Viewing angles in radians, ascending, and the positions of the measured ones.
pub(crate) struct Angles {
    pub(crate) theta: Vec<f64>,
    pub(crate) points: Vec<usize>,
}

pub(crate) fn angles(subject: &Subject, view: &View, scatter: Scatter, sigma: f64) -> Angles {
    let part = subject.part(view.side, scatter);
    let mut measured = part.map(|part| part.in_plane(sigma, view.psi)).unwrap_or_default();
    measured.iter_mut().for_each(|theta| *theta = theta.to_degrees());
    measured.retain(|theta| theta.abs() <= LAST);
    let sigma = sigma.to_degrees();
    let mut all: Vec<f64> = (0..=(2.0 * LAST / STEP).round() as usize).map(|i| STEP * i as f64 - LAST).collect();
    for centre in [-sigma, sigma] {
        let steps = (NEAR / FINE).round() as i32;
        all.extend((-steps..=steps).map(|i| centre + FINE * f64::from(i)));
    }
    all.extend(&measured);
    all.retain(|angle| angle.abs() <= LAST);
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < SAME);
    let place = |angle: &f64| all.partition_point(|other| *other < angle - 2.0 * SAME).min(all.len() - 1);
    let points = measured.iter().map(place).collect();
    Angles { theta: all.into_iter().map(f64::to_radians).collect(), points }
}
