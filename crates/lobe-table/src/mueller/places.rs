//! The places of pairs of directions between the nodes of the matrices.

use lobe_lane::{Floats, Kernel, Lanes, call};

use super::data::{AXES, Data};
use crate::grid::axis::Axis;
use crate::grid::cells;
use crate::grid::edges::Edge;
use crate::grid::weights::{self, MAX_CORNERS};
use crate::invalid::Invalid;
use crate::passes::block::{Column, registers};
use crate::passes::half_vector::HalfVector;
use crate::passes::pairs::Pairs;

/// The grid of angles, and the layout of texels of some width on it.
#[derive(Clone, Debug)]
pub(super) struct Places {
    /// `phi_d`, `theta_d` and `theta_h`.
    axes: [Axis; 3],
    /// Floats from a node to the next along each axis.
    strides: [usize; 3],
    /// The corners of a cell, from its first node.
    pub(super) corners: [usize; 8],
    /// The number of floats of all texels.
    pub(super) len: usize,
}

impl Places {
    /// The places of texels of `width` floats, a multiple of eight.
    ///
    /// # Errors
    /// [`Invalid`] names an axis, or `M` if there are more floats than `most`.
    pub(super) fn new(data: &Data, width: usize, most: usize) -> Result<Self, Invalid> {
        let axis = |index: usize| {
            let knots: Vec<f64> = data.knots()[index].iter().map(|knot| f64::from(*knot)).collect();
            Axis::new(&knots, Edge::Clamp)
                .map_err(|error| Invalid::new(AXES[index], error.to_string(), "ascending knots"))
        };
        let axes = [axis(0)?, axis(1)?, axis(2)?];
        let [phi_d, theta_d, theta_h] = [0, 1, 2].map(|index: usize| axes[index].knots().len());
        let row = width.checked_mul(theta_h);
        let slice = row.and_then(|row| row.checked_mul(theta_d));
        let len = slice.and_then(|slice| slice.checked_mul(phi_d)).filter(|len| *len <= most);
        let (Some(row), Some(slice), Some(len)) = (row, slice, len) else {
            let found = format!("{phi_d} x {theta_d} x {theta_h} nodes of {} wavelengths", data.knots()[3].len());
            return Err(Invalid::new("M", found, "a table that a 32-bit index reaches"));
        };
        let strides = [slice, row, width];
        let steps: [usize; 3] =
            std::array::from_fn(|axis| if axes[axis].knots().len() > 1 { strides[axis] } else { 0 });
        let corners = std::array::from_fn(|corner| {
            (0..3).map(|axis| if corner >> (2 - axis) & 1 == 1 { steps[axis] } else { 0 }).sum()
        });
        Ok(Places { axes, strides, corners, len })
    }

    /// Bytes of memory that the axes take.
    pub(super) fn bytes(&self) -> usize {
        self.axes.iter().map(Axis::bytes).sum()
    }

    /// Converts the directions of queries `0..n` to the first corner of each and the weights. `n` is a multiple of the
    /// lanes.
    #[inline(always)]
    pub(super) fn find<L: Lanes>(&self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch) {
        call(lanes, Find { places: self, n, pairs, scratch });
    }
}

/// The intermediate values of a block.
pub(crate) struct Scratch {
    pub(super) angles: HalfVector,
    pub(super) base: Column<i32>,
    pub(super) weights: [Column; MAX_CORNERS],
}

impl Scratch {
    pub(super) const ZERO: Self =
        Scratch { angles: HalfVector::ZERO, base: Column::<i32>::ZERO, weights: [Column::<f32>::ZERO; MAX_CORNERS] };
}

/// [`Places::find`] as a kernel that both tables call, so that it is compiled once.
struct Find<'a> {
    places: &'a Places,
    n: usize,
    pairs: Pairs<'a>,
    scratch: &'a mut Scratch,
}

impl Kernel for Find<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Find { places, n, pairs, scratch: Scratch { angles, base, weights } } = self;
        let n = registers(lanes, n);
        angles.run::<L, true>(lanes, n, pairs);
        let HalfVector { theta_h, theta_d, phi_d, valid, .. } = angles;
        *base = Column::<i32>::ZERO;
        let by_axis = [&mut *phi_d, &mut *theta_d, &mut *theta_h];
        let mut axis = 0;
        while axis < by_axis.len() {
            cells::run(lanes, n, &places.axes[axis], places.strides[axis], by_axis[axis], base, valid);
            within(lanes, n, by_axis[axis]);
            axis += 1;
        }
        weights::run(lanes, n, [phi_d, theta_d, theta_h], valid, 1.0, weights);
    }
}

/// No weight may be negative, not even by rounding: unmeasured matrices would turn into light.
#[inline(always)]
fn within<L: Lanes>(lanes: L, n: usize, fraction: &mut Column) {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let mut query = 0;
    while query < n {
        fraction.store(lanes, query, fraction.load(lanes, query).max(zero).min(one));
        query += L::LANES;
    }
}
