//! Whole matrices, prepared for evaluation in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes};

use super::data::Data;
use crate::directions::Directions;
use crate::grid::interpolation::{Interpolator, Scratch, Source};
use crate::mueller::ELEMENTS;
use crate::passes::pairs::{Evaluate, Pairs, evaluation};
use crate::passes::stokes::{self, Stokes};
use crate::specular::frame::{self, Frame};
use crate::specular::{AXIS_NAMES, angles};
use crate::{Edges, Precision, Scatter, TableError};

/// Whole Mueller matrices on a grid of specular coordinates, laid out for evaluation in SIMD lanes.
///
/// The matrices are those of [`Data::eval`], in `f32`: `out[query][wavelength][row][column]`, in 1/sr, without the
/// cosine. In strict form ([`Lanes::strict`]) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Matrices {
    wavelengths: usize,
    grid: Interpolator,
}

impl Matrices {
    /// Lays out all elements: 4 bytes each.
    ///
    /// # Errors
    /// If there are more elements than a 32-bit index can address, or a periodic axis cannot be closed.
    pub fn new(data: &Data, edges: &Edges) -> Result<Self, TableError> {
        let wavelengths = data.wavelengths().len();
        let (matrices, _) = data.values().as_chunks::<ELEMENTS>();
        let values: Vec<f32> = matrices.iter().flat_map(stokes::stored).collect();
        let source =
            Source { names: &AXIS_NAMES, knots: data.knots(), channels: wavelengths * ELEMENTS, values: &values };
        // Elements have signs; the first is clamped when the frames are known.
        let edges = Edges { non_negative: false, ..*edges };
        Ok(Matrices { wavelengths, grid: Interpolator::new(&source, &edges, Precision::Single)? })
    }

    /// The number of wavelengths.
    pub fn wavelength_count(&self) -> usize {
        self.wavelengths
    }

    /// Bytes of memory that the matrices take.
    pub fn bytes(&self) -> usize {
        self.grid.bytes()
    }

    /// The matrices of many pairs on a backend: `out[query][wavelength][row][column]`.
    ///
    /// # Panics
    /// The same as for [`batch`](Self::batch).
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`]:
    /// `out[query][wavelength][row][column]`.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times 16 times the number of
    /// wavelengths.
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        out: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        evaluation(self, wi, wo, out)
    }
}

/// The intermediate values of a block.
pub(crate) struct MatrixScratch {
    frame: Frame,
    grid: Scratch,
    stokes: Stokes,
}

impl Evaluate for &Matrices {
    type Scratch = MatrixScratch;
    const SCRATCH: MatrixScratch = MatrixScratch { frame: Frame::ZERO, grid: Scratch::ZERO, stokes: Stokes::ZERO };

    fn channel_count(self) -> usize {
        self.wavelengths * ELEMENTS
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut MatrixScratch, out: &mut [f32]) {
        let MatrixScratch { frame, grid, stokes } = scratch;
        frame::run(lanes, n, pairs, Scatter::Reflection, None, frame, &mut grid.valid);
        angles::run(lanes, n, self.grid.is_anisotropic(), frame, &mut grid.angles);
        stokes.run(lanes, n, pairs, &grid.valid);
        self.grid.values(lanes, grid, out);
        stokes.refer(lanes, self.wavelengths, f32::NEG_INFINITY, out);
    }
}
