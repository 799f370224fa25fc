//! The Stokes components that a film sums.

use lobe_lane::Lanes;

use crate::channels::Channels;
use crate::columns::{Column, ZEROS};

/// Values of the first `R` Stokes components, `[component][channel]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Components<V, const R: usize, const N: usize>(pub [[V; N]; R]);

impl<V, const R: usize, const N: usize> AsRef<[V]> for Components<V, R, N> {
    fn as_ref(&self) -> &[V] {
        self.0.as_flattened()
    }
}

impl<V, const R: usize, const N: usize> AsMut<[V]> for Components<V, R, N> {
    fn as_mut(&mut self) -> &mut [V] {
        self.0.as_flattened_mut()
    }
}

impl<const R: usize, const N: usize> Channels for Components<f32, R, N> {
    const COUNT: usize = R * N;
    const ZERO: Self = Components([[0.0; N]; R]);
    const ONE: Self = Components([[1.0; N]; R]);
    type InLanes<L: Lanes> = Components<L::F, R, N>;
    type Columns = Components<Column, R, N>;
    type Sums = Components<i128, R, N>;
    const ZERO_COLUMNS: Self::Columns = Components([[ZEROS; N]; R]);
    const ZERO_SUMS: Self::Sums = Components([[0; N]; R]);

    #[inline(always)]
    fn map(self, mut f: impl FnMut(f32) -> f32) -> Self {
        Components(self.0.map(|row| row.map(&mut f)))
    }

    #[inline(always)]
    fn in_lanes<L: Lanes>(self, lanes: L) -> Self::InLanes<L> {
        let mut values = [[lanes.splat(0.0); N]; R];
        let mut row = 0;
        while row < R {
            let mut k = 0;
            while k < N {
                values[row][k] = lanes.splat(self.0[row][k]);
                k += 1;
            }
            row += 1;
        }
        Components(values)
    }
}
