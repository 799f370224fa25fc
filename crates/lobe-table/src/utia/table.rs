//! [`Data`] prepared for evaluation in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Floats, Kernel, Lanes};

use super::data::{Data, Decode, PHIS, PLANE, SCALE, STEPS, THETAS};
use crate::directions::Directions;
use crate::grid::interpolation::{Interpolator, Scratch, Source};
use crate::invalid::Invalid;
use crate::passes::pairs::{Evaluate, Pairs, evaluation};
use crate::spherical::AXIS_NAMES;
use crate::spherical::coordinates::{self, Azimuths, Sides};
use crate::{Edge, Edges, Precision};

/// [`Data`] laid out for evaluation in SIMD lanes.
///
/// The values are those of [`Data::eval`], in `f32`. The directions need not be unit vectors, but their lengths have to
/// be between 1e-15 and 1e15. In strict form ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same
/// bits.
#[derive(Clone, Debug)]
pub struct Table {
    grid: Interpolator,
    decode: Decode,
}

impl Table {
    /// Lays out the values, 16 bytes each.
    ///
    /// # Errors
    /// [`Invalid`] if a value is beyond the range of `f32`.
    pub fn new(data: &Data, decode: Decode) -> Result<Self, Invalid> {
        let knots = |count: usize, step: f64| (0..count).map(|index| (index as f64 * step).to_radians()).collect();
        let [thetas, phis]: [Vec<f64>; 2] = [knots(THETAS, STEPS[0]), knots(PHIS, STEPS[1])];
        let stored = |value: f64| if decode == Decode::Raw { value } else { value.max(0.0) / SCALE };
        let planes = data.values();
        let values: Vec<f32> =
            (0..PLANE).flat_map(|at| [0, 1, 2].map(|channel| stored(planes[channel * PLANE + at]) as f32)).collect();
        // Beyond the last knot, zenith angles are extrapolated linearly, as in the reader of the database.
        let edges =
            Edges { axes: [Edge::Extrapolate, Edge::Periodic, Edge::Extrapolate, Edge::Periodic], non_negative: false };
        let knots = [thetas.clone(), phis.clone(), thetas, phis];
        let beyond = |found: String| Invalid::new("values", found, "values that an f32 holds");
        if let Some(at) = values.iter().position(|value| !value.is_finite()) {
            return Err(beyond(format!("value {at} is {}", values[at])));
        }
        let source = Source { names: &AXIS_NAMES, knots: &knots, channels: 3, values: &values };
        let grid = Interpolator::new(&source, &edges, Precision::Single).map_err(|error| beyond(error.to_string()))?;
        Ok(Table { grid, decode })
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        self.grid.bytes()
    }

    /// Evaluates many pairs on a backend: `out[3 * query + channel]`.
    ///
    /// # Panics
    /// The same as for [`batch`](Self::batch).
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`]: `out[3 * query + channel]`.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or `out` is not three times as long.
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
        3
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch, out: &mut [f32]) {
        let Scratch { angles, valid, .. } = scratch;
        coordinates::run(lanes, n, pairs, Sides::Above, Azimuths::Both, angles, valid);
        self.grid.values(lanes, scratch, out);
        if self.decode == Decode::Srgb {
            undo_curve(lanes, out);
        }
    }
}

/// [`Decode::Srgb`] after the interpolation.
#[inline(always)]
fn undo_curve<L: Lanes>(lanes: L, values: &mut [f32]) {
    let mut at = 0;
    while at < values.len() {
        let value = lanes.load_partial(&values[at..]);
        let base = (value + lanes.splat(0.055)) * lanes.splat(1.0 / 1.055);
        // To the power of 2.4: the square, times the square of the fifth root.
        let root = lobe_math::fifth_root(lanes, base.max(lanes.splat(f32::MIN_POSITIVE)));
        let power = base * root;
        let curved = lanes.splat(100.0) * (power * power);
        let straight = value * lanes.splat(100.0 / 12.92);
        let is_curved = lanes.splat(0.0375).lt(value);
        lanes.store_partial(&mut values[at..], lanes.select(is_curved, curved, straight));
        at += L::LANES;
    }
}
