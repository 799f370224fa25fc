//! The figures.

mod cartesian;
mod legend;
mod polar;
mod shared;
mod slices;
mod sphere;

use std::fmt;

use crate::evaluate::Progress;
use crate::subject::Subject;
use crate::view::View;

pub(crate) use shared::{Series, degrees, side_name};

/// A kind of figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Figure {
    /// Values in the plane of incidence against the viewing angle.
    Curves,
    /// The same in polar coordinates, as lobes.
    Polar,
    /// All outgoing directions, a disk for each incidence.
    Slices,
    /// Spheres under lights.
    Sphere,
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Figure::Curves => "curves",
            Figure::Polar => "polar",
            Figure::Slices => "slices",
            Figure::Sphere => "sphere",
        })
    }
}

/// One figure as a self-contained SVG: on white, `view.width` pixels wide, readable at any size.
pub fn draw(subject: &Subject, view: &View, figure: Figure, progress: &dyn Progress) -> String {
    match figure {
        Figure::Curves => cartesian::draw(subject, view, progress),
        Figure::Polar => polar::draw(subject, view, progress),
        Figure::Slices => slices::draw(subject, view, progress),
        Figure::Sphere => sphere::draw(subject, view, progress),
    }
}
