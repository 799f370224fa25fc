//! [`Data`] prepared for evaluation in SIMD lanes.

use std::f32::consts::FRAC_2_PI;

use lobe_backend::Backend;
use lobe_lane::{Block, Floats, Ints, Kernel, Lanes};

use super::data::{Data, Lookup};
use crate::directions::Directions;
use crate::grid::texels::{self, Located, Tile};
use crate::grid::weights::{self, MAX_CORNERS};
use crate::invalid::Invalid;
use crate::passes::block::{BLOCK, Column};
use crate::passes::half_vector::HalfVector;
use crate::passes::pairs::{Evaluate, Pairs, evaluation};
use lobe_memory::Storage;

/// Floats of a bin: three channels, and 1 if the bin was measured. All four are 0 if it was not.
const TEXEL: usize = 4;

/// [`Data`] laid out for evaluation in SIMD lanes.
///
/// The values are those of [`Data::eval_nearest`] and [`Data::eval_linear`], in `f32`: `f` in 1/sr, linear RGB. The
/// directions need not be unit vectors, but their lengths have to be between 1e-15 and 1e15. A query that is within
/// rounding of the border of two bins may get the value of either; see [`Data::candidates`].
///
/// In strict form ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    bins: [usize; 3],
    period: f32,
    /// Floats from a bin to the next along `theta_h`, `theta_d` and `phi_d`.
    strides: [usize; 3],
    /// `[theta_h][theta_d][phi_d]`, with the first `phi_d` repeated after the last, and a dark bin at the end.
    texels: Storage<f32>,
}

impl Table {
    /// Lays out the bins: 16 bytes each.
    ///
    /// # Errors
    /// [`Invalid`] if there are more bins than a 32-bit index can address.
    pub fn new(data: &Data) -> Result<Self, Invalid> {
        let [h, d, p] = data.bins();
        let row = (p + 1).checked_mul(TEXEL);
        let slice = row.and_then(|row| row.checked_mul(d));
        let len = slice.and_then(|slice| slice.checked_mul(h)?.checked_add(TEXEL));
        let (Some(row), Some(slice), Some(len)) = (row, slice, len.filter(|len| i32::try_from(*len).is_ok())) else {
            let found = format!("{:?} bins", data.bins());
            return Err(Invalid::new("dims", found, "a table that a 32-bit index reaches"));
        };
        let mut texels = Storage::zeros(len);
        let mut target = texels.as_mut_slice().chunks_exact_mut(TEXEL);
        for theta_h in 0..h {
            for theta_d in 0..d {
                for phi_d in 0..=p {
                    let target = target.next().expect("a texel per bin");
                    let bin = [theta_h, theta_d, phi_d % p];
                    if data.is_measured(bin) {
                        let [r, g, b] = data.texel(bin);
                        target.copy_from_slice(&[r, g, b, 1.0]);
                    }
                }
            }
        }
        Ok(Table { bins: [h, d, p], period: data.period() as f32, strides: [slice, row, TEXEL], texels })
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        self.texels.bytes()
    }

    /// Evaluates `f` in 1/sr of many pairs on a backend: `out[3 * query + channel]`.
    ///
    /// # Panics
    /// The same as for [`batch`](Self::batch).
    pub fn eval_batch(
        &self,
        backend: Backend,
        lookup: Lookup,
        wi: Directions<'_>,
        wo: Directions<'_>,
        out: &mut [f32],
    ) {
        backend.run(self.batch(lookup, wi, wo, out));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`]: `out[3 * query + channel]`, in
    /// 1/sr.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or `out` is not three times as long.
    pub fn batch<'a>(
        &'a self,
        lookup: Lookup,
        wi: Directions<'a>,
        wo: Directions<'a>,
        out: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        evaluation(Evaluator { table: self, lookup }, wi, wo, out)
    }
}

#[derive(Clone, Copy)]
struct Evaluator<'a> {
    table: &'a Table,
    lookup: Lookup,
}

/// The intermediate values of a block.
struct Scratch {
    angles: HalfVector,
    base: Column<i32>,
    /// Places along `theta_h`, `theta_d` and `phi_d`, in bins; then the fractions between the middles of two bins.
    places: [Column; 3],
    weights: [Column; MAX_CORNERS],
    tile: Tile,
}

impl Evaluate for Evaluator<'_> {
    type Scratch = Scratch;
    const SCRATCH: Scratch = Scratch {
        angles: HalfVector::ZERO,
        base: Column::<i32>::ZERO,
        places: [Column::<f32>::ZERO; 3],
        weights: [Column::<f32>::ZERO; MAX_CORNERS],
        tile: [[0.0; BLOCK]; 4],
    };

    fn channel_count(self) -> usize {
        3
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch, out: &mut [f32]) {
        let table = self.table;
        scratch.angles.run::<L, false>(lanes, n, pairs);
        table.places(lanes, n, scratch);
        match self.lookup {
            Lookup::Nearest => {
                table.bins(lanes, n, scratch);
                let block = Block::new(table.texels.as_slice(), [0]);
                texels::nearest(lanes, n, &block, &scratch.base, &mut scratch.tile);
            }
            Lookup::Linear => {
                table.middles(lanes, n, scratch);
                let Scratch { angles, base, places: [h, d, p], weights, tile } = scratch;
                weights::run(lanes, n, [h, d], &angles.valid, 1.0, weights);
                let block = Block::new(table.texels.as_slice(), table.corners());
                texels::measured(lanes, n, &block, Located { base, weights }, p, tile);
            }
        }
        out.copy_from_slice(&scratch.tile.as_flattened()[..out.len()]);
    }
}

impl Table {
    /// The offsets of the next bins of `theta_h` and `theta_d`; those of `phi_d` are adjacent.
    #[inline(always)]
    fn corners(&self) -> [usize; 4] {
        let h = if self.bins[0] > 1 { self.strides[0] } else { 0 };
        let d = if self.bins[1] > 1 { self.strides[1] } else { 0 };
        [0, d, h, h + d]
    }

    /// Converts angles to places in bins.
    #[inline(always)]
    fn places<L: Lanes>(&self, lanes: L, n: usize, scratch: &mut Scratch) {
        let Scratch { angles, places: [h, d, p], .. } = scratch;
        let [h_bins, d_bins, p_bins] = self.bins;
        let h_scale = lanes.splat(h_bins as f32);
        let d_scale = lanes.splat(d_bins as f32 * FRAC_2_PI);
        let p_scale = lanes.splat(p_bins as f32 / self.period);
        let (quarter_turns, period, zero) = (lanes.splat(FRAC_2_PI), lanes.splat(self.period), lanes.splat(0.0));
        let mut query = 0;
        while query < n {
            h.store(lanes, query, (angles.theta_h.load(lanes, query) * quarter_turns).sqrt() * h_scale);
            d.store(lanes, query, angles.theta_d.load(lanes, query) * d_scale);
            let phi = angles.phi_d.load(lanes, query);
            p.store(lanes, query, (phi + period.masked(phi.lt(zero))) * p_scale);
            query += L::LANES;
        }
    }

    /// Converts places to their bins, or to the dark bin if a query is not valid.
    #[inline(always)]
    fn bins<L: Lanes>(&self, lanes: L, n: usize, scratch: &mut Scratch) {
        let Scratch { angles, base, places: [h, d, p], .. } = scratch;
        let [h_bins, d_bins, p_bins] = self.bins;
        let (h_last, d_last) = (lanes.splat_int(h_bins as i32 - 1), lanes.splat_int(d_bins as i32 - 1));
        let p_last = lanes.splat_int(p_bins as i32 - 1);
        let [h_stride, d_stride, p_stride] = self.strides;
        let (h_stride, d_stride) = (lanes.splat_int(h_stride as i32), lanes.splat_int(d_stride as i32));
        let p_stride = lanes.splat_int(p_stride as i32);
        let (zero, dark) = (lanes.splat_int(0), lanes.splat_int(-1));
        let mut query = 0;
        while query < n {
            let h = h.load(lanes, query).to_int().min(h_last);
            let d = d.load(lanes, query).to_int().min(d_last);
            let p = p.load(lanes, query).to_int().min(p_last);
            let bin = h * h_stride + d * d_stride + p * p_stride;
            // An index outside the table becomes the last one, the dark bin.
            let valid = angles.valid.load(lanes, query).lt(zero);
            base.store(lanes, query, lanes.select_int(valid, bin, dark));
            query += L::LANES;
        }
    }

    /// Converts places to the lower of the two bins whose middles surround them, and the fraction between these.
    #[inline(always)]
    fn middles<L: Lanes>(&self, lanes: L, n: usize, scratch: &mut Scratch) {
        let Scratch { base, places, .. } = scratch;
        *base = Column::<i32>::ZERO;
        let (half, zero) = (lanes.splat(0.5), lanes.splat(0.0));
        let mut axis = 0;
        while axis < places.len() {
            let place = &mut places[axis];
            let bins = self.bins[axis];
            let is_circle = axis == 2;
            // The value is constant beyond the first and last middle; on a circle, the first bin repeats.
            let (end, last) = if is_circle { (bins, bins - 1) } else { (bins - 1, bins.saturating_sub(2)) };
            let (end, last) = (lanes.splat(end as f32), lanes.splat_int(last as i32));
            let turn = if is_circle { end } else { zero };
            let stride = lanes.splat_int(self.strides[axis] as i32);
            let mut query = 0;
            while query < n {
                let x = place.load(lanes, query) - half;
                let x = (x + turn.masked(x.lt(zero))).max(zero).min(end);
                let low = x.to_int().min(last);
                place.store(lanes, query, x - low.to_float());
                base.store(lanes, query, base.load(lanes, query) + low * stride);
                query += L::LANES;
            }
            axis += 1;
        }
    }
}
