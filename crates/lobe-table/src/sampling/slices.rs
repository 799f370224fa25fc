//! The cumulative sums of all slices, and their blend between the knots of sigma and psi.
//!
//! A slice is the distribution of scattered light at one knot of sigma (and psi): a histogram over rows in phi and columns
//! in `v` (see [`incident`](super::incident)). Between knots, the blend of the histograms, weighted as the table itself
//! interpolates, is a histogram again, and so are its sums: the sums are blended as they are searched, and the density
//! is exact. Slices keep the brightness that they have, so that a bright knot counts for more than a dark one, just as
//! it does in the interpolated value.

use lobe_lane::{Block, Floats, Ints, Lanes};

use super::grid::Grid;
use crate::storage::Storage;

/// The sums of the slices. The slices that one blend reads, two or four, lie side by side.
#[derive(Clone, Debug)]
pub(crate) struct Slices {
    pub(crate) grid: Grid,
    /// Slices in a blend: both ends in sigma, or in sigma and psi.
    pub(crate) width: usize,
    /// Up to and with each row, `[block][row][slice]`.
    pub(crate) rows: Storage,
    /// Within a row, up to and with each column, `[block][row][column][slice]`.
    pub(crate) columns: Storage,
}

/// Which slices a lane blends, and how much each counts.
#[derive(Clone, Copy)]
pub(crate) struct Place<L: Lanes> {
    pub(crate) block: L::I,
    /// Sigma slow, psi fast; the first two alone where psi does not count.
    pub(crate) weights: [L::F; 4],
}

/// A sample of a blend: where, and how dense per unit of `v` and phi.
#[derive(Clone, Copy)]
pub(crate) struct Draw<L: Lanes> {
    pub(crate) v: L::F,
    pub(crate) phi: L::F,
    pub(crate) density: L::F,
}

/// Sums whose slices lie side by side.
pub(crate) trait Sums: Copy {
    /// Entry `index`, blended. Outside the table it is any entry.
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
        let [rows, columns] = [&self.rows, &self.columns].map(|sums| Pairs(sums.as_slice().as_chunks().0));
        View { grid: &self.grid, rows, columns }
    }

    /// The slices of an anisotropic table.
    #[inline(always)]
    pub(crate) fn quads(&self) -> View<'_, Quads<'_>> {
        let [rows, columns] = [&self.rows, &self.columns].map(|sums| Quads(Block::new(sums.as_slice(), [0])));
        View { grid: &self.grid, rows, columns }
    }

    /// Bytes of memory that this holds.
    pub(crate) fn bytes(&self) -> usize {
        self.grid.bytes() + self.rows.bytes() + self.columns.bytes()
    }
}

impl<S: Sums> View<'_, S> {
    /// The sample for two numbers in `[0, 1)`: the first chooses the row and the phi in it, the second the column and `v`.
    #[inline(always)]
    pub(crate) fn draw<L: Lanes>(&self, lanes: L, place: &Place<L>, u: [L::F; 2]) -> Draw<L> {
        let (zero, below_one) = (lanes.splat(0.0), lanes.splat(1.0 - f32::EPSILON / 2.0));
        let [u, w] = u.map(|x| x.max(zero).min(below_one));
        let Grid { row_bits, column_bits, .. } = *self.grid;

        let first = place.block * lanes.splat_int(1 << row_bits);
        let total = self.rows.blend(lanes, first + lanes.splat_int((1 << row_bits) - 1), &place.weights);
        let (row, across) = descend(lanes, self.rows, first, row_bits, &place.weights, (u * total, total));
        let first = (first + row) * lanes.splat_int(1 << column_bits);
        let within = across.mass;
        let (column, along) = descend(lanes, self.columns, first, column_bits, &place.weights, (w * within, within));

        let [phi, per_phi] = lanes.gather_pair(self.grid.phi.cells(), row);
        let [v, per_v] = lanes.gather_pair(&self.grid.columns, column);
        let density = along.mass / total * per_phi * per_v;
        Draw { v: v + along.fraction / per_v, phi: phi + across.fraction / per_phi, density }
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
        let total = self.rows.blend(lanes, first + lanes.splat_int((1 << row_bits) - 1), &place.weights);
        let index = (first + row) * lanes.splat_int(1 << column_bits) + column;
        let upper = self.columns.blend(lanes, index, &place.weights);
        let lower = self.columns.blend(lanes, index - lanes.splat_int(1), &place.weights);
        let lower = lower.masked(lanes.splat_int(0).lt(column));
        (upper - lower) / total * per_phi * per_v
    }
}

/// The mass of a cell, and how far into it the target lies.
#[derive(Clone, Copy)]
struct Found<L: Lanes> {
    mass: L::F,
    fraction: L::F,
}

/// The cell whose sums enclose `target`, among the `2^bits` whose upper sums begin at entry `first` and end with `total`.
#[inline(always)]
fn descend<L: Lanes, S: Sums>(
    lanes: L,
    sums: S,
    first: L::I,
    bits: u32,
    weights: &[L::F; 4],
    (target, total): (L::F, L::F),
) -> (L::I, Found<L>) {
    let (mut low, mut high) = (lanes.splat(0.0), total);
    let mut cell = lanes.splat_int(0);
    let mut half = (1 << bits) >> 1;
    while half > 0 {
        let middle = sums.blend(lanes, first + cell + lanes.splat_int(half - 1), weights);
        let right = middle.le(target);
        low = lanes.select(right, middle, low);
        high = lanes.select(right, high, middle);
        cell = lanes.select_int(right, cell + lanes.splat_int(half), cell);
        half >>= 1;
    }
    let mass = (high - low).max(lanes.splat(f32::MIN_POSITIVE));
    (cell, Found { mass, fraction: ((target - low) / mass).min(lanes.splat(1.0)) })
}
