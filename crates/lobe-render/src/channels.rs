//! Values per channel, and their forms in lanes, in columns and in exact sums.

use std::fmt::Debug;

use lobe_lane::Lanes;

use crate::columns::{Column, ZEROS};

/// One float per channel: an array.
///
/// The renderer keeps such values in the associated types; an array of any length has all of them.
pub trait Channels: Copy + Debug + PartialEq + Send + Sync + AsRef<[f32]> + AsMut<[f32]> + 'static {
    /// The number of channels.
    const COUNT: usize;
    /// 0 in every channel.
    const ZERO: Self;
    /// 1 in every channel.
    const ONE: Self;
    /// A register per channel.
    #[doc(hidden)]
    type InLanes<L: Lanes>: Copy + Debug + AsRef<[L::F]> + AsMut<[L::F]>;
    /// A column of the hits of a block per channel.
    #[doc(hidden)]
    type Columns: Clone + Debug + Send + AsRef<[Column]> + AsMut<[Column]>;
    /// An exact sum per channel.
    #[doc(hidden)]
    type Sums: Copy + Debug + Eq + Send + Sync + AsRef<[i128]> + AsMut<[i128]>;
    #[doc(hidden)]
    const ZERO_COLUMNS: Self::Columns;
    #[doc(hidden)]
    const ZERO_SUMS: Self::Sums;

    /// The values with `f` applied to each.
    #[must_use]
    fn map(self, f: impl FnMut(f32) -> f32) -> Self;

    /// The same value in all lanes.
    #[doc(hidden)]
    fn in_lanes<L: Lanes>(self, lanes: L) -> Self::InLanes<L>;
}

impl<const N: usize> Channels for [f32; N] {
    const COUNT: usize = N;
    const ZERO: Self = [0.0; N];
    const ONE: Self = [1.0; N];
    type InLanes<L: Lanes> = [L::F; N];
    type Columns = [Column; N];
    type Sums = [i128; N];
    const ZERO_COLUMNS: Self::Columns = [ZEROS; N];
    const ZERO_SUMS: Self::Sums = [0; N];

    #[inline(always)]
    fn map(self, f: impl FnMut(f32) -> f32) -> Self {
        <[f32; N]>::map(self, f)
    }

    #[inline(always)]
    fn in_lanes<L: Lanes>(self, lanes: L) -> [L::F; N] {
        let mut values = [lanes.splat(0.0); N];
        let mut k = 0;
        while k < N {
            values[k] = lanes.splat(self[k]);
            k += 1;
        }
        values
    }
}
