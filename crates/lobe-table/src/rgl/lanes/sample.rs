//! Sampling many directions.

use std::ops::Range;

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes, call};

use super::passes::{Scratch, Slices, Values};
use super::reflect::{self, Reflected};
use super::table::Table;
use super::{angles, draw};
use crate::directions::{Directions, PADDING, Padding};
use crate::passes::block::{BLOCK, Column, registers};
use crate::passes::blocks::{Blocks, Blockwise};
use crate::rgl::UniformOrder;

/// The outputs of sampling. Everything is 0 for a sample that is not above the surface.
#[derive(Debug)]
pub struct Drawn<'a> {
    /// The directions.
    pub wo: &'a mut [[f32; 3]],
    /// Their probability densities over solid angle, 1/sr.
    pub pdf: &'a mut [f32],
    /// `f cos(theta_o) / pdf`: `[query][channel]`.
    pub weights: &'a mut [f32],
}

impl Table {
    /// Draws a `wo` for each `wi` from two numbers in `[0, 1)`, on a backend.
    ///
    /// # Panics
    /// If the numbers of `wi`, uniforms, directions and densities differ, or there is not one weight per direction and
    /// channel.
    pub fn sample_batch(
        &self,
        backend: Backend,
        wi: Directions<'_>,
        uniforms: &[[f32; 2]],
        order: UniformOrder,
        drawn: Drawn<'_>,
    ) {
        backend.run(self.sampling(wi, uniforms, order, drawn));
    }

    /// The sampling of many directions as a kernel, for lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// The same as for [`sample_batch`](Table::sample_batch).
    pub fn sampling<'a>(
        &'a self,
        wi: Directions<'a>,
        uniforms: &'a [[f32; 2]],
        order: UniformOrder,
        drawn: Drawn<'a>,
    ) -> impl Kernel<Out = ()> + 'a {
        let count = wi.count();
        assert_eq!(uniforms.len(), count, "two numbers for each wi");
        assert_eq!(drawn.wo.len(), count, "a direction for each wi");
        assert_eq!(drawn.pdf.len(), count, "a density for each wi");
        assert_eq!(drawn.weights.len(), count * self.channel_count(), "a weight for each wi and channel");
        Sampling { table: self, wi, uniforms, order, drawn }
    }
}

/// All samples of a batch, with blends of `SLICES`: `PAIRS` corners of a cell in one dimension, and `FOURS` in two.
struct Draws<'a, const SLICES: usize, const PAIRS: usize, const FOURS: usize> {
    table: &'a Table,
    wi: Directions<'a>,
    uniforms: &'a [[f32; 2]],
    order: UniformOrder,
    drawn: Drawn<'a>,
}

/// The intermediate values of sampling.
struct DrawScratch {
    passes: Scratch,
    wo: [Column; 3],
    padding: Padding,
}

impl<const SLICES: usize, const PAIRS: usize, const FOURS: usize> Blockwise for Draws<'_, SLICES, PAIRS, FOURS> {
    type Scratch = DrawScratch;
    const SCRATCH: DrawScratch = DrawScratch { passes: Scratch::ZERO, wo: [Column::<f32>::ZERO; 3], padding: PADDING };

    fn count(&self) -> usize {
        self.wi.count()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut DrawScratch) {
        let Draws { table, wi, uniforms, order, drawn } = self;
        let DrawScratch { passes: scratch, wo, padding } = scratch;
        let (at, left, channels) = (queries.start, queries.len(), table.channel_count());
        let n = registers(lanes, left);
        let wi = wi.block(lanes, at, padding);
        let Scratch { frame, incident, blend, u_m, s, density, weights, .. } = &mut *scratch;
        reflect::incident(lanes, n, wi, table.symmetry, frame);
        angles::incident(lanes, n, table.azimuthal, frame, incident);
        call(lanes, Slices::<SLICES> { table, n, valid: &mut frame.valid, incident, blend: &mut *blend });
        let [first, second] = match order {
            UniformOrder::Powitacq => [1, 0],
            UniformOrder::Pbrt => [0, 1],
        };
        let numbers = &uniforms[at..][..left];
        let mut query = 0;
        while query < left {
            s[0].0[query] = numbers[query][first];
            s[1].0[query] = numbers[query][second];
            query += 1;
        }
        *density = Column([1.0; BLOCK]);
        // First warped by the luminance, and then by the visible normals.
        *u_m = *s;
        let mut step = 0;
        while step < 2 {
            *s = *u_m;
            let warp = if step == 0 { &table.luminance } else { &table.vndf };
            draw::run::<L, SLICES>(lanes, n, warp, blend, weights, u_m, density);
            step += 1;
        }
        reflect::run(lanes, n, wi, table.symmetry, u_m, frame, Reflected { wo, density });
        let out = &mut drawn.weights[at * channels..][..left * channels];
        call(lanes, Values::<SLICES, PAIRS, FOURS> { table, n, scratch: &mut *scratch, out });
        drawn.pdf[at..][..left].copy_from_slice(&scratch.density.0[..left]);
        let directions = &mut drawn.wo[at..][..left];
        let mut query = 0;
        while query < left {
            directions[query] = [wo[0].one(query), wo[1].one(query), wo[2].one(query)];
            query += 1;
        }
    }
}

/// The kernel for the slices that a table blends.
struct Sampling<'a> {
    table: &'a Table,
    wi: Directions<'a>,
    uniforms: &'a [[f32; 2]],
    order: UniformOrder,
    drawn: Drawn<'a>,
}

impl Kernel for Sampling<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Sampling { table, wi, uniforms, order, drawn } = self;
        if table.blends_azimuths() {
            Blocks(Draws::<4, 8, 16> { table, wi, uniforms, order, drawn }).run(lanes);
        } else {
            Blocks(Draws::<2, 4, 8> { table, wi, uniforms, order, drawn }).run(lanes);
        }
    }
}
