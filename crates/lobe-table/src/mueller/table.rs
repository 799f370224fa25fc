//! What unpolarised light sees of [`Data`], made ready to be evaluated in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Block, Floats, Kernel, Lanes};

use super::data::{AXES, Data, ELEMENTS};
use crate::directions::Directions;
use crate::grid::axis::Axis;
use crate::grid::cells;
use crate::grid::edges::Edge;
use crate::grid::texels::{self, Located};
use crate::grid::weights::{self, MAX_CORNERS};
use crate::invalid::Invalid;
use crate::passes::block::Column;
use crate::passes::half_vector::HalfVector;
use crate::passes::pairs::{Evaluate, Pairs, evaluation};
use lobe_memory::Storage;

/// Stored where nothing was measured. However small its part in a blend, the result is far below 0 and becomes 0.
const UNMEASURED: f32 = f32::MIN;

/// The values that unpolarised light has, laid out for evaluation in SIMD lanes: the first element of the matrix, at each
/// wavelength of the table.
///
/// The values are those of [`Data::in_plane`], in `f32`: `f` in 1/sr, without the cosine. The directions need not be unit
/// vectors, but their lengths have to be between 1e-15 and 1e15. In strict form
/// ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    channels: usize,
    /// `phi_d`, `theta_d` and `theta_h`.
    axes: [Axis; 3],
    /// Floats from a node to the next along each axis.
    strides: [usize; 3],
    /// The corners of a cell, from its first node.
    corners: [usize; 8],
    /// `[phi_d][theta_d][theta_h][wavelength]`, the wavelengths padded to eights.
    texels: Storage<f32>,
}

impl Table {
    /// Lays out the first elements: 4 bytes each, a sixteenth of the matrices.
    ///
    /// # Errors
    /// [`Invalid`] names an axis, or `M` if the elements are more than the 32-bit index of a lane reaches.
    pub fn new(data: &Data) -> Result<Self, Invalid> {
        let axis = |index: usize| {
            let knots: Vec<f64> = data.knots()[index].iter().map(|knot| f64::from(*knot)).collect();
            Axis::new(&knots, Edge::Clamp)
                .map_err(|error| Invalid::new(AXES[index], error.to_string(), "ascending knots"))
        };
        let axes = [axis(0)?, axis(1)?, axis(2)?];
        let channels = data.knots()[3].len();
        let width = channels.next_multiple_of(8);
        let [phi_d, theta_d, theta_h] = [0, 1, 2].map(|index: usize| axes[index].knots().len());
        let row = width.checked_mul(theta_h);
        let slice = row.and_then(|row| row.checked_mul(theta_d));
        let len = slice.and_then(|slice| slice.checked_mul(phi_d)).filter(|len| i32::try_from(*len).is_ok());
        let (Some(row), Some(slice), Some(len)) = (row, slice, len) else {
            let found = format!("{phi_d} x {theta_d} x {theta_h} nodes of {channels} wavelengths");
            return Err(Invalid::new("M", found, "a table that a 32-bit index reaches"));
        };
        let mut texels = Storage::zeros(len);
        let nodes = data.values().chunks_exact(channels * ELEMENTS);
        for (target, matrices) in texels.as_mut_slice().chunks_exact_mut(width).zip(nodes) {
            for (target, matrix) in target.iter_mut().zip(matrices.chunks_exact(ELEMENTS)) {
                *target = if matrix[0].is_nan() { UNMEASURED } else { matrix[0] };
            }
        }
        let strides = [slice, row, width];
        let steps: [usize; 3] =
            std::array::from_fn(|axis| if axes[axis].knots().len() > 1 { strides[axis] } else { 0 });
        let corners = std::array::from_fn(|corner| {
            (0..3).map(|axis| if corner >> (2 - axis) & 1 == 1 { steps[axis] } else { 0 }).sum()
        });
        Ok(Table { channels, axes, strides, corners, texels })
    }

    /// How many wavelengths there are.
    pub fn channel_count(&self) -> usize {
        self.channels
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        self.texels.bytes() + self.axes.iter().map(Axis::bytes).sum::<usize>()
    }

    /// Evaluates `f` in 1/sr of many pairs on a backend: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// As [`batch`](Self::batch).
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`]: `out[query * channels + channel]`,
    /// in 1/sr.
    ///
    /// # Panics
    /// If there are not as many `wi` as `wo`, or `out` is not that many times the wavelengths long.
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        out: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        evaluation(self, wi, wo, out)
    }
}

/// What the passes of a block hand on.
pub(crate) struct Scratch {
    angles: HalfVector,
    base: Column<i32>,
    weights: [Column; MAX_CORNERS],
}

impl Evaluate for &Table {
    type Scratch = Scratch;
    const SCRATCH: Scratch =
        Scratch { angles: HalfVector::ZERO, base: Column::<i32>::ZERO, weights: [Column::<f32>::ZERO; MAX_CORNERS] };

    fn channel_count(self) -> usize {
        self.channels
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch, out: &mut [f32]) {
        let Scratch { angles, base, weights } = scratch;
        angles.run::<L, true>(lanes, n, pairs);
        let HalfVector { theta_h, theta_d, phi_d, valid, .. } = angles;
        *base = Column::<i32>::ZERO;
        let by_axis = [&mut *phi_d, &mut *theta_d, &mut *theta_h];
        let mut axis = 0;
        while axis < by_axis.len() {
            cells::run(lanes, n, &self.axes[axis], self.strides[axis], by_axis[axis], base, valid);
            within(lanes, n, by_axis[axis]);
            axis += 1;
        }
        weights::run(lanes, n, [phi_d, theta_d, theta_h], valid, 1.0, weights);
        let block = Block::new(self.texels.as_slice(), self.corners);
        texels::wide(lanes, &block, 0..self.channels, Located { base, weights }, 0.0, out);
    }
}

/// No weight may be negative, not even by rounding: [`UNMEASURED`] would turn into light.
#[inline(always)]
fn within<L: Lanes>(lanes: L, n: usize, fraction: &mut Column) {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let mut query = 0;
    while query < n {
        fraction.store(lanes, query, fraction.load(lanes, query).max(zero).min(one));
        query += L::LANES;
    }
}
