//! Drawing many directions, block by block.

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes, call};

use super::batch::{Scratch, Slices, Values};
use super::{Table, angles, draw, reflect};
use crate::directions::{Directions, PADDING};
use crate::passes::block::{BLOCK, Column};
use crate::rgl::UniformOrder;

/// Where drawn directions go. All is 0 for a sample that is not above the surface.
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
    /// If there are not as many `wi` as uniforms, directions and densities, and that many weights per channel.
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

    /// The drawing of many directions as a kernel, for lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// As [`sample_batch`](Table::sample_batch).
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
        if self.table.blends_azimuths() { self.blocks::<L, 4, 8, 16>(lanes) } else { self.blocks::<L, 2, 4, 8>(lanes) }
    }
}

impl Sampling<'_> {
    /// As in the evaluation of a batch.
    #[inline(always)]
    fn blocks<L: Lanes, const SLICES: usize, const PAIRS: usize, const FOURS: usize>(self, lanes: L) {
        let Sampling { table, wi, uniforms, order, drawn } = self;
        let channels = table.channel_count();
        let count = wi.count();
        let mut scratch = Scratch::ZERO;
        let mut wo = [Column::<f32>::ZERO; 3];
        let mut padding = PADDING;
        let mut at = 0;
        while at < count {
            let left = (count - at).min(BLOCK);
            let n = left.next_multiple_of(L::LANES);
            let block = wi.block(at, &mut padding);
            let Scratch { frame, incident, blend, u_m, s, density, weights, .. } = &mut scratch;
            reflect::incident(lanes, n, block, table.symmetry, frame);
            angles::incident(lanes, n, table.azimuthal, frame, incident);
            call(lanes, Slices::<SLICES> { table, n, valid: &mut frame.valid, incident, blend: &mut *blend });
            let [first, second] = match order {
                UniformOrder::Powitacq => [1, 0],
                UniformOrder::Pbrt => [0, 1],
            };
            for (query, uniform) in uniforms[at..][..left].iter().enumerate() {
                s[0].0[query] = uniform[first];
                s[1].0[query] = uniform[second];
            }
            *density = Column([1.0; BLOCK]);
            // By luminance first, then by the visible normals from there.
            *u_m = *s;
            let mut step = 0;
            while step < 2 {
                *s = *u_m;
                let warp = if step == 0 { &table.luminance } else { &table.vndf };
                draw::run::<L, SLICES>(lanes, n, warp, blend, weights, u_m, density);
                step += 1;
            }
            reflect::run(lanes, n, (block, table.symmetry), (u_m, frame), &mut wo, density);
            let weights = &mut drawn.weights[at * channels..][..left * channels];
            call(lanes, Values::<SLICES, PAIRS, FOURS> { table, n, scratch: &mut scratch, out: weights });
            drawn.pdf[at..][..left].copy_from_slice(&scratch.density.0[..left]);
            for (query, target) in drawn.wo[at..][..left].iter_mut().enumerate() {
                *target = [wo[0].one(query), wo[1].one(query), wo[2].one(query)];
            }
            at += left;
        }
    }
}
