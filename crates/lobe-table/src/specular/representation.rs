//! [`Representation`] for tables in specular coordinates.

use std::f64::consts::PI;
use std::sync::Arc;

use super::coords::{angles_to_directions, directions_to_angles};
use super::data::{AXIS_NAMES, Data};
use super::prepared::Prepared;
use super::reference::zenith;
use super::table::Table;
use crate::bsdf::Bsdf;
use crate::data::{
    Coverage, Grid, Kinks, Options, PrepareError, SAME, Section, Uses, ValueMap, direction, pairs, spans,
};
use crate::{Aspect, Channels, Edges, Invalid, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("specular table");

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        self.channels().clone()
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::front(self.scatter())]
    }

    fn is_isotropic(&self) -> bool {
        Data::is_isotropic(self)
    }

    fn uses(&self) -> Uses {
        Uses { edges: true, ..Uses::default() }
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let section = Section::new(KIND, Aspect::front(self.scatter()), self.channels().clone(), self.values());
        let section = section.with_axes(AXIS_NAMES, self.knots());
        vec![match self.refraction() {
            Some(offsets) => {
                let refracted = self.knots()[0].iter().zip(offsets).map(|(sigma, offset)| sigma + offset);
                // Degrees as in the file, which `f32` can hold.
                let degrees: Vec<String> = refracted.map(|angle| (angle.to_degrees() as f32).to_string()).collect();
                section.with_fact("refracted", format!("at {} degrees for the knots of sigma", degrees.join(" ")))
            }
            None => section,
        }]
    }

    fn incidences(&self, _: Aspect) -> Vec<[f64; 2]> {
        pairs(&self.knots()[0], &self.knots()[1])
    }

    fn kinks(&self, edges: &Edges, [theta, _]: [f64; 2]) -> Option<Kinks> {
        let [.., thetas, phis] = self.knots().clone();
        Some(Kinks { zenith: zenith(self, edges, theta), thetas, phis })
    }

    fn grid(&self) -> Option<Grid<'_>> {
        Some(Grid {
            names: AXIS_NAMES,
            knots: self.knots(),
            values: self.values(),
            channels: self.channels().count(),
            is_mirrored: false,
            is_specular: true,
        })
    }

    fn map_channels(&mut self, channels: Channels, map: &ValueMap<'_>) -> Result<bool, Invalid> {
        let mapped = Data::new(self.scatter(), self.knots().clone(), channels, map(self.values()));
        let mapped = mapped.and_then(|mapped| match self.refraction() {
            Some(offsets) => mapped.with_refraction(offsets.to_vec()),
            None => Ok(mapped),
        });
        *self = mapped.map_err(|error| Invalid::new("channels", error.to_string(), "values that f32 can hold"))?;
        Ok(true)
    }

    fn azimuth(&self) -> f64 {
        self.knots()[1][0]
    }

    /// About the mirror direction, or about the refracted ray.
    fn outgoing(&self, [sigma, psi]: [f64; 2]) -> Vec<[f64; 3]> {
        let [sigmas, _, thetas, phis] = self.knots();
        let zeniths = self.zeniths();
        let place = |theta: f64, phi: f64| {
            angles_to_directions([sigma, psi, theta, phi], |sigma| at_sigma(sigmas, &zeniths, sigma)).1
        };
        let mut found: Vec<_> = thetas
            .iter()
            .flat_map(|&theta| phis.iter().map(move |&phi| (theta, phi)))
            .map(|(t, p)| place(t, p))
            .collect();
        found.retain(|direction: &[f64; 3]| direction[2] > 1e-3);
        found
    }

    fn coverage(&self, [sigma, psi]: [f64; 2]) -> Coverage<'_> {
        let [sigmas, _, thetas, _] = self.knots();
        if !spans(sigmas, sigma) {
            return Box::new(|_| false);
        }
        let (wi, zeniths) = (direction(sigma, psi), self.zeniths());
        let last = thetas.last().copied().unwrap_or(PI) + SAME;
        Box::new(move |wo| directions_to_angles(wi, wo, |sigma| at_sigma(sigmas, &zeniths, sigma))[2] <= last)
    }

    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        Ok(Box::new(Prepared(Arc::new(Table::new(self, &options.edges)?))))
    }
}

impl Data {
    /// The polar angle of the axis of theta at each knot of sigma.
    fn zeniths(&self) -> Vec<f64> {
        let offset = |index: usize| self.refraction().map_or(0.0, |offsets| offsets[index]);
        self.knots()[0].iter().enumerate().map(|(index, sigma)| sigma + offset(index)).collect()
    }
}

/// The polar angle of the zenith at `sigma`, linear between the knots.
fn at_sigma(sigmas: &[f64], zeniths: &[f64], sigma: f64) -> f64 {
    let upper = sigmas.partition_point(|knot| *knot < sigma).min(sigmas.len() - 1);
    let lower = upper.saturating_sub(1);
    let ([a, from], [b, to]) = ([sigmas[lower], zeniths[lower]], [sigmas[upper], zeniths[upper]]);
    // The interpolated quantity is the difference from sigma, which is 0 without refraction.
    let share = if b > a { ((sigma - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
    sigma + (1.0 - share) * (from - a) + share * (to - b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_refracted_ray_is_linear_between_its_knots_and_continues_beyond() {
        for (sigma, expected) in [(0.0, 0.0), (0.4, 0.25), (0.8, 0.5), (1.0, 0.7)] {
            assert!((at_sigma(&[0.0, 0.8], &[0.0, 0.5], sigma) - expected).abs() < 1e-12, "{sigma}");
        }
        assert_eq!(at_sigma(&[0.3], &[0.3], 1.0), 1.0);
    }
}
