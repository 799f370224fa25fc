//! Materials with their views.

use crate::subject::Subject;
use crate::view::View;

/// A material and its view.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// The material.
    pub subject: &'a Subject,
    /// The view of it. If several materials are shown in one figure, the width, the scaling and the light are those of
    /// the first view.
    pub view: &'a View,
}

/// More incidences than this, each with one line per file, make a figure too long.
const MOST_OF_SEVERAL: usize = 4;

/// The polar angles of the light that a figure of some materials shows, in radians: at most `most` for one material.
pub(crate) fn incidences(shown: &[Shown<'_>], most: usize) -> Vec<f64> {
    match shown {
        [] => Vec::new(),
        [one] => one.view.incidences(one.subject, most),
        [first, ..] => {
            let most = most.min(MOST_OF_SEVERAL);
            let mut sigmas = first.view.incidences(first.subject, most + 1);
            // With one more, the last incidence is so low that it says more about the horizon than about the materials.
            if first.view.sigmas.is_empty() {
                sigmas.truncate(most);
            }
            sigmas
        }
    }
}
