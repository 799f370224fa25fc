//! Values against the wavelength.

use lobe::{Channels, Scatter, Side};

use crate::evaluate::Progress;
use crate::geometry::{in_plane, incident};
use crate::subject::Subject;
use crate::view::View;

/// The values at all wavelengths for one pair of directions in the plane of incidence.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// The polar angle of the light in radians.
    pub sigma: f64,
    /// Reflection or transmission.
    pub scatter: Scatter,
    /// The viewing angle in radians, as in [`in_plane`](crate::in_plane()).
    pub theta: f64,
    /// The wavelengths in nanometres, in the order of the channels.
    pub nm: Vec<f64>,
    /// `f` in 1/sr at each.
    pub f: Vec<f32>,
    /// `true` if the values are measured rather than extrapolated.
    pub is_measured: bool,
}

/// The spectra of a view, reflection before transmission, then by incidence, then by viewing angle; `None` if the
/// channels are not at least two wavelengths.
///
/// The viewing angles are those of the view, or else the mirror direction and 5, 20 and 45 degrees from it toward the
/// light.
pub fn spectra(subject: &Subject, view: &View, sigmas: &[f64], progress: &dyn Progress) -> Option<Vec<Spectrum>> {
    let Channels::Spectral(nm) = subject.material().channels() else { return None };
    if nm.len() < 2 {
        return None;
    }
    let scatters = subject.scatters(view.side);
    let wanted: Vec<(Scatter, f64, f64)> = scatters
        .iter()
        .flat_map(|&scatter| sigmas.iter().map(move |&sigma| (scatter, sigma)))
        .flat_map(|(scatter, sigma)| view.viewing_angles(sigma).into_iter().map(move |theta| (scatter, sigma, theta)))
        .collect();
    progress.begin("spectra", wanted.len() as u64);
    let spectrum = |(scatter, sigma, theta): (Scatter, f64, f64)| {
        let narrow = |direction: [f64; 3]| direction.map(|c| c as f32);
        let wi = narrow(incident(view.side, sigma, view.psi));
        let wo = narrow(in_plane(view.side, scatter, theta, view.psi));
        let mut f = vec![0.0; nm.len()];
        subject.material().eval(wi, wo, &mut f);
        let is_measured = subject.part(view.side, scatter).is_some_and(|part| {
            part.coverage(sigma, view.psi)(in_plane(Side::Front, Scatter::Reflection, theta, view.psi))
        });
        progress.advance(1);
        Spectrum { sigma, scatter, theta, nm: nm.clone(), f, is_measured }
    };
    Some(wanted.into_iter().map(spectrum).collect())
}
