//! [`Representation`] for cosine series.

use std::borrow::Cow;

use super::data::Data;
use super::place::colours;
use crate::bsdf::Bsdf;
use crate::data::{Options, PrepareError, Section};
use crate::{Aspect, Channels, Kind, Representation, Scatter, Side};

/// The name of the representation.
pub const KIND: Kind = Kind::new("cosine series");

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        self.parts().channels.clone()
    }

    fn aspects(&self) -> Vec<Aspect> {
        self.measured()
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    /// The means over all azimuths at each pair of knots.
    fn sections(&self) -> Vec<Section<'_>> {
        let parts = self.parts();
        let knots = parts.mu.len();
        let longest = parts.series.iter().map(|series| series.count).max().unwrap_or(0);
        let of_aspect = |aspect: Aspect| {
            let pairs = (0..knots * knots).filter(|at| self.aspect(at / knots, at % knots) == Some(aspect));
            let channels = parts.channels.count();
            let means = |at: usize| {
                let scale = self.radiance(aspect) / f64::from(parts.mu[at % knots].abs());
                let mut means = [0.0; 3];
                for (channel, mean) in means.iter_mut().enumerate().take(channels) {
                    *mean = self.coefficients(parts.series[at], channel).first().map_or(0.0, |mean| f64::from(*mean));
                }
                colours(means, channels).into_iter().take(channels).map(move |mean| (mean * scale) as f32)
            };
            let section = Section::new(KIND, aspect, parts.channels.clone(), &[]);
            let section = Section {
                name: aspect.to_string(),
                quantity: "f in 1/sr, mean over all azimuths",
                values: Cow::Owned(pairs.flat_map(means).map(|mean| mean.min(f32::MAX)).collect()),
                bytes: size_of_val(parts.coefficients.as_slice()),
                ..section
            };
            let section = section.with_fact("series", format!("{knots} x {knots} knots, up to {longest} coefficients"));
            match aspect.scatter {
                Scatter::Reflection => section,
                Scatter::Transmission => section.with_fact("index", format!("{} behind the surface", parts.eta)),
            }
        };
        self.measured().into_iter().map(of_aspect).collect()
    }

    fn incidences(&self, aspect: Aspect) -> Vec<[f64; 2]> {
        let is_lit = |mu: &&f32| if aspect.light == Side::Front { **mu < 0.0 } else { **mu > 0.0 };
        let mut thetas: Vec<f64> =
            self.parts().mu.iter().filter(is_lit).map(|mu| f64::from(mu.abs()).min(1.0).acos()).collect();
        thetas.sort_by(f64::total_cmp);
        thetas.into_iter().map(|theta| [theta, 0.0]).collect()
    }

    fn refractive_index(&self) -> f64 {
        f64::from(self.parts().eta)
    }

    #[cfg(feature = "fourier")]
    fn prepare(&self, _: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self)
    }
}
