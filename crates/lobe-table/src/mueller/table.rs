//! The elements of [`Data`] for unpolarised light, prepared for evaluation in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Block, Kernel, Lanes};

use super::data::{Data, ELEMENTS};
use super::places::{Places, Scratch};
use crate::directions::Directions;
use crate::grid::texels::{self, Located};
use crate::invalid::Invalid;
use crate::passes::pairs::{Evaluate, Pairs, evaluation};
use lobe_memory::Storage;

/// Stored where nothing was measured. However small its weight in a blend, the result is far below 0 and becomes 0.
pub(super) const UNMEASURED: f32 = f32::MIN;

/// The values for unpolarised light, laid out for evaluation in SIMD lanes: the first element of the matrix, at each
/// wavelength of the table.
///
/// The values are those of [`Data::in_plane`], in `f32`: `f` in 1/sr, without the cosine. The directions need not be
/// unit vectors, but their lengths have to be between 1e-15 and 1e15. In strict form
/// ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    channels: usize,
    places: Places,
    /// `[phi_d][theta_d][theta_h][wavelength]`, with the wavelengths padded to a multiple of eight.
    texels: Storage<f32>,
}

impl Table {
    /// Lays out the first elements: 4 bytes each, a sixteenth of the matrices.
    ///
    /// # Errors
    /// [`Invalid`] names an axis, or `M` if there are more elements than a 32-bit index can address.
    pub fn new(data: &Data) -> Result<Self, Invalid> {
        let channels = data.knots()[3].len();
        let width = channels.next_multiple_of(8);
        let places = Places::new(data, width, i32::MAX as usize)?;
        let mut texels = Storage::zeros(places.len);
        let nodes = data.values().chunks_exact(channels * ELEMENTS);
        for (target, matrices) in texels.as_mut_slice().chunks_exact_mut(width).zip(nodes) {
            for (target, matrix) in target.iter_mut().zip(matrices.chunks_exact(ELEMENTS)) {
                *target = if matrix[0].is_nan() { UNMEASURED } else { matrix[0] };
            }
        }
        Ok(Table { channels, places, texels })
    }

    /// The number of wavelengths.
    pub fn channel_count(&self) -> usize {
        self.channels
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        self.texels.bytes() + self.places.bytes()
    }

    /// Evaluates `f` in 1/sr of many pairs on a backend: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// The same as for [`batch`](Self::batch).
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`]:
    /// `out[query * channels + channel]`, in 1/sr.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of
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

impl Evaluate for &Table {
    type Scratch = Scratch;
    const SCRATCH: Scratch = Scratch::ZERO;

    fn channel_count(self) -> usize {
        self.channels
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch, out: &mut [f32]) {
        self.places.find(lanes, n, pairs, scratch);
        let Scratch { base, weights, .. } = scratch;
        let block = Block::new(self.texels.as_slice(), self.places.corners);
        texels::wide(lanes, &block, 0..self.channels, Located { base, weights }, 0.0, out);
    }
}
