//! A [`Table`] at known angles: evaluation without directions.

use std::ops::Range;

use lobe_backend::Backend;
use lobe_lane::{Floats, Kernel, Lanes};

use super::{PSI, Table};
use crate::grid::interpolation::Scratch;
use crate::passes::block::registers;
use crate::passes::blocks::{Blocks, Blockwise};

impl Table {
    /// Interpolates at many points on a backend: `out[query * channels + channel]`, in 1/sr.
    ///
    /// `angles` are sigma, psi, theta and phi in radians, see [`coords`](crate::specular::coords); psi and phi are in
    /// `[0, 2 pi]`. An isotropic table does not read psi, which may be empty. Results are 0 if an angle is not finite.
    ///
    /// # Panics
    /// If the numbers of angles differ, or the length of `out` is not that number times the number of channels.
    pub fn interpolate_batch(&self, backend: Backend, angles: [&[f32]; 4], out: &mut [f32]) {
        backend.run(self.interpolation(angles, out));
    }

    /// The work of [`interpolate_batch`](Table::interpolate_batch) as a kernel, for lanes that are not a
    /// [`Backend`].
    ///
    /// # Panics
    /// The same as for [`interpolate_batch`](Table::interpolate_batch).
    pub fn interpolation<'a>(&'a self, angles: [&'a [f32]; 4], out: &'a mut [f32]) -> impl Kernel<Out = ()> + 'a {
        let count = angles[0].len();
        for (axis, angles) in angles.iter().enumerate() {
            let unread = axis == PSI && !self.is_anisotropic();
            assert!(unread || angles.len() == count, "as many angles of each kind");
        }
        assert_eq!(out.len(), count * self.channel_count(), "one output per query and channel");
        Blocks(Interpolation { table: self, angles, out })
    }
}

/// Interpolation at all points of a batch.
struct Interpolation<'a> {
    table: &'a Table,
    angles: [&'a [f32]; 4],
    out: &'a mut [f32],
}

impl Blockwise for Interpolation<'_> {
    type Scratch = Scratch;
    const SCRATCH: Scratch = Scratch::ZERO;

    fn count(&self) -> usize {
        self.angles[0].len()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut Scratch) {
        let Interpolation { table, angles, out } = self;
        let (at, left, channels) = (queries.start, queries.len(), table.channel_count());
        let n = registers(lanes, left);
        let mut axis = 0;
        while axis < 4 {
            if axis != PSI || table.is_anisotropic() {
                scratch.angles[axis].0[..left].copy_from_slice(&angles[axis][at..][..left]);
            }
            axis += 1;
        }
        leave_out(lanes, n, table.is_anisotropic(), scratch);
        table.grid.values(lanes, scratch, &mut out[at * channels..][..left * channels]);
    }
}

/// Queries `0..n` are valid if all angles are finite; angles that are not become 0.
#[inline(always)]
fn leave_out<L: Lanes>(lanes: L, n: usize, anisotropic: bool, scratch: &mut Scratch) {
    let mut query = 0;
    while query < n {
        let mut finite = lanes.splat_int(-1);
        let mut axis = 0;
        while axis < 4 {
            if axis != PSI || anisotropic {
                let angle = scratch.angles[axis].load(lanes, query);
                let kept = angle.abs().lt(lanes.splat(f32::INFINITY));
                finite = lanes.select_int(kept, finite, lanes.splat_int(0));
                scratch.angles[axis].store(lanes, query, angle.masked(kept));
            }
            axis += 1;
        }
        scratch.valid.store(lanes, query, finite);
        query += L::LANES;
    }
}
