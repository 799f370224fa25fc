//! The directions at which a material was measured: the incidences to draw, the directions to mark, and the
//! extrapolated parts of the hemisphere.

use std::f64::consts::PI;

use lobe::formats::Document;
use lobe::table::Representation;
use lobe::table::data::Coverage;
use lobe::{Aspect, Scatter};

/// Angles that differ by less than this, in radians, are equal.
const SAME: f64 = 1e-4;

/// Directions whose component perpendicular to the plane of incidence is smaller than this, 0.06 degrees, are in it.
const FLAT: f64 = 1e-3;

/// The measurement for light from one side that leaves on one side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    pub(crate) aspect: Aspect,
    data: &'a dyn Representation,
}

/// The parts of a document that have values for pairs of directions.
pub(crate) fn parts(document: &Document) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    for part in &document.parts {
        let data = part.data.representation();
        if data.is_delta() {
            continue;
        }
        let mut aspects = data.aspects();
        if data.is_two_sided() {
            // A missing transmission is replaced by the reverse of the other one.
            let others: Vec<Aspect> = aspects.iter().map(|aspect| aspect.reversed()).collect();
            aspects.extend(others.into_iter().filter(|aspect| aspect.scatter == Scatter::Transmission));
        }
        let on_side = |aspect: Aspect| Aspect { light: part.side.unwrap_or(aspect.light), ..aspect };
        parts.extend(aspects.into_iter().map(|aspect| Part { aspect: on_side(aspect), data }));
    }
    parts
}

impl<'a> Part<'a> {
    /// Polar angles of the light in radians, ascending; empty if the representation does not list them.
    pub(crate) fn incidences(&self) -> Vec<f64> {
        let mut thetas: Vec<f64> = self.data.incidences(self.aspect).into_iter().map(|[theta, _]| theta).collect();
        thetas.dedup_by(|a, b| (*a - *b).abs() < SAME);
        thetas
    }

    /// The azimuth of the light in the default view, in radians.
    pub(crate) fn psi(&self) -> f64 {
        self.data.azimuth()
    }

    /// The outgoing directions that were measured for light at `sigma` and `psi`, as if light and viewer were both
    /// above, and only those above the horizon. Empty if the representation does not list directions.
    pub(crate) fn directions(&self, sigma: f64, psi: f64) -> Vec<[f64; 3]> {
        self.data.outgoing([sigma, psi])
    }

    /// A test of outgoing directions for light at `sigma` and `psi`, as if light and viewer were both above: `true` if
    /// the value there was measured, and not only extrapolated.
    pub(crate) fn coverage(&self, sigma: f64, psi: f64) -> Coverage<'a> {
        self.data.coverage([sigma, psi])
    }

    /// `true` if light at `sigma` and `psi` is one of the measured directions.
    fn is_incidence(&self, sigma: f64, psi: f64) -> bool {
        let is_turned = |phi: f64| ((phi - psi + PI).rem_euclid(2.0 * PI) - PI).abs() > SAME;
        let is_free = self.data.is_isotropic() || sigma < SAME;
        let is_it = |[theta, phi]: [f64; 2]| (theta - sigma).abs() < SAME && (is_free || !is_turned(phi));
        self.data.incidences(self.aspect).into_iter().any(is_it)
    }

    /// The viewing angles in the plane of incidence at which light at `sigma` and `psi` was measured, ascending, as in
    /// [`in_plane`](crate::in_plane()); none if that light was not.
    pub(crate) fn in_plane(&self, sigma: f64, psi: f64) -> Vec<f64> {
        if !self.is_incidence(sigma, psi) {
            return Vec::new();
        }
        let (sin, cos) = psi.sin_cos();
        let angle = |[x, y, z]: [f64; 3]| {
            let (along, across) = (-(x * cos + y * sin), x * sin - y * cos);
            (across.abs() < FLAT).then(|| along.atan2(z))
        };
        let mut thetas: Vec<f64> = self.directions(sigma, psi).into_iter().filter_map(angle).collect();
        thetas.sort_by(f64::total_cmp);
        thetas.dedup_by(|a, b| (*a - *b).abs() < SAME);
        thetas
    }
}
