//! The layout of images in memory, and the place of a position on the unit square in them.

use lobe_lane::{Floats, Ints, Lanes};

use crate::invalid::Invalid;
use crate::passes::block::Column;
use crate::rgl::Images;

/// Images of one size, a fixed number of floats per texel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// Cells along x and y.
    pub(super) cells: [usize; 2],
    /// Floats from a texel to its neighbours along x, along y, and in the next slice.
    pub(super) strides: [usize; 3],
}

impl Grid {
    /// `slices` images of `columns` by `rows` texels of `floats` each that hold `size` of `images`, and their length in
    /// floats.
    ///
    /// # Errors
    /// If that is more than a 32-bit index can address.
    pub(super) fn new(
        part: &'static str,
        images: &Images,
        [slices, rows, columns]: [usize; 3],
        floats: usize,
    ) -> Result<(Self, usize), Invalid> {
        let [height, width] = images.size();
        let row = columns.checked_mul(floats);
        let slice = row.and_then(|row| row.checked_mul(rows));
        let len = slice.and_then(|slice| slice.checked_mul(slices)).filter(|len| i32::try_from(*len).is_ok());
        match (row, slice, len) {
            (Some(row), Some(slice), Some(len)) => {
                Ok((Grid { cells: [width - 1, height - 1], strides: [floats, row, slice] }, len))
            }
            _ => {
                let found = format!("{slices} slices of {rows} x {columns} texels, {floats} floats each");
                Err(Invalid::new(part, found, "a table that a 32-bit index reaches"))
            }
        }
    }

    /// The grid in the registers of a backend.
    #[inline(always)]
    pub(super) fn placer<L: Lanes>(&self, lanes: L) -> Placer<L> {
        let [x, y] = self.cells;
        let [column, row, slice] = self.strides;
        Placer {
            one: lanes.splat(1.0),
            cells: [lanes.splat(x as f32), lanes.splat(y as f32)],
            last: [lanes.splat_int(x as i32 - 1), lanes.splat_int(y as i32 - 1)],
            strides: [lanes.splat_int(column as i32), lanes.splat_int(row as i32), lanes.splat_int(slice as i32)],
        }
    }
}

/// A [`Grid`] in registers.
#[derive(Clone, Copy)]
pub(super) struct Placer<L: Lanes> {
    one: L::F,
    cells: [L::F; 2],
    last: [L::I; 2],
    strides: [L::I; 3],
}

impl<L: Lanes> Placer<L> {
    /// The cells along x and y that contain `u`, clamped to the unit square, and the fractions into them.
    #[inline(always)]
    pub(super) fn cells(&self, lanes: L, u: [L::F; 2]) -> ([L::I; 2], [L::F; 2]) {
        let zero = lanes.splat(0.0);
        let x = u[0].max(zero).min(self.one) * self.cells[0];
        let y = u[1].max(zero).min(self.one) * self.cells[1];
        let cells = [x.to_int().min(self.last[0]), y.to_int().min(self.last[1])];
        (cells, [x - cells[0].to_float(), y - cells[1].to_float()])
    }

    /// The position on the unit square of the sum of a cell and a fraction: `axis` 0 is x, 1 is y.
    #[inline(always)]
    pub(super) fn position(&self, axis: usize, place: L::F) -> L::F {
        place / self.cells[axis]
    }

    /// The index of the first texel of a cell in the first slice.
    #[inline(always)]
    pub(super) fn texel(&self, cells: [L::I; 2]) -> L::I {
        cells[0] * self.strides[0] + cells[1] * self.strides[1]
    }

    /// The start of a slice.
    #[inline(always)]
    pub(super) fn slice(&self, slice: L::I) -> L::I {
        slice * self.strides[2]
    }
}

/// The places of the positions `u` of queries `0..n` in the images of `grid`.
#[derive(Clone, Copy)]
pub(super) struct Places {
    /// The first texel of the cell in the first blended slice.
    pub(super) base: Column<i32>,
    /// Fractions into the cell along x and y.
    pub(super) fractions: [Column; 2],
}

impl Places {
    pub(super) const ZERO: Self = Places { base: Column::<i32>::ZERO, fractions: [Column::<f32>::ZERO; 2] };

    /// Finds the cells.
    #[inline(always)]
    pub(super) fn find<L: Lanes>(&mut self, lanes: L, n: usize, grid: &Grid, slice: &Column<i32>, u: &[Column; 2]) {
        let placer = grid.placer(lanes);
        let mut query = 0;
        while query < n {
            let (cells, [x, y]) = placer.cells(lanes, [u[0].load(lanes, query), u[1].load(lanes, query)]);
            let slice = placer.slice(slice.load(lanes, query));
            self.base.store(lanes, query, placer.texel(cells) + slice);
            self.fractions[0].store(lanes, query, x);
            self.fractions[1].store(lanes, query, y);
            query += L::LANES;
        }
    }
}

/// The offsets of the corners of a cell: those of the slices, azimuth slowest, times those of `within`, the last
/// fastest. An axis of one knot has no upper neighbour.
pub(super) fn offsets<const CORNERS: usize>(slices: [usize; 2], stride: usize, within: &[usize]) -> [usize; CORNERS] {
    let [azimuths, zeniths] = slices;
    let steps = [(azimuths > 1, zeniths * stride), (zeniths > 1, stride)].map(|(two, step)| if two { step } else { 0 });
    let steps: Vec<usize> = steps.iter().chain(within).copied().collect();
    std::array::from_fn(|corner| {
        steps.iter().rev().enumerate().map(|(bit, step)| if corner >> bit & 1 == 1 { *step } else { 0 }).sum()
    })
}

/// The pattern without the azimuth, the slowest axis: the first half of the corners.
#[inline(always)]
pub(super) fn first<const N: usize, const ALL: usize>(offsets: &[usize; ALL]) -> [usize; N] {
    *offsets.first_chunk().expect("no more corners than there are")
}
