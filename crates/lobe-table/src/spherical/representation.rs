//! [`Representation`] for grids in spherical coordinates.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::data::{AXIS_NAMES, Data};
use crate::bsdf::Bsdf;
use crate::data::{
    ANGLE_ROUNDING, Coverage, Grid, Kinks, Options, PrepareError, SAME, Section, ValueMap, direction, pairs, spans,
};
use crate::{Aspect, Channels, Edges, Invalid, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("spherical grid");

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        Data::channels(self).clone()
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::front(self.scatter())]
    }

    fn is_isotropic(&self) -> bool {
        Data::is_isotropic(self)
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let section = Section::new(KIND, Aspect::front(self.scatter()), Data::channels(self).clone(), self.values());
        let section = section.with_axes(AXIS_NAMES, self.knots());
        vec![match self.is_mirrored() {
            true => section.with_fact("symmetry", "the other half of phi_o is the mirror image"),
            false => section,
        }]
    }

    fn incidences(&self, _: Aspect) -> Vec<[f64; 2]> {
        pairs(&self.knots()[0], &self.knots()[1])
    }

    /// Kinks are about the normal, with azimuths counted from the light; in the grid, this is so if it is isotropic,
    /// and otherwise they count from +x.
    fn kinks(&self, _: &Edges, [_, phi]: [f64; 2]) -> Option<Kinks> {
        let turn = match () {
            () if self.is_mirrored() => 0.0,
            () if Data::is_isotropic(self) => self.knots()[1][0],
            () => phi,
        };
        let signs: &[f64] = if self.is_mirrored() { &[1.0, -1.0] } else { &[1.0] };
        let of_sign = |sign: &f64| {
            let sign = *sign;
            self.knots()[3].iter().map(move |knot| (sign * (knot - turn)).rem_euclid(TAU))
        };
        let mut phis: Vec<f64> = signs.iter().flat_map(of_sign).collect();
        phis.sort_by(f64::total_cmp);
        phis.dedup_by(|a, b| *a - *b < ANGLE_ROUNDING);
        Some(Kinks { zenith: 0.0, thetas: self.knots()[2].clone(), phis })
    }

    fn grid(&self) -> Option<Grid<'_>> {
        Some(Grid {
            names: AXIS_NAMES,
            knots: self.knots(),
            values: self.values(),
            channels: Data::channels(self).count(),
            is_mirrored: self.is_mirrored(),
            is_specular: false,
        })
    }

    fn map_channels(&mut self, channels: Channels, map: &ValueMap<'_>) -> Result<bool, Invalid> {
        let mapped = Data::new(self.scatter(), self.knots().clone(), channels, map(self.values()));
        let mapped = mapped.and_then(|mapped| if self.is_mirrored() { mapped.mirrored() } else { Ok(mapped) });
        *self = mapped.map_err(|error| Invalid::new("channels", error.to_string(), "values that f32 can hold"))?;
        Ok(true)
    }

    fn azimuth(&self) -> f64 {
        if Data::is_isotropic(self) { 0.0 } else { self.knots()[1][0] }
    }

    fn outgoing(&self, [_, psi]: [f64; 2]) -> Vec<[f64; 3]> {
        let [_, phi_i, thetas, phis] = self.knots();
        // The azimuths of an isotropic grid count from its only phi_i.
        let (turn, from) = if Data::is_isotropic(self) { (psi, phi_i[0]) } else { (0.0, 0.0) };
        let halves: &[f64] = if self.is_mirrored() { &[1.0, -1.0] } else { &[1.0] };
        let mut found = Vec::new();
        for &theta in thetas {
            for &phi in phis {
                found.extend(halves.iter().map(|half| direction(theta, turn + half * (phi - from))));
            }
        }
        found.retain(|direction| direction[2] > 1e-3);
        found
    }

    fn coverage(&self, [theta, _]: [f64; 2]) -> Coverage<'_> {
        let [thetas, _, theta_o, _] = self.knots();
        if !spans(thetas, theta) {
            return Box::new(|_| false);
        }
        let last = theta_o.last().copied().unwrap_or(FRAC_PI_2) + SAME;
        Box::new(move |wo| wo[0].hypot(wo[1]).atan2(wo[2]) <= last)
    }

    #[cfg(feature = "spherical")]
    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self, options)
    }
}
