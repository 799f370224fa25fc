//! Samples and densities of many directions in SIMD lanes.
//!
//! A block of samples first finds the patches of the light, then takes each step of the search among the sums of a row
//! for all of its queries, and then finds directions in the patches of the viewer.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use lobe_backend::Backend;
use lobe_lane::{Block, Floats, Ints, Kernel, Lanes, call};

use super::PatchSampler;
use crate::Scatter;
use crate::directions::{DirectionBlock, PADDING, Padding};
use crate::passes::block::{Column, registers};
use crate::passes::blocks::{Blocks, Blockwise};
use crate::passes::pairs::{PairPadding, Pairs};
use crate::passes::unit::unit;
use crate::sampling::block::store;
use crate::sampling::queries::{Brightnesses, Densities, Draws};
use crate::window::klems::AngleBasis;
use crate::window::klems::lanes::{PatchScratch, Patches};

/// Floats per patch of [`Lookup::places`].
const PLACE: usize = 8;
/// The position there of the density of a patch that has all the light.
const PER_ANGLE: usize = 6;

/// Finds patches, and directions in them.
#[derive(Clone, Debug)]
pub(super) struct Lookup {
    arriving: Patches,
    leaving: Patches,
    /// For each exit patch: the start and the width in azimuth, the same for the squared sine of the polar angle and
    /// for its squared cosine, which starts at the other end so that small values keep their digits, and the inverse of
    /// the projected solid angle.
    places: Vec<f32>,
}

impl Lookup {
    /// `None` if single precision does not distinguish the rings, or a 32-bit index cannot address all pairs of
    /// patches.
    pub(super) fn new(incident: &AngleBasis, exit: &AngleBasis) -> Option<Self> {
        i32::try_from(incident.patches() * exit.patches()).ok()?;
        let (arriving, leaving) = (Patches::arriving(incident).ok()?, Patches::leaving(exit).ok()?);
        let mut places = Vec::with_capacity(exit.patches() * PLACE);
        for ring in exit.rings() {
            let ([low_sin, low_cos], [high_sin, high_cos]) = (squares(ring.lower), squares(ring.upper));
            let width = TAU / f64::from(ring.patches);
            let angle = PI * (low_cos - high_cos) / f64::from(ring.patches);
            let per_angle = if angle > 0.0 { 1.0 / angle } else { 0.0 };
            for sector in 0..ring.patches {
                let begin = (f64::from(sector) - 0.5) * width;
                let place = [begin, width, low_sin, high_sin - low_sin, high_cos, low_cos - high_cos, per_angle, 0.0];
                places.extend(place.map(|x| x as f32));
            }
        }
        Some(Lookup { arriving, leaving, places })
    }
}

/// The squared sine and cosine of an angle in degrees.
fn squares(degrees: f64) -> [f64; 2] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [sin * sin, cos * cos]
}

impl PatchSampler {
    /// A direction and its density, 1/sr, for light from each of the `known` directions, on either side, and two
    /// numbers in `[0, 1)`; zeros if the known direction is in no patch.
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

    /// The sampling of many directions as a kernel, for lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// The same as for [`draw_batch`](Self::draw_batch).
    pub fn drawing<'a>(
        &'a self,
        known: &'a [[f32; 3]],
        u: &'a [[f32; 2]],
        directions: &'a mut [[f32; 3]],
        pdfs: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        Blocks(Draws::new(self, known, u, directions, pdfs))
    }

    /// The density, 1/sr, with which each of the `other` directions is drawn for light from the known one.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn pdf_batch(&self, backend: Backend, known: &[[f32; 3]], other: &[[f32; 3]], pdfs: &mut [f32]) {
        backend.run(self.densities(known, other, pdfs));
    }

    /// The densities of many pairs as a kernel, for lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// The same as for [`pdf_batch`](Self::pdf_batch).
    pub fn densities<'a>(
        &'a self,
        known: &'a [[f32; 3]],
        other: &'a [[f32; 3]],
        pdfs: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        Blocks(Densities::new(self, known, other, pdfs))
    }

    /// The integral of luminance times `f` times cosine for light from each direction; 0 if it is in no patch.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn brightness_batch(&self, backend: Backend, known: &[[f32; 3]], out: &mut [f32]) {
        backend.run(Blocks(Brightnesses::new(self, known, out)));
    }
}

/// The patches of the directions of a block.
struct Place {
    toward: [Column; 3],
    found: PatchScratch,
    patch: Column<i32>,
    valid: Column<i32>,
}

impl Place {
    const ZERO: Self = Place {
        toward: [Column::<f32>::ZERO; 3],
        found: PatchScratch::ZERO,
        patch: Column::<i32>::ZERO,
        valid: Column::<i32>::ZERO,
    };
}

/// Finds the patches of a block, on either side of the surface: compiled once for light and for viewers.
struct Find<'a> {
    patches: &'a Patches,
    directions: DirectionBlock<'a>,
    n: usize,
    place: &'a mut Place,
}

impl Kernel for Find<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Find { patches, directions, n, place: Place { toward, found, patch, valid } } = self;
        let n = registers(lanes, n);
        let (zero, none, all) = (lanes.splat(0.0), lanes.splat_int(0), lanes.splat_int(-1));
        let mut query = 0;
        while query < n {
            let vector = directions.load(lanes, query);
            let on_a_side = zero.lt(vector[2]) | vector[2].lt(zero);
            let (vector, points) = unit(lanes, vector);
            let mut axis = 0;
            while axis < 3 {
                toward[axis].store(lanes, query, vector[axis]);
                axis += 1;
            }
            valid.store(lanes, query, lanes.select_int(points & on_a_side, all, none));
            query += L::LANES;
        }
        patches.find(lanes, n, toward, found, patch, valid);
    }
}

/// The intermediate values of sampling.
pub(in crate::sampling) struct DrawScratch {
    light: Place,
    /// The first sum of a row, and the number of patches below the number that is searched for.
    first: Column<i32>,
    cell: Column<i32>,
    below: Column,
    numbers: [Column; 2],
    padding: Padding,
}

impl Blockwise for Draws<'_, PatchSampler> {
    type Scratch = DrawScratch;
    const SCRATCH: DrawScratch = DrawScratch {
        light: Place::ZERO,
        first: Column::<i32>::ZERO,
        cell: Column::<i32>::ZERO,
        below: Column::<f32>::ZERO,
        numbers: [Column::<f32>::ZERO; 2],
        padding: PADDING,
    };

    fn count(&self) -> usize {
        self.u.len()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut DrawScratch) {
        let Draws { sampler: PatchSampler { scatter, exit, sums, lookup, .. }, known, u, directions, pdfs } = self;
        let DrawScratch { light, first, cell, below, numbers: [numbers, others], padding } = scratch;
        let n = registers(lanes, queries.len());
        let directions_of_light = known.block(lanes, queries.start, padding);
        call(lanes, Find { patches: &lookup.arriving, directions: directions_of_light, n, place: &mut *light });
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let count = lanes.splat_int(exit.patches() as i32);
        let u = &u[queries.clone()];
        let mut query = 0;
        while query < n {
            // Beyond the last pair of numbers, that pair is read again.
            let [number, other] = lanes.gather_pair(u, lanes.iota() + lanes.splat_int(query as i32));
            numbers.store(lanes, query, number.max(zero).min(lanes.splat(1.0 - f32::EPSILON / 2.0)));
            others.store(lanes, query, other.max(zero).min(one));
            first.store(lanes, query, light.patch.load(lanes, query) * count);
            query += L::LANES;
        }

        *cell = Column::<i32>::ZERO;
        *below = Column::<f32>::ZERO;
        let mut half = (exit.patches().next_power_of_two() >> 1) as i32;
        while half > 0 {
            let mut query = 0;
            while query < n {
                let (at, from) = (cell.load(lanes, query), first.load(lanes, query));
                let next = at + lanes.splat_int(half);
                // The last sum of a row is 1, which no number reaches.
                let sum = lanes.gather(sums, from + next.min(count) - lanes.splat_int(1));
                let passed = sum.le(numbers.load(lanes, query));
                cell.store(lanes, query, lanes.select_int(passed, next, at));
                below.store(lanes, query, lanes.select(passed, sum, below.load(lanes, query)));
                query += L::LANES;
            }
            half >>= 1;
        }

        let places = Block::<2, 4>::new(&lookup.places, [0, 4]);
        let same = if *scatter == Scatter::Reflection { 1.0 } else { -1.0 };
        let mut query = 0;
        while query < n {
            let (cell, below) = (cell.load(lanes, query), below.load(lanes, query));
            let mass = lanes.gather(sums, first.load(lanes, query) + cell) - below;
            let within = ((numbers.load(lanes, query) - below) / mass).max(zero).min(one);
            let within = lanes.select(zero.lt(mass), within, lanes.splat(0.5));
            let [[begin, width, sin2, more_sin2], [cos2, more_cos2, per_angle, _]] =
                lanes.gather_quads(&places, cell.shl::<3>());
            let (sin_phi, cos_phi) = lobe_math::sin_cos(lanes, lanes.mul_add(within, width, begin));
            let other = others.load(lanes, query);
            let across = lanes.mul_add(other, more_sin2, sin2).max(zero).sqrt();
            // Rounding must not move a direction into the surface.
            let up = lanes.mul_add(one - other, more_cos2, cos2).max(zero).sqrt().max(lanes.splat(1e-9));
            let valid = light.valid.load(lanes, query).lt(lanes.splat_int(0));
            let side = lanes.splat(same).mul_sign(light.toward[2].load(lanes, query));
            let direction =
                [(across * cos_phi).masked(valid), (across * sin_phi).masked(valid), (up * side).masked(valid)];
            store(lanes, &mut directions[queries.clone()][query..], direction);
            lanes.store_partial(&mut pdfs[queries.clone()][query..], (mass * per_angle * up).masked(valid));
            query += L::LANES;
        }
    }
}

/// The intermediate values of densities.
pub(in crate::sampling) struct DensityScratch {
    light: Place,
    viewer: Place,
    padding: PairPadding,
}

impl Blockwise for Densities<'_, PatchSampler> {
    type Scratch = DensityScratch;
    const SCRATCH: DensityScratch =
        DensityScratch { light: Place::ZERO, viewer: Place::ZERO, padding: PairPadding::ZERO };

    fn count(&self) -> usize {
        self.pdfs.len()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut DensityScratch) {
        let Densities { sampler: PatchSampler { scatter, exit, sums, lookup, .. }, known, other, pdfs } = self;
        let DensityScratch { light, viewer, padding } = scratch;
        let n = registers(lanes, queries.len());
        let Pairs { wi: known, wo: other } = padding.block(lanes, known, other, queries.start);
        call(lanes, Find { patches: &lookup.arriving, directions: known, n, place: &mut *light });
        call(lanes, Find { patches: &lookup.leaving, directions: other, n, place: &mut *viewer });
        let (zero, none, one) = (lanes.splat(0.0), lanes.splat_int(0), lanes.splat_int(1));
        let (count, place) = (lanes.splat_int(exit.patches() as i32), lanes.splat_int(PLACE as i32));
        let reflects = *scatter == Scatter::Reflection;
        let pdfs = &mut pdfs[queries];
        let mut query = 0;
        while query < pdfs.len() {
            let patch = viewer.patch.load(lanes, query);
            let at = light.patch.load(lanes, query) * count + patch;
            let below = lanes.gather(sums, at - one).masked(none.lt(patch));
            let mass = lanes.gather(sums, at) - below;
            let per_angle = lanes.gather(&lookup.places, patch * place + lanes.splat_int(PER_ANGLE as i32));
            let (from, to) = (light.toward[2].load(lanes, query), viewer.toward[2].load(lanes, query));
            let across = from.lt(zero) ^ to.lt(zero);
            let fits = if reflects { !across } else { across };
            let valid = light.valid.load(lanes, query).lt(none) & viewer.valid.load(lanes, query).lt(none) & fits;
            lanes.store_partial(&mut pdfs[query..], (mass * per_angle * to.abs()).masked(valid));
            query += L::LANES;
        }
    }
}

/// The intermediate values of brightnesses.
pub(in crate::sampling) struct BrightnessScratch {
    light: Place,
    padding: Padding,
}

impl Blockwise for Brightnesses<'_, PatchSampler> {
    type Scratch = BrightnessScratch;
    const SCRATCH: BrightnessScratch = BrightnessScratch { light: Place::ZERO, padding: PADDING };

    fn count(&self) -> usize {
        self.out.len()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut BrightnessScratch) {
        let Brightnesses { sampler: PatchSampler { brightness, lookup, .. }, known, out } = self;
        let BrightnessScratch { light, padding } = scratch;
        let n = registers(lanes, queries.len());
        let known = known.block(lanes, queries.start, padding);
        call(lanes, Find { patches: &lookup.arriving, directions: known, n, place: &mut *light });
        let out = &mut out[queries];
        let mut query = 0;
        while query < out.len() {
            let valid = light.valid.load(lanes, query).lt(lanes.splat_int(0));
            let found = lanes.gather(brightness, light.patch.load(lanes, query));
            lanes.store_partial(&mut out[query..], found.masked(valid));
            query += L::LANES;
        }
    }
}
