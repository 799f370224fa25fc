//! The view of a material in a figure.

use lobe::Side;
use lobe_colour::Reduction;
use thiserror::Error;

use crate::quantity::Quantity;
use crate::scale::{Scaling, degrees};
use crate::subject::Subject;

/// The angles from the mirror direction, toward the light, at which spectra are shown, in degrees.
const OFFSETS: [f64; 4] = [0.0, 5.0, 20.0, 45.0];

/// The view of a material in a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// The side that the light comes from.
    pub side: Side,
    /// The polar angles of the light, in radians; if there are none, those of [`Subject::incidences`].
    pub sigmas: Vec<f64>,
    /// The azimuth of the light, in radians.
    pub psi: f64,
    /// The viewing angles of spectra, in radians, as in [`in_plane`](crate::in_plane()); if there are none, some about
    /// the mirror direction.
    pub thetas: Vec<f64>,
    /// The scaling of value axes; `None` lets each figure choose.
    pub scaling: Option<Scaling>,
    /// The number that curves and maps show.
    pub quantity: Quantity,
    /// The colours of spheres.
    pub colour: Reduction,
    /// The width of the figure in pixels.
    pub width: u32,
}

/// A view that shows nothing.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ViewError {
    /// No channel with this name.
    #[error("found no channel {asked}; expected one of {}", known.join(", "))]
    Channel {
        /// What was requested.
        asked: String,
        /// The available ones.
        known: Vec<String>,
    },
    /// Nothing was measured for light from this side.
    #[error("found no values for light from {}", match side { Side::Front => "the front", Side::Back => "the back" })]
    Side {
        /// The requested side.
        side: Side,
    },
}

impl View {
    /// The default view of a material: the light is above if anything was measured there, at the azimuth of the first
    /// knot.
    pub fn new(subject: &Subject) -> Self {
        let side = subject.sides().first().copied().unwrap_or(Side::Front);
        let channels = subject.material().channels();
        View {
            side,
            sigmas: Vec::new(),
            psi: subject.psi(side),
            thetas: Vec::new(),
            scaling: None,
            quantity: Quantity::of(channels),
            colour: Reduction::for_display(channels),
            width: 960,
        }
    }

    /// The same view with the light on a side.
    ///
    /// # Errors
    /// [`ViewError::Side`].
    pub fn lit_from(self, subject: &Subject, side: Side) -> Result<Self, ViewError> {
        match subject.scatters(side).is_empty() {
            true => Err(ViewError::Side { side }),
            false => Ok(View { side, psi: subject.psi(side), ..self }),
        }
    }

    /// The same view of one channel, whose name is not case-sensitive.
    ///
    /// # Errors
    /// [`ViewError::Channel`].
    pub fn channel(self, subject: &Subject, name: &str) -> Result<Self, ViewError> {
        let channels = subject.material().channels();
        let known = channels.names();
        match known.iter().position(|channel| channel.eq_ignore_ascii_case(name)) {
            Some(index) => {
                let quantity = Quantity::channel(channels, index);
                Ok(View { colour: Reduction::grey(channels.count(), index), quantity, ..self })
            }
            None => Err(ViewError::Channel { asked: name.into(), known }),
        }
    }

    /// The polar angles of the light to draw, in radians.
    pub(crate) fn incidences(&self, subject: &Subject, most: usize) -> Vec<f64> {
        match self.sigmas.is_empty() {
            true => subject.incidences(self.side, most),
            false => self.sigmas.clone(),
        }
    }

    /// The viewing angles of spectra for light at `sigma`, in radians.
    pub(crate) fn viewing_angles(&self, sigma: f64) -> Vec<f64> {
        match self.thetas.is_empty() {
            true => OFFSETS.iter().map(|offset| sigma - offset.to_radians()).collect(),
            false => self.thetas.clone(),
        }
    }

    /// The name of each of the [viewing angles](Self::viewing_angles).
    pub(crate) fn angle_names(&self) -> Vec<String> {
        match self.thetas.is_empty() {
            true => OFFSETS
                .iter()
                .map(|offset| if *offset == 0.0 { "mirror".into() } else { format!("mirror \u{2212} {offset}°") })
                .collect(),
            false => self.thetas.iter().map(|theta| degrees(*theta)).collect(),
        }
    }
}
