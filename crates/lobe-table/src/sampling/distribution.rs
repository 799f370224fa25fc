//! The distribution of scattered light for every incident direction.

use lobe_backend::Backend;
use lobe_lane::{Floats, Lanes};

use super::budget::Budget;
use super::build::{Builder, Built};
use super::histogram::{Bin, Histogram, Light};
use super::incident::{Incident, Local, Surface};
use super::options::{DistributionError, DistributionOptions, Plan};
use super::places::place;
use super::slices::{Draw, Place, Slices};
use crate::grid::axis::Axis;
use crate::{Edge, Scatter};

/// Densities of scattered directions in proportion to light times cosine, for every incident direction.
///
/// The incident direction is called `known` here, because it may be that of the light or of the viewer. Directions are
/// unit vectors away from the surface, normal on +z; densities are per steradian. In strict form, samples have the same
/// bits on every backend.
#[derive(Clone, Debug)]
pub struct Distribution {
    pub(super) surface: Surface,
    pub(super) sigma: Axis,
    pub(super) psi: Option<Axis>,
    pub(super) slices: Slices,
    brightest: f32,
    is_limited: bool,
}

impl Distribution {
    /// Builds the distribution of a function that returns luminance times `f`, 1/sr, of many pairs: it gets the
    /// incident directions, as many scattered ones, and where to put the results. It is called only for incident
    /// directions with `z > 0`, and for scattered ones on the side that `options` name.
    ///
    /// `progress(done, all)` is called after each slice.
    ///
    /// # Errors
    /// If the options are invalid.
    pub fn of_function(
        backend: Backend,
        options: &DistributionOptions,
        light: &mut Light<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, DistributionError> {
        let axis = |name: &'static str, knots: &[f64], edge: Edge| {
            Axis::new(knots, edge).map_err(|source| DistributionError::Axis { axis: name, source })
        };
        let surface = Surface { scatter: options.scatter, refraction: None };
        let sigma = axis("sigma", &options.sigma, Edge::Clamp)?;
        let psi = if options.psi.len() > 1 { Some(axis("psi", &options.psi, Edge::Periodic)?) } else { None };
        let theta: Vec<f32> = options.theta.iter().map(|&theta| theta as f32).collect();
        let plan = Plan {
            sigma,
            psi,
            theta: &theta,
            phis: options.phis,
            bytes: options.bytes,
            budget: Budget::of(options.evaluations),
            defensive: options.defensive,
        };
        let run = |histogram: Histogram<'_>| backend.strict().run(histogram);
        Distribution::build(&run, light, surface, plan, progress)
    }

    pub(super) fn build(
        run: &dyn Fn(Histogram<'_>) -> Vec<Bin>,
        light: &mut Light<'_>,
        surface: Surface,
        plan: Plan<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, DistributionError> {
        let Plan { sigma, psi, theta, phis, bytes, budget, defensive } = plan;
        if !(defensive > 0.0 && defensive <= 1.0) {
            return Err(DistributionError::Defensive { found: defensive });
        }
        let Built { slices, brightest, is_limited } = Builder {
            run,
            light,
            surface: &surface,
            sigma: &sigma,
            psi: psi.as_ref(),
            theta,
            phis,
            bytes,
            budget,
            defensive: f64::from(defensive),
        }
        .build(progress)?;
        Ok(Distribution { surface, sigma, psi, slices, brightest: brightest as f32, is_limited })
    }

    /// The kind of scatter: scattered directions are on the side of the incident one, or on the other.
    pub fn scatter(&self) -> Scatter {
        self.surface.scatter
    }

    /// `true` if it would be finer without a limit to the number of evaluations.
    pub fn is_limited(&self) -> bool {
        self.is_limited
    }

    /// Bytes of memory that the distribution takes.
    pub fn bytes(&self) -> usize {
        let psi = self.psi.as_ref().map_or(0, Axis::bytes);
        self.slices.bytes() + self.sigma.bytes() + psi
    }

    /// A direction per lane and its density, inside a caller's own kernel; zeros if `known` is not above the surface,
    /// and in the lanes that `mask` leaves out.
    #[inline(always)]
    pub fn draw_lanes<L: Lanes>(&self, lanes: L, known: [L::F; 3], u: [L::F; 2], mask: L::M) -> ([L::F; 3], L::F) {
        let incident = Incident::new(lanes, &self.surface, known);
        let place = place(lanes, &self.sigma, self.psi.as_ref(), &incident);
        let draw = match self.slices.width {
            2 => self.slices.pairs().draw(lanes, &place, u),
            _ => self.slices.quads().draw(lanes, &place, u),
        };
        leave(lanes, &incident, draw, mask)
    }

    /// The density of `other` given `known`, inside a caller's own kernel; 0 if one of them is not above the surface.
    #[inline(always)]
    pub fn pdf_lanes<L: Lanes>(&self, lanes: L, known: [L::F; 3], other: [L::F; 3]) -> L::F {
        let incident = Incident::new(lanes, &self.surface, known);
        let place = place(lanes, &self.sigma, self.psi.as_ref(), &incident);
        self.density(lanes, &place, incident.locate(lanes, other))
    }

    #[inline(always)]
    pub(super) fn density<L: Lanes>(
        &self,
        lanes: L,
        place: &Place<L>,
        Local { v, phi, height, valid }: Local<L>,
    ) -> L::F {
        let density = match self.slices.width {
            2 => self.slices.pairs().density(lanes, place, v, phi),
            _ => self.slices.quads().density(lanes, place, v, phi),
        };
        (density / height).masked(valid)
    }

    /// The brightness of the surface, inside a caller's own kernel (see [`brightness_batch`](Self::brightness_batch)).
    #[inline(always)]
    pub fn brightness_lanes<L: Lanes>(&self, lanes: L, known: [L::F; 3]) -> L::F {
        let incident = Incident::new(lanes, &self.surface, known);
        let place = place(lanes, &self.sigma, self.psi.as_ref(), &incident);
        self.brightness(lanes, &place, incident.valid)
    }

    #[inline(always)]
    pub(super) fn brightness<L: Lanes>(&self, lanes: L, place: &Place<L>, valid: L::M) -> L::F {
        let total = match self.slices.width {
            2 => self.slices.pairs().total(lanes, place),
            _ => self.slices.quads().total(lanes, place),
        };
        (total * lanes.splat(self.brightest)).masked(valid)
    }
}

/// Converts a sample of the slices to a direction and its density; zeros as in
/// [`draw_lanes`](Distribution::draw_lanes).
#[inline(always)]
pub(super) fn leave<L: Lanes>(lanes: L, incident: &Incident<L>, draw: Draw<L>, mask: L::M) -> ([L::F; 3], L::F) {
    let (sin, cos) = lobe_math::sin_cos(lanes, draw.phi);
    let height = incident.height(lanes, cos);
    let valid = incident.valid & mask;
    let [x, y, z] = incident.direction(lanes, draw.v * height, [cos, sin]);
    let sampled = [x.masked(valid), y.masked(valid), z.masked(valid)];
    (sampled, (draw.density / height).masked(valid))
}
