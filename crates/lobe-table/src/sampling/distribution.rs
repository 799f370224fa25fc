//! The distribution of scattered light about every incident direction.

use std::f64::consts::{PI, TAU};

use lobe_backend::Backend;
use lobe_lane::{Floats, Kernel, Lanes, call};
use thiserror::Error;

use super::block;
use super::build::Builder;
use super::histogram::{Bin, Histogram, Light};
use super::incident::{Incident, Local, Surface};
use super::slices::{Draw, Place, Slices};
use crate::directions::{DirectionBlock, Directions, PADDING};
use crate::grid::axis::Axis;
use crate::passes::block::{BLOCK, Column};
use crate::{AxisError, Edge, Scatter};

/// What a [`Distribution`] is laid out for.
#[derive(Clone, Debug, PartialEq)]
pub struct DistributionOptions {
    /// Whether scattered directions lie on the side of the incident one, or on the other.
    pub scatter: Scatter,
    /// Polar angles of incidence in radians, ascending in `[0, pi/2]`: at each there is a slice.
    pub sigma: Vec<f64>,
    /// Azimuths of incidence in radians, ascending in `[0, 2 pi)`; one or none if the azimuth does not matter.
    pub psi: Vec<f64>,
    /// Angles from the mirror direction, radians in `[0, pi]`, between which the light varies little.
    pub theta: Vec<f64>,
    /// About how many steps in azimuth about the mirror direction it takes to follow the light.
    pub phis: usize,
    /// The most memory to take, but for the coarsest grid.
    pub bytes: usize,
    /// The part of every slice that is a cosine distribution, in `(0, 1]`.
    pub defensive: f32,
}

impl DistributionOptions {
    /// A grid for light of which nothing is known: steps in theta that are finest at the mirror direction, and slices
    /// every 5 degrees and closer at grazing; if psi matters, every 10 degrees, and of psi every 22.5.
    pub fn unknown(scatter: Scatter, isotropic: bool, bytes: usize) -> Self {
        let (step, last) = if isotropic { (5, 17) } else { (10, 9) };
        let mut sigma: Vec<f64> = (0..last).map(|i| f64::from(step * i).to_radians()).collect();
        sigma.extend([85.0, 88.0, 89.5].map(f64::to_radians));
        let psi = if isotropic { vec![0.0] } else { (0..16).map(|i| f64::from(i) / 16.0 * TAU).collect() };
        let theta = (0..=40).map(|i| PI * (f64::from(i) / 40.0).powi(2)).collect();
        DistributionOptions { scatter, sigma, psi, theta, phis: 128, bytes, defensive: 0.05 }
    }
}

/// Why there is no distribution.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DistributionError {
    /// A defensive part that is not in `(0, 1]`.
    #[error("a defensive part of {found}; expected a number in (0, 1]")]
    Defensive {
        /// What was found.
        found: f32,
    },
    /// Knots that do not make an axis.
    #[error("{axis} of the distribution: {source}")]
    Axis {
        /// Which axis.
        axis: &'static str,
        /// What is wrong with it.
        source: AxisError,
    },
    /// Edges of a grid that single precision does not distinguish.
    #[error("the grid of the distribution: {source}")]
    Grid {
        /// What is wrong with it.
        source: AxisError,
    },
}

/// Densities of scattered directions in proportion to light times cosine, for every incident direction.
///
/// The incident direction is called `known` here, because it may be that of the light or of the viewer. Directions are
/// unit vectors away from the surface, normal on +z; densities are per steradian. In strict form, samples are the same
/// bits on every backend.
#[derive(Clone, Debug)]
pub struct Distribution {
    pub(super) surface: Surface,
    pub(super) sigma: Axis,
    pub(super) psi: Option<Axis>,
    pub(super) slices: Slices,
    brightest: f32,
}

impl Distribution {
    /// Builds the distribution of a function that returns luminance times `f`, 1/sr, of many pairs: it gets the
    /// incident directions, as many scattered ones, and where to put the results. It is called for incident directions
    /// with `z > 0` only, and for scattered ones on the side that `options` say.
    ///
    /// `progress(done, all)` is called after each slice.
    ///
    /// # Errors
    /// If the options make no sense.
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
        let plan = Plan { theta: &theta, phis: options.phis, bytes: options.bytes, defensive: options.defensive };
        let run = |histogram: Histogram<'_>| backend.strict().run(histogram);
        Distribution::build(&run, light, surface, (sigma, psi), &plan, progress)
    }

    pub(super) fn build(
        run: &dyn Fn(Histogram<'_>) -> Vec<Bin>,
        light: &mut Light<'_>,
        surface: Surface,
        (sigma, psi): (Axis, Option<Axis>),
        plan: &Plan<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, DistributionError> {
        let &Plan { theta, phis, bytes, defensive } = plan;
        if !(defensive > 0.0 && defensive <= 1.0) {
            return Err(DistributionError::Defensive { found: defensive });
        }
        let (slices, brightest) = Builder {
            run,
            light,
            surface: &surface,
            sigma: &sigma,
            psi: psi.as_ref(),
            theta,
            phis,
            bytes,
            defensive: f64::from(defensive),
        }
        .build(progress)?;
        Ok(Distribution { surface, sigma, psi, slices, brightest: brightest as f32 })
    }

    /// Whether scattered directions lie on the side of the incident one, or on the other.
    pub fn scatter(&self) -> Scatter {
        self.surface.scatter
    }

    /// Bytes of memory that the distribution takes.
    pub fn bytes(&self) -> usize {
        let psi = self.psi.as_ref().map_or(0, Axis::bytes);
        self.slices.bytes() + self.sigma.bytes() + psi
    }

    /// Draws a scattered direction, and its density, for each known direction and two numbers in `[0, 1)`; zeros if the
    /// known direction is not above the surface.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn draw_batch(
        &self,
        backend: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) {
        backend.run(self.drawing(known, u, directions, pdfs));
    }

    /// The drawing of many directions as a kernel, for lanes that are not a [`Backend`] (see [`draw_batch`](Self::draw_batch)).
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn drawing<'a>(
        &'a self,
        known: &'a [[f32; 3]],
        u: &'a [[f32; 2]],
        directions: &'a mut [[f32; 3]],
        pdfs: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        let count = known.len();
        assert_eq!((u.len(), directions.len(), pdfs.len()), (count, count, count), "one of each a direction");
        Draws { distribution: self, known, u, directions, pdfs }
    }

    /// The density of each of the `other` directions given the known one; 0 if one of them is not above the surface.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn pdf_batch(&self, backend: Backend, known: &[[f32; 3]], other: &[[f32; 3]], pdfs: &mut [f32]) {
        backend.run(self.densities(known, other, pdfs));
    }

    /// The densities of many pairs as a kernel, for lanes that are not a [`Backend`] (see [`pdf_batch`](Self::pdf_batch)).
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn densities<'a>(
        &'a self,
        known: &'a [[f32; 3]],
        other: &'a [[f32; 3]],
        pdfs: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        assert_eq!((known.len(), other.len()), (pdfs.len(), pdfs.len()), "as many known as other and densities");
        Densities { distribution: self, known, other, pdfs }
    }

    /// How bright the surface is for light from each known direction: the integral of luminance times `f` times cosine,
    /// interpolated between the slices; 0 if it is not a direction above the surface.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn brightness_batch(&self, backend: Backend, known: &[[f32; 3]], out: &mut [f32]) {
        backend.run(self.brightnesses(known, out));
    }

    /// The brightness for many directions as a kernel, for lanes that are not a [`Backend`] (see [`brightness_batch`](Self::brightness_batch)).
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn brightnesses<'a>(&'a self, known: &'a [[f32; 3]], out: &'a mut [f32]) -> impl Kernel<Out = ()> + 'a {
        assert_eq!(known.len(), out.len(), "a direction a result");
        Brightnesses { distribution: self, known, out }
    }

    /// A direction per lane and its density, inside a caller's own kernel; zeros if `known` is not above the surface
    /// and in lanes outside `mask`.
    #[inline(always)]
    pub fn draw_lanes<L: Lanes>(&self, lanes: L, known: [L::F; 3], u: [L::F; 2], mask: L::M) -> ([L::F; 3], L::F) {
        let incident = Incident::new(lanes, &self.surface, known);
        let place = place(lanes, self, &incident);
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
        let place = place(lanes, self, &incident);
        self.density(lanes, &place, incident.locate(lanes, other))
    }

    #[inline(always)]
    fn density<L: Lanes>(&self, lanes: L, place: &Place<L>, Local { v, phi, height, valid }: Local<L>) -> L::F {
        let density = match self.slices.width {
            2 => self.slices.pairs().density(lanes, place, v, phi),
            _ => self.slices.quads().density(lanes, place, v, phi),
        };
        (density / height).masked(valid)
    }

    /// How bright the surface is, inside a caller's own kernel (see [`brightness_batch`](Self::brightness_batch)).
    #[inline(always)]
    pub fn brightness_lanes<L: Lanes>(&self, lanes: L, known: [L::F; 3]) -> L::F {
        let incident = Incident::new(lanes, &self.surface, known);
        let place = place(lanes, self, &incident);
        self.brightness(lanes, &place, incident.valid)
    }

    #[inline(always)]
    fn brightness<L: Lanes>(&self, lanes: L, place: &Place<L>, valid: L::M) -> L::F {
        let total = match self.slices.width {
            2 => self.slices.pairs().total(lanes, place),
            _ => self.slices.quads().total(lanes, place),
        };
        (total * lanes.splat(self.brightest)).masked(valid)
    }
}

/// What decides how fine a distribution is (see [`DistributionOptions`]).
pub(super) struct Plan<'a> {
    pub(super) theta: &'a [f32],
    pub(super) phis: usize,
    pub(super) bytes: usize,
    pub(super) defensive: f32,
}

/// The cell of an angle and how far into it, never outside.
#[inline(always)]
fn cell<L: Lanes>(lanes: L, axis: &Axis, angle: L::F) -> (L::I, L::F) {
    let cell = axis.cell(lanes, axis.bring_inside(lanes, angle));
    (cell.index, cell.fraction.max(lanes.splat(0.0)).min(lanes.splat(1.0)))
}

/// The slices about an incident direction, in sigma and psi.
#[inline(always)]
fn place<L: Lanes>(lanes: L, distribution: &Distribution, incident: &Incident<L>) -> Place<L> {
    let one = lanes.splat(1.0);
    let rest = incident.sin2 / (one + incident.cos);
    let (sigma, up) = cell(lanes, &distribution.sigma, lobe_math::acos_from(lanes, incident.cos, rest));
    let down = one - up;
    let Some(axis) = &distribution.psi else {
        let zero = lanes.splat(0.0);
        return Place { block: sigma, weights: [down, up, zero, zero] };
    };
    let [cos_psi, sin_psi] = incident.psi;
    let (psi, on) = cell(lanes, axis, lobe_math::azimuth(lanes, sin_psi, cos_psi));
    let back = one - on;
    let block = sigma * lanes.splat_int(axis.cells().len() as i32) + psi;
    Place { block, weights: [down * back, down * on, up * back, up * on] }
}

/// From a sample of the slices to a direction and its density; zeros as [`draw`].
#[inline(always)]
pub(super) fn leave<L: Lanes>(lanes: L, incident: &Incident<L>, draw: Draw<L>, mask: L::M) -> ([L::F; 3], L::F) {
    let (sin, cos) = lobe_math::sin_cos(lanes, draw.phi);
    let height = incident.height(lanes, cos);
    let valid = incident.valid & mask;
    let [x, y, z] = incident.direction(lanes, draw.v * height, [cos, sin]);
    let sampled = [x.masked(valid), y.masked(valid), z.masked(valid)];
    (sampled, (draw.density / height).masked(valid))
}

/// All samples of a batch.
struct Draws<'a> {
    distribution: &'a Distribution,
    known: &'a [[f32; 3]],
    u: &'a [[f32; 2]],
    directions: &'a mut [[f32; 3]],
    pdfs: &'a mut [f32],
}

impl Kernel for Draws<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Draws { distribution, known, u, directions, pdfs } = self;
        let known = Directions::from(known);
        let (mut padding, mut places) = (PADDING, Places::ZERO);
        let mut at = 0;
        while at < u.len() {
            let end = u.len().min(at + BLOCK);
            let known = known.block(at, &mut padding);
            call(lanes, Locate { distribution, known, count: end - at, places: &mut places });
            let out = block::Out { directions: &mut directions[at..end], pdfs: &mut pdfs[at..end] };
            let input = (known, &u[at..end], &places);
            match distribution.slices.width {
                2 => block::draw(lanes, distribution, &distribution.slices.pairs(), input, out),
                _ => block::draw(lanes, distribution, &distribution.slices.quads(), input, out),
            }
            at = end;
        }
    }
}

/// All densities of a batch.
struct Densities<'a> {
    distribution: &'a Distribution,
    known: &'a [[f32; 3]],
    other: &'a [[f32; 3]],
    pdfs: &'a mut [f32],
}

impl Kernel for Densities<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Densities { distribution, known, other, pdfs } = self;
        let (known, other) = (Directions::from(known), Directions::from(other));
        let (mut padding, mut places) = ((PADDING, PADDING), Places::ZERO);
        let mut at = 0;
        while at < pdfs.len() {
            let end = pdfs.len().min(at + BLOCK);
            let (known, other) = (known.block(at, &mut padding.0), other.block(at, &mut padding.1));
            call(lanes, Locate { distribution, known, count: end - at, places: &mut places });
            let mut query = 0;
            while at + query < end {
                let incident = Incident::new(lanes, &distribution.surface, known.load(lanes, query));
                let local = incident.locate(lanes, other.load(lanes, query));
                let density = distribution.density(lanes, &places.load(lanes, query), local);
                lanes.store_partial(&mut pdfs[at + query..end], density);
                query += L::LANES;
            }
            at = end;
        }
    }
}

/// How bright the surface is for many directions.
struct Brightnesses<'a> {
    distribution: &'a Distribution,
    known: &'a [[f32; 3]],
    out: &'a mut [f32],
}

impl Kernel for Brightnesses<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Brightnesses { distribution, known, out } = self;
        let known = Directions::from(known);
        let (mut padding, mut places) = (PADDING, Places::ZERO);
        let mut at = 0;
        while at < out.len() {
            let end = out.len().min(at + BLOCK);
            let known = known.block(at, &mut padding);
            call(lanes, Locate { distribution, known, count: end - at, places: &mut places });
            let mut query = 0;
            while at + query < end {
                let incident = Incident::new(lanes, &distribution.surface, known.load(lanes, query));
                let brightness = distribution.brightness(lanes, &places.load(lanes, query), incident.valid);
                lanes.store_partial(&mut out[at + query..end], brightness);
                query += L::LANES;
            }
            at = end;
        }
    }
}

/// The slices about the incident directions of a block.
pub(super) struct Places {
    block: Column<i32>,
    pub(super) weights: [Column; 4],
}

impl Places {
    pub(super) const ZERO: Self = Places { block: Column::<i32>::ZERO, weights: [Column::<f32>::ZERO; 4] };

    #[inline(always)]
    pub(super) fn load<L: Lanes>(&self, lanes: L, at: usize) -> Place<L> {
        let [a, b, c, d] = &self.weights;
        let weights = [a.load(lanes, at), b.load(lanes, at), c.load(lanes, at), d.load(lanes, at)];
        Place { block: self.block.load(lanes, at), weights }
    }
}

/// Finds the slices of a block. Draws, densities and brightnesses call it, so that it is compiled once.
struct Locate<'a> {
    distribution: &'a Distribution,
    known: DirectionBlock<'a>,
    count: usize,
    places: &'a mut Places,
}

impl Kernel for Locate<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Locate { distribution, known, count, places } = self;
        let mut query = 0;
        while query < count {
            let incident = Incident::new(lanes, &distribution.surface, known.load(lanes, query));
            let Place { block, weights } = place(lanes, distribution, &incident);
            places.block.store(lanes, query, block);
            let mut slice = 0;
            while slice < 4 {
                places.weights[slice].store(lanes, query, weights[slice]);
                slice += 1;
            }
            query += L::LANES;
        }
    }
}
