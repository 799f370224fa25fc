//! Densities on the unit square with their cumulative distributions, laid out for lanes.

use lobe_lane::{Block, Lanes};

use super::grid::Grid;
use crate::invalid::Invalid;
use crate::rgl::{Images, marginal};
use lobe_memory::Storage;

/// Normalised slices: the counterpart of [`rgl::Warp`](crate::rgl::Warp) for lanes.
///
/// A blend reads the same texel at two neighbouring zenith angles, and a cell two neighbouring rows. All four are
/// adjacent, so that a step of a search takes one load of four floats, and the data for a density share one or two
/// cache lines. The price is that every texel is stored four times.
#[derive(Clone, Debug)]
pub(super) struct Warp {
    pub(super) grid: Grid,
    /// For a texel, its slice and row first: the integrals up to it of (this slice, this row), (this slice, next row),
    /// (next slice, this row), (next slice, next row); then their densities.
    texels: Storage<f32>,
    /// The integrals of every [`STRIDE`]th texel in a separate table, four floats each, so that the first steps of a
    /// search stay in the second-level cache.
    coarse: Storage<f32>,
    /// For a row: the integral below it in this slice and the next, then its own integral in both.
    rows: Storage<f32>,
    /// The number of slices per azimuth; 0 if there is only one azimuth, which is its own neighbour.
    zeniths: usize,
    /// The number of cells of the unit square: the factor from a density in cells to one on the square.
    pub(super) scale: f32,
}

/// Floats of a texel of [`Warp::texels`], and of a row of [`Warp::rows`].
const TEXEL: usize = 8;
const ROW: usize = 4;
/// Texels of [`Warp::texels`] for one of [`Warp::coarse`], and the floats of that one.
pub(super) const STRIDE: usize = 8;
const COARSE: usize = 4;

impl Warp {
    /// Normalises and lays out `slices` (azimuths, zenith angles) images.
    pub(super) fn new(part: &'static str, images: &Images, slices: [usize; 2]) -> Result<Self, Invalid> {
        let [height, width] = images.size();
        let [azimuths, zeniths] = slices;
        let (grid, len) = Grid::new(part, images, [images.slices(), height - 1, width], TEXEL)?;
        let exact = marginal::Warp::new(images);
        let (mut texels, mut rows) = (Storage::zeros(len), Storage::zeros(images.slices() * height * ROW));
        let coarse_len = images.slices() * (height - 1) * coarse_columns(width - 1) * COARSE;
        let mut coarse = Storage::zeros(coarse_len);
        let mut skips = coarse.as_mut_slice().chunks_exact_mut(COARSE);
        let mut nodes = texels.as_mut_slice().chunks_exact_mut(TEXEL);
        let mut ends = rows.as_mut_slice().chunks_exact_mut(ROW);
        for slice in 0..images.slices() {
            // The last zenith angle has no next one.
            let next = if (slice + 1) % zeniths == 0 { slice } else { slice + 1 };
            for row in 0..height - 1 {
                for col in 0..width {
                    let corners = [(slice, row), (slice, row + 1), (next, row), (next, row + 1)];
                    let node = nodes.next().expect("a node per texel");
                    for (corner, (slice, row)) in corners.into_iter().enumerate() {
                        let [density, integral] = exact.node(slice, row, col);
                        (node[corner], node[4 + corner]) = (integral as f32, density as f32);
                    }
                    if col % STRIDE == 0 && col < width - 1 {
                        skips.next().expect("a place for every coarse texel").copy_from_slice(&node[..4]);
                    }
                }
            }
            for row in 0..height {
                let ([this, below], [other, other_below]) = (exact.row(slice, row), exact.row(next, row));
                let entry = [below, other_below, this, other].map(|x| x as f32);
                ends.next().expect("an entry per row").copy_from_slice(&entry);
            }
        }
        Ok(Warp {
            zeniths: if azimuths > 1 { zeniths } else { 0 },
            grid,
            texels,
            rows,
            coarse,
            scale: exact.cells() as f32,
        })
    }

    /// For a base at a cell: the integrals at its left, and the densities at its left and right, in its slice and in
    /// that of the next azimuth.
    #[inline(always)]
    pub(super) fn cells(&self) -> [Block<'_, 3, 4>; 2] {
        let (texels, next) = (self.texels.as_slice(), self.zeniths * self.grid.strides[2]);
        [Block::new(texels, [0, 4, TEXEL + 4]), Block::new(texels, [next, next + 4, next + TEXEL + 4])]
    }

    /// For a base at a row: that row and the next, in its slice and in that of the next azimuth.
    #[inline(always)]
    pub(super) fn rows(&self) -> [Block<'_, 2, 4>; 2] {
        let (rows, next) = (self.rows.as_slice(), self.zeniths * (self.grid.cells[1] + 1) * ROW);
        [Block::new(rows, [0, ROW]), Block::new(rows, [next, next + ROW])]
    }

    /// The integrals up to the rows, without columns.
    #[inline(always)]
    pub(super) fn ends(&self) -> Entries<'_> {
        let rows = self.grid.cells[1];
        self.entries(&self.rows, rows, [ROW, 0, (rows + 1) * ROW])
    }

    /// The integrals up to the columns.
    #[inline(always)]
    pub(super) fn fine(&self) -> Entries<'_> {
        self.entries(&self.texels, self.grid.cells[0], self.grid.strides)
    }

    /// The integrals up to every [`STRIDE`]th column.
    #[inline(always)]
    pub(super) fn coarse(&self) -> Entries<'_> {
        let [columns, rows] = self.grid.cells;
        let count = coarse_columns(columns);
        self.entries(&self.coarse, count, [COARSE, count * COARSE, rows * count * COARSE])
    }

    #[inline(always)]
    fn entries<'a>(&self, floats: &'a Storage<f32>, count: usize, strides: [usize; 3]) -> Entries<'a> {
        let [stride, row, slice] = [strides[0] as i32, strides[1] as i32, strides[2] as i32];
        let azimuth = self.zeniths as i32 * slice;
        Entries { floats: floats.as_slice(), count: count as i32, stride, row, slice, azimuth }
    }

    pub(super) fn bytes(&self) -> usize {
        self.texels.bytes() + self.rows.bytes() + self.coarse.bytes()
    }
}

/// The number of coarse texels for this many columns.
#[inline(always)]
fn coarse_columns(columns: usize) -> usize {
    columns.div_ceil(STRIDE)
}

/// A table to search: consecutive ascending entries of four floats, for each row of each slice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entries<'a> {
    floats: &'a [f32],
    /// The number of entries that a search chooses from.
    pub(super) count: i32,
    /// Floats from an entry to the next, from a row to the next, from a slice to the next, and to the slice of the next
    /// azimuth.
    pub(super) stride: i32,
    pub(super) row: i32,
    pub(super) slice: i32,
    pub(super) azimuth: i32,
}

impl<'a> Entries<'a> {
    /// For a base at an entry: the one that many entries later, in its slice and in that of the next azimuth.
    ///
    /// # Panics
    /// If no slice has that many.
    #[inline(always)]
    pub(super) fn further(&self, by: i32) -> Block<'a, 2, 4> {
        let further = (by * self.stride) as usize;
        Block::new(self.floats, [further, further + self.azimuth as usize])
    }

    /// The start of a slice.
    #[inline(always)]
    pub(super) fn of_slice<L: Lanes>(&self, lanes: L, slice: L::I) -> L::I {
        slice * lanes.splat_int(self.slice)
    }

    /// The start of a row of a slice.
    #[inline(always)]
    pub(super) fn of_row<L: Lanes>(&self, lanes: L, slice: L::I, row: L::I) -> L::I {
        self.of_slice(lanes, slice) + row * lanes.splat_int(self.row)
    }
}
