//! The cumulative sums of all slices, and their blend between the knots of sigma and psi.
//!
//! A slice is the distribution of scattered light at one knot of sigma (and psi): a histogram over rows in phi and
//! columns in `v` (see [`incident`](super::incident)). Between knots, the blend of the histograms, with the weights of
//! the table's own interpolation, is again a histogram, and its sums are the blended sums: they are blended while they
//! are searched, and the density is exact. Slices keep their brightness, so that a bright knot counts for more than a
//! dark one, just as in the interpolated value.

use lobe_lane::{Block, Floats, Ints, Lanes};

use super::grid::Grid;
use lobe_memory::Storage;

/// The sums of the slices. The slices that one blend reads, two or four, are adjacent.
#[derive(Clone, Debug)]
pub(crate) struct Slices {
    pub(crate) grid: Grid,
    /// The number of slices in a blend: both ends in sigma, or in sigma and psi.
    pub(crate) width: usize,
    /// Up to and including each row, `[block][row][slice]`.
    pub(crate) rows: Storage<f32>,
    /// Within a row, up to and including each column, `[block][row][column][slice]`.
    pub(crate) columns: Storage<f32>,
}

/// The slices that a lane blends, and their weights.
#[derive(Clone, Copy)]
pub(crate) struct Place<L: Lanes> {
    pub(crate) block: L::I,
    /// Sigma slow, psi fast; only the first two if psi does not matter.
    pub(crate) weights: [L::F; 4],
}

/// A sample of a blend: its place, and its density per unit of `v` and phi.
#[derive(Clone, Copy)]
pub(crate) struct Draw<L: Lanes> {
    pub(crate) v: L::F,
    pub(crate) phi: L::F,
    pub(crate) density: L::F,
}

/// Sums whose slices are adjacent.
pub(crate) trait Sums: Copy {
    /// Entry `index`, blended. Outside the table, it is an arbitrary entry.
    fn blend<L: Lanes>(self, lanes: L, index: L::I, weights: &[L::F; 4]) -> L::F;
}

/// Sums of two slices.
#[derive(Clone, Copy)]
pub(crate) struct Pairs<'a>(&'a [[f32; 2]]);

/// Sums of four slices.
#[derive(Clone, Copy)]
pub(crate) struct Quads<'a>(Block<'a, 1, 4>);

impl Sums for Pairs<'_> {
    #[inline(always)]
    fn blend<L: Lanes>(self, lanes: L, index: L::I, weights: &[L::F; 4]) -> L::F {
        let [a, b] = lanes.gather_pair(self.0, index);
        lanes.mul_add(b, weights[1], a * weights[0])
    }
}

impl Sums for Quads<'_> {
    #[inline(always)]
    fn blend<L: Lanes>(self, lanes: L, index: L::I, weights: &[L::F; 4]) -> L::F {
        let [[a, b, c, d]] = lanes.gather_quads(&self.0, index.shl::<2>());
        let low = lanes.mul_add(b, weights[1], a * weights[0]);
        lanes.mul_add(d, weights[3], lanes.mul_add(c, weights[2], low))
    }
}

/// Slices whose width is known to the compiler.
#[derive(Clone, Copy)]
pub(crate) struct View<'a, S> {
    grid: &'a Grid,
    rows: S,
    columns: S,
}

impl Slices {
    /// The slices of an isotropic table.
    #[inline(always)]
    pub(crate) fn pairs(&self) -> View<'_, Pairs<'_>> {
        let (rows, columns) = (self.rows.as_slice().as_chunks().0, self.columns.as_slice().as_chunks().0);
        View { grid: &self.grid, rows: Pairs(rows), columns: Pairs(columns) }
    }

    /// The slices of an anisotropic table.
    #[inline(always)]
    pub(crate) fn quads(&self) -> View<'_, Quads<'_>> {
        let (rows, columns) = (Block::new(self.rows.as_slice(), [0]), Block::new(self.columns.as_slice(), [0]));
        View { grid: &self.grid, rows: Quads(rows), columns: Quads(columns) }
    }

    /// Bytes of memory that this holds.
    pub(crate) fn bytes(&self) -> usize {
        self.grid.bytes() + self.rows.bytes() + self.columns.bytes()
    }
}

impl<S: Sums> View<'_, S> {
    /// The sample for two numbers: the first chooses the row and the phi in it, the second the column and `v`.
    #[inline(always)]
    pub(crate) fn draw<L: Lanes>(&self, lanes: L, place: &Place<L>, [u, w]: [L::F; 2]) -> Draw<L> {
        let (mut search, total) = self.begin(lanes, place, u);
        let mut half = self.row_half();
        while half > 0 {
            search = self.row_step(lanes, search, half, &place.weights);
            half >>= 1;
        }
        let (mut search, row) = self.turn(lanes, search, total, w);
        let mut half = self.column_half();
        while half > 0 {
            search = self.column_step(lanes, search, half, &place.weights);
            half >>= 1;
        }
        self.end(lanes, search, row)
    }

    /// Half the rows, and half the columns: the start of their searches.
    #[inline(always)]
    pub(crate) fn row_half(&self) -> i32 {
        (1 << self.grid.row_bits) >> 1
    }
    #[inline(always)]
    pub(crate) fn column_half(&self) -> i32 {
        (1 << self.grid.column_bits) >> 1
    }

    /// The search of a row for a number in `[0, 1)`, and the sum of all rows.
    #[inline(always)]
    pub(crate) fn begin<L: Lanes>(&self, lanes: L, place: &Place<L>, u: L::F) -> (Search<L>, L::F) {
        let first = place.block * lanes.splat_int(1 << self.grid.row_bits);
        let total = self.total(lanes, place);
        (Search::new(lanes, first, unit(lanes, u) * total, total), total)
    }

    /// One step of the search of a row.
    #[inline(always)]
    pub(crate) fn row_step<L: Lanes>(&self, lanes: L, search: Search<L>, half: i32, weights: &[L::F; 4]) -> Search<L> {
        search.step(lanes, self.rows, half, weights)
    }

    /// Goes from the row that was found to the search of a column in it.
    #[inline(always)]
    pub(crate) fn turn<L: Lanes>(&self, lanes: L, search: Search<L>, total: L::F, w: L::F) -> (Search<L>, Row<L>) {
        let (mass, fraction) = search.end(lanes);
        let [phi, per_phi] = lanes.gather_pair(self.grid.phi.cells(), search.cell);
        let first = (search.first + search.cell) * lanes.splat_int(1 << self.grid.column_bits);
        let row = Row { phi: phi + fraction / per_phi, scale: per_phi / total };
        (Search::new(lanes, first, unit(lanes, w) * mass, mass), row)
    }

    /// One step of the search of a column.
    #[inline(always)]
    pub(crate) fn column_step<L: Lanes>(
        &self,
        lanes: L,
        search: Search<L>,
        half: i32,
        weights: &[L::F; 4],
    ) -> Search<L> {
        search.step(lanes, self.columns, half, weights)
    }

    /// The sample in the column that was found.
    #[inline(always)]
    pub(crate) fn end<L: Lanes>(&self, lanes: L, search: Search<L>, row: Row<L>) -> Draw<L> {
        let (mass, fraction) = search.end(lanes);
        let [v, per_v] = lanes.gather_pair(&self.grid.columns, search.cell);
        Draw { v: v + fraction / per_v, phi: row.phi, density: mass * row.scale * per_v }
    }

    /// The sum of all rows.
    #[inline(always)]
    pub(crate) fn total<L: Lanes>(&self, lanes: L, place: &Place<L>) -> L::F {
        let rows = lanes.splat_int(1 << self.grid.row_bits);
        self.rows.blend(lanes, place.block * rows + rows - lanes.splat_int(1), &place.weights)
    }

    /// The density per unit of `v` and phi.
    #[inline(always)]
    pub(crate) fn density<L: Lanes>(&self, lanes: L, place: &Place<L>, v: L::F, phi: L::F) -> L::F {
        let Grid { row_bits, column_bits, .. } = *self.grid;
        let row = self.grid.phi.cell(lanes, phi).index;
        let column = self.grid.root_v.cell(lanes, v.sqrt()).index;
        let [_, per_phi] = lanes.gather_pair(self.grid.phi.cells(), row);
        let [_, per_v] = lanes.gather_pair(&self.grid.columns, column);

        let first = place.block * lanes.splat_int(1 << row_bits);
        let total = self.total(lanes, place);
        let index = (first + row) * lanes.splat_int(1 << column_bits) + column;
        let upper = self.columns.blend(lanes, index, &place.weights);
        let lower = self.columns.blend(lanes, index - lanes.splat_int(1), &place.weights);
        let lower = lower.masked(lanes.splat_int(0).lt(column));
        (upper - lower) / total * per_phi * per_v
    }
}

/// A search in progress: the target is between the sums `low` and `high`, in one of the cells that start at `cell`,
/// whose sums start at entry `first`.
#[derive(Clone, Copy)]
pub(crate) struct Search<L: Lanes> {
    pub(crate) first: L::I,
    pub(crate) cell: L::I,
    pub(crate) target: L::F,
    pub(crate) low: L::F,
    pub(crate) high: L::F,
}

/// The azimuth of a sample, and the factor from a column's mass and width to a density.
#[derive(Clone, Copy)]
pub(crate) struct Row<L: Lanes> {
    pub(crate) phi: L::F,
    pub(crate) scale: L::F,
}

impl<L: Lanes> Search<L> {
    #[inline(always)]
    fn new(lanes: L, first: L::I, target: L::F, total: L::F) -> Self {
        Search { first, cell: lanes.splat_int(0), target, low: lanes.splat(0.0), high: total }
    }

    /// Halves the number of remaining cells, from twice `half`.
    #[inline(always)]
    fn step<S: Sums>(self, lanes: L, sums: S, half: i32, weights: &[L::F; 4]) -> Self {
        let Search { first, cell, target, low, high } = self;
        let middle = sums.blend(lanes, first + cell + lanes.splat_int(half - 1), weights);
        let right = middle.le(target);
        Search {
            first,
            cell: lanes.select_int(right, cell + lanes.splat_int(half), cell),
            target,
            low: lanes.select(right, middle, low),
            high: lanes.select(right, high, middle),
        }
    }

    /// The mass of the remaining cell, and the fraction of the target in it.
    #[inline(always)]
    fn end(self, lanes: L) -> (L::F, L::F) {
        let mass = (self.high - self.low).max(lanes.splat(f32::MIN_POSITIVE));
        (mass, ((self.target - self.low) / mass).min(lanes.splat(1.0)))
    }
}

/// A number clamped to `[0, 1)`; 0 for NaN.
#[inline(always)]
fn unit<L: Lanes>(lanes: L, u: L::F) -> L::F {
    u.max(lanes.splat(0.0)).min(lanes.splat(1.0 - f32::EPSILON / 2.0))
}
