//! Batches of directions in memory: an array of structures, or a structure of arrays.

use std::ops::Range;

use lobe_lane::Lanes;

use crate::passes::block::BLOCK;

/// Unit vectors, one a query: a slice of vectors, or [`Soa`].
pub trait Directions: Copy + sealed::Sealed {
    /// A whole block of directions, which needs no bounds checks.
    #[doc(hidden)]
    type Block<'a>: BlockOfDirections
    where
        Self: 'a;
    /// Room for a block that is not whole.
    #[doc(hidden)]
    type Padding;
    #[doc(hidden)]
    const PADDING: Self::Padding;

    /// How many there are.
    fn count(&self) -> usize;

    /// Directions `range`, for splitting a batch.
    ///
    /// # Panics
    /// Where there are fewer.
    fn part(&self, range: Range<usize>) -> Self;

    /// The block from direction `at` on. Where fewer are left than a block has, they are copied to `padding`, zero
    /// vectors behind them.
    #[doc(hidden)]
    fn block<'a>(&'a self, at: usize, padding: &'a mut Self::Padding) -> Self::Block<'a>;
}

/// A whole block of directions.
#[doc(hidden)]
pub trait BlockOfDirections: Copy {
    /// Directions `at .. at + LANES` of the block as x, y and z; `at` is a multiple of the lanes.
    fn load<L: Lanes>(self, lanes: L, at: usize) -> [L::F; 3];
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for &[[f32; 3]] {}
    impl Sealed for super::Soa<'_> {}
}

impl Directions for &[[f32; 3]] {
    type Block<'a>
        = &'a [[f32; 3]; BLOCK]
    where
        Self: 'a;
    type Padding = [[f32; 3]; BLOCK];
    const PADDING: Self::Padding = [[0.0; 3]; BLOCK];

    fn count(&self) -> usize {
        self.len()
    }

    fn part(&self, range: Range<usize>) -> Self {
        &self[range]
    }

    #[inline(always)]
    fn block<'a>(&'a self, at: usize, padding: &'a mut Self::Padding) -> Self::Block<'a> {
        let rest = &self[at..];
        match rest.first_chunk() {
            Some(whole) => whole,
            None => {
                *padding = Self::PADDING;
                padding[..rest.len()].copy_from_slice(rest);
                padding
            }
        }
    }
}

impl BlockOfDirections for &[[f32; 3]; BLOCK] {
    #[inline(always)]
    fn load<L: Lanes>(self, lanes: L, at: usize) -> [L::F; 3] {
        lanes.load_xyz(&self[at & (BLOCK - L::LANES)..][..L::LANES])
    }
}

/// Directions as separate slices of x, y and z, which are equally long.
#[derive(Clone, Copy, Debug)]
pub struct Soa<'a> {
    xyz: [&'a [f32]; 3],
}

impl<'a> Soa<'a> {
    /// Directions from their components.
    ///
    /// # Panics
    /// Where the slices differ in length.
    pub fn new(x: &'a [f32], y: &'a [f32], z: &'a [f32]) -> Self {
        assert!(x.len() == y.len() && y.len() == z.len(), "components of {}, {}, {}", x.len(), y.len(), z.len());
        Soa { xyz: [x, y, z] }
    }
}

impl Directions for Soa<'_> {
    type Block<'a>
        = [&'a [f32; BLOCK]; 3]
    where
        Self: 'a;
    type Padding = [[f32; BLOCK]; 3];
    const PADDING: Self::Padding = [[0.0; BLOCK]; 3];

    fn count(&self) -> usize {
        self.xyz[0].len()
    }

    fn part(&self, range: Range<usize>) -> Self {
        Soa { xyz: self.xyz.map(|component| &component[range.clone()]) }
    }

    #[inline(always)]
    fn block<'a>(&'a self, at: usize, padding: &'a mut Self::Padding) -> Self::Block<'a> {
        let [x, y, z] = self.xyz.map(|component| &component[at..]);
        match (x.first_chunk(), y.first_chunk(), z.first_chunk()) {
            (Some(x), Some(y), Some(z)) => [x, y, z],
            _ => {
                *padding = Self::PADDING;
                for (padded, rest) in padding.iter_mut().zip([x, y, z]) {
                    padded[..rest.len()].copy_from_slice(rest);
                }
                let [x, y, z] = padding;
                [x, y, z]
            }
        }
    }
}

impl BlockOfDirections for [&[f32; BLOCK]; 3] {
    #[inline(always)]
    fn load<L: Lanes>(self, lanes: L, at: usize) -> [L::F; 3] {
        let [x, y, z] = self;
        let at = at & (BLOCK - L::LANES);
        [lanes.load(&x[at..][..L::LANES]), lanes.load(&y[at..][..L::LANES]), lanes.load(&z[at..][..L::LANES])]
    }
}
