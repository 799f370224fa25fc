//! The share of the light that is reflected or transmitted.

use lobe::Scatter;
use lobe_ops::Aspect;
use lobe_ops::albedo::albedo_of;
use lobe_ops::hemisphere::Effort;
use rayon::prelude::*;

use crate::evaluate::Progress;
use crate::in_plane::MOST;
use crate::subject::Subject;
use crate::view::View;

/// The share of the light from one direction that is reflected, or transmitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Albedo {
    /// The polar angle of the light in radians.
    pub sigma: f64,
    /// Reflection or transmission.
    pub scatter: Scatter,
    /// The directional-hemispherical reflectance or transmittance of the quantity of the view.
    pub value: f64,
    /// Its linear sRGB.
    pub rgb: [f64; 3],
}

/// The directional albedos of a view, one per incidence and scatter: those of [`albedo_of`] within its default effort,
/// reduced to the quantity and the colour of the view. Data measured only in the plane of incidence have none.
pub fn albedos(subject: &Subject, view: &View, progress: &dyn Progress) -> Vec<Albedo> {
    let sigmas = view.incidences(subject, MOST);
    let mut scatters = subject.scatters(view.side);
    scatters.retain(|&scatter| !subject.measured().is_in_plane(Aspect { scatter, light: view.side }));
    let wanted: Vec<(Scatter, f64)> =
        scatters.iter().flat_map(|&scatter| sigmas.iter().map(move |&sigma| (scatter, sigma))).collect();
    progress.begin("albedo", wanted.len() as u64);
    let albedo = |&(scatter, sigma): &(Scatter, f64)| {
        let aspect = Aspect { scatter, light: view.side };
        let channels = albedo_of(subject.measured(), aspect, [sigma, view.psi], Effort::default()).values;
        progress.advance(1);
        Albedo { sigma, scatter, value: view.quantity.exact(&channels), rgb: view.colour.exact(&channels) }
    };
    wanted.par_iter().map(albedo).collect()
}
