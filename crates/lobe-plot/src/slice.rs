//! All outgoing directions of one incidence, as a disk.

use lobe::Scatter;
use rayon::prelude::*;

use crate::evaluate::{Progress, evaluate};
use crate::geometry::{from_disk, incident, to_disk};
use crate::subject::Subject;
use crate::view::View;

/// The values of a hemisphere, on the square around its disk, in Lambert's equal-area projection with the light on the
/// left.
#[derive(Clone, Debug, PartialEq)]
pub struct Slice {
    /// The polar angle of the light in radians.
    pub sigma: f64,
    /// Reflection or transmission.
    pub scatter: Scatter,
    /// Pixels along each side of the square.
    pub size: usize,
    /// The quantity of the view in 1/sr, rows from the top; `None` outside the disk.
    pub f: Vec<Option<f32>>,
    /// `true` if each value is measured rather than extrapolated.
    pub is_measured: Vec<bool>,
    /// The measured directions, as positions in the square `[-1, 1]`, with y up.
    pub measured: Vec<[f64; 2]>,
}

/// The slice for light at the polar angle `sigma`, in radians, `size` pixels wide.
pub fn slice(
    subject: &Subject,
    view: &View,
    sigma: f64,
    scatter: Scatter,
    size: usize,
    progress: &dyn Progress,
) -> Slice {
    let place = |at: usize| {
        let [x, y] = [at % size, at / size].map(|pixel| 2.0 * (pixel as f64 + 0.5) / size as f64 - 1.0);
        [x, -y]
    };
    let wi = incident(view.side, sigma, view.psi);
    let inside: Vec<(usize, [f64; 3])> = (0..size * size)
        .filter_map(|at| {
            let [x, y] = place(at);
            from_disk(view.side, scatter, view.psi, x, y).map(|wo| (at, wo))
        })
        .collect();
    let reduce = |texel: &[f32]| [view.quantity.reduce(texel)];
    let values = evaluate(subject.material(), inside.len(), |at| (wi, inside[at].1), reduce, progress);
    let mut f = vec![None; size * size];
    for ((at, _), [value]) in inside.iter().zip(values) {
        f[*at] = Some(value);
    }
    let mut is_measured = vec![false; size * size];
    let mut measured = Vec::new();
    if let Some(part) = subject.part(view.side, scatter) {
        let is_covered = part.coverage(sigma, view.psi);
        let up = |[x, y, z]: [f64; 3]| [x, y, z.abs()];
        is_measured.par_iter_mut().enumerate().for_each(|(at, is_measured)| {
            let [x, y] = place(at);
            let wo = from_disk(view.side, scatter, view.psi, x, y);
            *is_measured = wo.is_some_and(|wo| is_covered(up(wo)));
        });
        measured = part.directions(sigma, view.psi).into_iter().map(|wo| to_disk(view.side, view.psi, wo)).collect();
    }
    Slice { sigma, scatter, size, f, is_measured, measured }
}
