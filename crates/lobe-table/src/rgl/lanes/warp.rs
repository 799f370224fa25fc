//! Densities on the unit square with their cumulative distributions, laid out for lanes.

use lobe_lane::Block;

use super::grid::{Grid, offsets};
use crate::invalid::Invalid;
use crate::rgl::{Images, marginal};
use crate::storage::Storage;

/// Normalised slices: what [`rgl::Warp`](crate::rgl::Warp) is in `f64`.
///
/// The density and the conditional integral of a texel lie side by side, so that one load of four floats brings what a
/// row of a cell needs: density and integral at its left, density at its right end.
#[derive(Clone, Debug)]
pub(super) struct Warp {
    pub(super) grid: Grid,
    texels: Storage<f32>,
    /// For each row of a slice its integral, that of the next row, and the integral of the slice below it; a fourth
    /// float is not used.
    rows: Storage<f32>,
    row_offsets: [usize; 4],
    texel_offsets: [usize; 8],
    /// Cells of the unit square: from a density in cells to one on the square.
    pub(super) scale: f32,
}

/// Floats of a row of [`Warp::rows`].
const ROW: usize = 4;

impl Warp {
    /// Normalises and lays out `slices` (azimuths, zenith angles) images.
    pub(super) fn new(part: &'static str, images: &Images, slices: [usize; 2]) -> Result<Self, Invalid> {
        let [height, width] = images.size();
        let (grid, len) = Grid::new(part, images, [images.slices(), height, width], 2)?;
        let exact = marginal::Warp::new(images);
        let (mut texels, mut rows) = (Storage::zeros(len), Storage::zeros(images.slices() * height * ROW));
        let mut nodes = texels.as_mut_slice().chunks_exact_mut(2);
        let mut ends = rows.as_mut_slice().chunks_exact_mut(ROW);
        for slice in 0..images.slices() {
            for row in 0..height {
                for col in 0..width {
                    let node = exact.node(slice, row, col).map(|x| x as f32);
                    nodes.next().expect("a node a texel").copy_from_slice(&node);
                }
                let ([here, below], [next, _]) = (exact.row(slice, row), exact.row(slice, (row + 1).min(height - 1)));
                ends.next().expect("an entry a row").copy_from_slice(&[here as f32, next as f32, below as f32, 0.0]);
            }
        }
        let [_, row, slice] = grid.strides;
        Ok(Warp {
            grid,
            texels,
            rows,
            row_offsets: offsets(slices, height * ROW, &[]),
            texel_offsets: offsets(slices, slice, &[row]),
            scale: exact.cells() as f32,
        })
    }

    /// For a base at a cell: the upper and lower row of the cell in each slice of a blend.
    #[inline(always)]
    pub(super) fn texels<const CORNERS: usize>(&self) -> Block<'_, CORNERS, 4> {
        Block::new(self.texels.as_slice(), first(&self.texel_offsets))
    }

    /// For a base at a row: that row in each slice of a blend.
    #[inline(always)]
    pub(super) fn rows<const SLICES: usize>(&self) -> Block<'_, SLICES, 4> {
        Block::new(self.rows.as_slice(), first(&self.row_offsets))
    }

    /// Floats from a row to the next and from a slice to the next, in [`rows`](Self::rows).
    #[inline(always)]
    pub(super) fn row_strides(&self) -> [i32; 2] {
        let rows = self.grid.cells[1] + 1;
        [ROW as i32, (ROW * rows) as i32]
    }

    pub(super) fn bytes(&self) -> usize {
        self.texels.bytes() + self.rows.bytes()
    }
}

/// The pattern without the azimuth, the slowest axis: the first half of the corners.
#[inline(always)]
pub(super) fn first<const N: usize, const ALL: usize>(offsets: &[usize; ALL]) -> [usize; N] {
    *offsets.first_chunk().expect("no more corners than there are")
}
