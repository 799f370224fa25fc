//! [`Data`] prepared for evaluation in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes, MAX_LANES};

use super::coordinates::{self, Azimuths, Sides};
use super::data::{AXIS_NAMES, Data};
use crate::directions::Directions;
use crate::grid::interpolation::{Interpolator, Scratch, Source};
use crate::passes::pairs::{Evaluate, LanePairs, Pairs, evaluation};
use crate::{Channels, Edge, Edges, Precision, Scatter, TableError};

/// [`Data`] laid out for evaluation in SIMD lanes.
///
/// The values are those of [`Data::eval`], in `f32`: `f` in 1/sr, without the cosine. They are 0 for directions on
/// opposite sides of a BRDF, on the same side of a BTDF, and for directions that graze the surface. The directions need
/// not be unit vectors, but their lengths have to be between 1e-15 and 1e15.
///
/// In strict form ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    scatter: Scatter,
    channels: Channels,
    azimuths: Azimuths,
    grid: Interpolator,
}

impl Table {
    /// Lays out the values: 16 bytes per node with up to three channels, and more for more channels.
    ///
    /// # Errors
    /// If the grid is too large to be indexed, or its azimuths cannot be closed to a circle.
    pub fn new(data: &Data) -> Result<Self, TableError> {
        let knots = data.knots();
        let source = Source { names: &AXIS_NAMES, knots, channels: data.channels().count(), values: data.values() };
        let last = if data.is_mirrored() { Edge::Clamp } else { Edge::Periodic };
        let edges = Edges { axes: [Edge::Clamp, Edge::Periodic, Edge::Clamp, last], non_negative: false };
        let azimuths = match (data.is_mirrored(), data.is_isotropic()) {
            (true, _) => Azimuths::Unsigned,
            (_, true) => {
                let (sin, cos) = knots[1][0].sin_cos();
                Azimuths::Between([cos as f32, sin as f32])
            }
            (_, false) => Azimuths::Both,
        };
        Ok(Table {
            scatter: data.scatter(),
            channels: data.channels().clone(),
            azimuths,
            grid: Interpolator::new(&source, &edges, Precision::Single)?,
        })
    }

    /// Reflection or transmission.
    pub fn scatter(&self) -> Scatter {
        self.scatter
    }

    /// The meaning of the channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// The number of channels.
    pub fn channel_count(&self) -> usize {
        self.grid.channels()
    }

    /// `true` if the value depends only on the difference of the azimuths.
    pub fn is_isotropic(&self) -> bool {
        !self.grid.is_anisotropic()
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        self.grid.bytes()
    }

    /// Evaluates many pairs on a backend: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// The same as for [`batch`](Self::batch).
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`]:
    /// `out[query * channels + channel]`.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of channels.
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        out: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        evaluation(self, wi, wo, out)
    }

    /// Evaluates one pair per lane inside a caller's own kernel: `out[channel]` holds that channel in all lanes, 0 in
    /// the lanes that `mask` leaves out.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    #[inline(always)]
    pub fn eval_lanes<L: Lanes>(&self, lanes: L, wi: [L::F; 3], wo: [L::F; 3], mask: L::M, out: &mut [L::F]) {
        assert_eq!(out.len(), self.channel_count(), "one output per channel");
        let pairs = LanePairs::new(lanes, wi, wo, mask);
        let mut scratch = Scratch::<MAX_LANES>::ZERO;
        self.angles(lanes, L::LANES, pairs.block(), &mut scratch);
        self.grid.find(lanes, L::LANES, &mut scratch);
        self.grid.blend_lanes(lanes, &mut scratch, out);
    }

    /// Converts the directions of queries `0..n` to angles.
    #[inline(always)]
    fn angles<L: Lanes, const B: usize>(&self, lanes: L, n: usize, pairs: Pairs<'_, B>, scratch: &mut Scratch<B>) {
        let sides = match self.scatter {
            Scatter::Reflection => Sides::Same,
            Scatter::Transmission => Sides::Opposite,
        };
        coordinates::run(lanes, n, pairs, sides, self.azimuths, &mut scratch.angles, &mut scratch.valid);
    }
}

impl Evaluate for &Table {
    type Scratch = Scratch;
    const SCRATCH: Scratch = Scratch::ZERO;

    fn channel_count(self) -> usize {
        self.grid.channels()
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch, out: &mut [f32]) {
        self.angles(lanes, n, pairs, scratch);
        self.grid.values(lanes, scratch, out);
    }
}
