//! The figures.

mod appearance;
mod bar;
mod cartesian;
mod channels;
mod chart;
mod legend;
mod lines;
mod mueller;
pub(crate) mod picture;
mod polar;
mod polarisation;
mod residuals;
mod shared;
mod slices;
mod small;
mod spectral;
mod sphere;

use std::fmt;

use thiserror::Error;

use crate::evaluate::Progress;
use crate::in_plane::{Curve, MOST, curves};
use crate::layout::Paper;
use crate::polarised::scatter;
use crate::residual::Fitted;
use crate::scale::{Scaling, degrees};
use crate::shown::{Shown, incidences};
use crate::view::View;

pub use picture::{Picture, draw_picture};
pub(crate) use shared::side_name;

/// A kind of figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Figure {
    /// Values in the plane of incidence against the viewing angle.
    Curves,
    /// The same for each channel.
    Channels,
    /// Values against the wavelength.
    Spectra,
    /// Values in the plane of incidence in polar coordinates, as lobes.
    Polar,
    /// All outgoing directions, one disk per incidence.
    Slices,
    /// Spheres under lights.
    Sphere,
    /// All elements of the Mueller matrix in the plane of incidence.
    Mueller,
    /// Degree and angle of the linear polarisation of what unpolarised light becomes.
    Polarisation,
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Figure::Curves => "curves",
            Figure::Channels => "channels",
            Figure::Spectra => "spectra",
            Figure::Polar => "polar",
            Figure::Slices => "slices",
            Figure::Sphere => "sphere",
            Figure::Mueller => "mueller",
            Figure::Polarisation => "polarisation",
        })
    }
}

/// A figure that cannot be drawn of some materials.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DrawError {
    /// Several materials for a figure that shows only one.
    #[error("found {found} files; expected one for the figure {figure}")]
    Several {
        /// The figure.
        figure: Figure,
        /// The number of given materials.
        found: usize,
    },
    /// Spectra of a material without wavelengths.
    #[error("found the channels {found}; expected at least two wavelengths")]
    NoSpectra {
        /// The channels of the material.
        found: String,
    },
    /// Polarisation of a material without Mueller matrices.
    #[error("found {found}; expected Mueller matrices for the figure {figure}")]
    Unpolarised {
        /// The figure.
        figure: Figure,
        /// The representation of the material.
        found: String,
    },
}

/// A figure, and remarks about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawing {
    /// A self-contained SVG on white, readable at any size.
    pub svg: String,
    /// The contents, in a few words each: the incidences, the exposure.
    pub said: Vec<String>,
}

/// One figure, with the width of the first view. If that is less than 560 pixels, it is laid out for narrow columns.
///
/// # Errors
/// If there are several materials for a figure that shows only one, or if there are no spectra or no Mueller matrices to
/// draw.
pub fn draw(shown: &[Shown<'_>], figure: Figure, progress: &dyn Progress) -> Result<Drawing, DrawError> {
    let pixels = shown.first().map_or(0, |first| first.view.width);
    let Plate { draw, said } = compose(shown, figure, progress)?;
    Ok(Drawing { svg: draw(Paper::alone(pixels)), said })
}

/// A figure with computed values, to be drawn in any layout.
pub(crate) struct Plate<'a> {
    pub(crate) draw: Box<dyn Fn(Paper<'_>) -> String + 'a>,
    pub(crate) said: Vec<String>,
}

fn compose<'a>(shown: &[Shown<'a>], figure: Figure, progress: &dyn Progress) -> Result<Plate<'a>, DrawError> {
    let scaling = shown.first().and_then(|first| first.view.scaling);
    let only = || match shown {
        [one] => Ok(*one),
        several => Err(DrawError::Several { figure, found: several.len() }),
    };
    Ok(match figure {
        Figure::Curves => curves_plate(shown, &all_curves(shown, progress), scaling),
        Figure::Polar => polar_plate(shown, all_curves(shown, progress)),
        Figure::Channels => channels_plate(only()?, progress),
        Figure::Spectra => {
            let one = only()?;
            let found = || one.subject.material().channels().names().join(", ");
            spectra_plate(one, progress).ok_or_else(|| DrawError::NoSpectra { found: found() })?
        }
        Figure::Slices => slices_plate(shown, progress),
        Figure::Sphere => sphere_plate(shown, progress),
        Figure::Mueller | Figure::Polarisation => {
            let one = only()?;
            if scatter(one.subject, one.view.side).is_none() {
                let found = one.subject.material().kind().to_string();
                return Err(DrawError::Unpolarised { figure, found });
            }
            if figure == Figure::Mueller { mueller_plate(one, progress) } else { polarisation_plate(one, progress) }
        }
    })
}

/// The curves of each material at the same incidences.
pub(crate) fn all_curves(shown: &[Shown<'_>], progress: &dyn Progress) -> Vec<Vec<Curve>> {
    let sigmas = incidences(shown, MOST);
    let of = |shown: &Shown<'_>| {
        let view = View { sigmas: sigmas.clone(), ..shown.view.clone() };
        curves(shown.subject, &view, progress)
    };
    shown.iter().map(of).collect()
}

pub(crate) fn curves_plate<'a>(shown: &[Shown<'a>], curves: &[Vec<Curve>], scaling: Option<Scaling>) -> Plate<'a> {
    let chart = cartesian::chart(shown, curves, scaling);
    Plate { draw: Box::new(move |paper| chart.draw(paper)), said: vec![lights(&incidences(shown, MOST))] }
}

pub(crate) fn polar_plate<'a>(shown: &[Shown<'a>], curves: Vec<Vec<Curve>>) -> Plate<'a> {
    let said = vec![lights(&incidences(shown, MOST))];
    let (shown, scaling) = (shown.to_vec(), shown.first().and_then(|first| first.view.scaling));
    Plate { draw: Box::new(move |paper| polar::draw(&shown, &curves, scaling, paper)), said }
}

pub(crate) fn channels_plate<'a>(shown: Shown<'a>, progress: &dyn Progress) -> Plate<'a> {
    let chart = channels::chart(shown, progress);
    Plate { draw: Box::new(move |paper| chart.draw(paper)), said: vec![lights(&channels::sigmas(shown))] }
}

/// `None` if there are no spectra.
pub(crate) fn spectra_plate<'a>(shown: Shown<'a>, progress: &dyn Progress) -> Option<Plate<'a>> {
    let chart = spectral::chart(shown, progress)?;
    let said = vec![lights(&channels::sigmas(shown))];
    Some(Plate { draw: Box::new(move |paper| chart.draw(paper)), said })
}

pub(crate) fn slices_plate<'a>(shown: &[Shown<'a>], progress: &dyn Progress) -> Plate<'a> {
    let slices = slices::slices(shown, progress);
    let mut sigmas: Vec<f64> = slices.iter().flatten().map(|slice| slice.sigma).collect();
    sigmas.sort_by(f64::total_cmp);
    sigmas.dedup();
    let shown = shown.to_vec();
    Plate { draw: Box::new(move |paper| slices::draw(&shown, &slices, paper)), said: vec![lights(&sigmas)] }
}

/// Empty if the material is not polarised.
pub(crate) fn mueller_plate<'a>(shown: Shown<'a>, progress: &dyn Progress) -> Plate<'a> {
    let curves = mueller::matrices(shown, progress);
    let said = vec![lights(&curves.iter().map(|curve| curve.sigma).collect::<Vec<_>>())];
    Plate { draw: Box::new(move |paper| mueller::draw(shown, &curves, paper)), said }
}

/// Empty if the material is not polarised.
pub(crate) fn polarisation_plate<'a>(shown: Shown<'a>, progress: &dyn Progress) -> Plate<'a> {
    let found = polarisation::found(shown, progress);
    let said = vec![lights(&found.disks.iter().map(|disk| disk.sigma).collect::<Vec<_>>())];
    Plate { draw: Box::new(move |paper| polarisation::draw(shown, &found, paper)), said }
}

pub(crate) fn residuals_plate<'a>(shown: Shown<'a>, fitted: &Fitted<'_>, progress: &dyn Progress) -> Plate<'a> {
    let disks = residuals::residuals(shown, fitted, progress);
    let sigmas: Vec<f64> = disks.iter().map(|disk| disk.slice.sigma).collect();
    Plate { draw: Box::new(move |paper| residuals::draw(shown, &disks, paper)), said: vec![lights(&sigmas)] }
}

/// How different the fit looks; `None` if that is not known.
pub(crate) fn appearance_plate<'a>(shown: Shown<'a>, fitted: &Fitted<'_>) -> Option<Plate<'a>> {
    let spheres = fitted.spheres.clone()?;
    let said = vec![format!("delta E {:.2} on average", spheres.summary().mean)];
    Some(Plate { draw: Box::new(move |paper| appearance::draw(shown, &spheres, paper)), said })
}

pub(crate) fn sphere_plate<'a>(shown: &[Shown<'a>], progress: &dyn Progress) -> Plate<'a> {
    let balls = sphere::spheres(shown, progress);
    let mut stops: Vec<String> = balls.iter().map(|ball| sphere::ev(ball.exposure)).collect();
    if shown.len() > 1 {
        stops.truncate(1);
    }
    let shown = shown.to_vec();
    let said = if stops.is_empty() { Vec::new() } else { vec![format!("spheres exposed at {}", stops.join(", "))] };
    Plate { draw: Box::new(move |paper| sphere::draw(&shown, &balls, paper)), said }
}

/// The incidences in words.
fn lights(sigmas: &[f64]) -> String {
    let list: Vec<String> = sigmas.iter().map(|sigma| degrees(*sigma)).collect();
    format!("light at {}", list.join(" "))
}
