//! Whole matrices, prepared for evaluation in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Block, Kernel, Lanes};

use super::data::{Data, ELEMENTS};
use super::places::{Places, Scratch};
use crate::directions::Directions;
use crate::grid::texels::{self, Located};
use crate::invalid::Invalid;
use crate::passes::pairs::{Evaluate, Pairs, evaluation};
use crate::passes::stokes::{self, Stokes};
use lobe_memory::Storage;

/// Whole Mueller matrices at each wavelength of the data, laid out for evaluation in SIMD lanes.
///
/// The matrices are those of [`Data::eval`], in `f32`, in 1/sr, without the cosine: they map Stokes vectors with the x
/// axis [`stokes_basis`](super::stokes_basis)`(-wi)` to Stokes vectors with the x axis `stokes_basis(wo)`. A matrix
/// with a NaN element is unmeasured; it is 0, and so is any blend that includes it. The directions need not be unit
/// vectors, but their lengths have to be between 1e-15 and 1e15. In strict form
/// ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Matrices {
    wavelengths: usize,
    places: Places,
    /// A first element below this includes an unmeasured matrix.
    least: f32,
    /// `[phi_d][theta_d][theta_h][wavelength][element]`, the elements in the order of [`stokes::stored`].
    texels: Storage<f32>,
}

impl Matrices {
    /// Lays out all elements: 4 bytes each.
    ///
    /// # Errors
    /// [`Invalid`] names an axis, or `M` if there are more elements than a 32-bit index can address.
    pub fn new(data: &Data) -> Result<Self, Invalid> {
        let wavelengths = data.knots()[3].len();
        // Lane indices wrap, and are used as unsigned numbers.
        let places = Places::new(data, wavelengths * ELEMENTS, u32::MAX as usize)?;
        let mut texels = Storage::zeros(places.len);
        let (matrices, _) = data.values().as_chunks::<ELEMENTS>();
        let (targets, _) = texels.as_mut_slice().as_chunks_mut::<ELEMENTS>();
        for (target, matrix) in targets.iter_mut().zip(matrices) {
            *target = stokes::stored(matrix);
        }
        Ok(Matrices { wavelengths, places, least: stokes::least(matrices), texels })
    }

    /// The number of wavelengths.
    pub fn wavelength_count(&self) -> usize {
        self.wavelengths
    }

    /// Bytes of memory that the matrices take.
    pub fn bytes(&self) -> usize {
        self.texels.bytes() + self.places.bytes()
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
    places: Scratch,
    stokes: Stokes,
}

impl Evaluate for &Matrices {
    type Scratch = MatrixScratch;
    const SCRATCH: MatrixScratch = MatrixScratch { places: Scratch::ZERO, stokes: Stokes::ZERO };

    fn channel_count(self) -> usize {
        self.wavelengths * ELEMENTS
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut MatrixScratch, out: &mut [f32]) {
        let MatrixScratch { places, stokes } = scratch;
        self.places.find(lanes, n, pairs, places);
        stokes.run(lanes, n, pairs, &places.angles.valid);
        let Scratch { base, weights, .. } = &*places;
        let block = Block::new(self.texels.as_slice(), self.places.corners);
        let width = self.wavelengths * ELEMENTS;
        texels::wide(lanes, &block, 0..width, Located { base, weights }, f32::MIN, out);
        stokes.refer(lanes, self.wavelengths, self.least, out);
    }
}
