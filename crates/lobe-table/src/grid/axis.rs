//! One axis of a table, prepared for searching.

use std::f64::consts::TAU;

use thiserror::Error;

use super::edges::ROUNDING;
use super::tree::{self, Tree};
use crate::Edge;

/// An axis with at most this many cells is searched inside registers, or by counting knots.
pub(crate) const MAX_REGISTER_CELLS: usize = 32;

/// The knots of one axis in `f32` radians, and the data that its kind of search needs.
///
/// A periodic axis whose knots stop short of the full circle has one knot more than its file: the first one again, a
/// turn later.
#[derive(Clone, Debug)]
pub struct Axis {
    knots: Vec<f32>,
    /// `[knots[i], 1 / (knots[i + 1] - knots[i])]` for each cell.
    cells: Vec<[f32; 2]>,
    /// For each knot, the index of the knot in the file whose values it has.
    source: Vec<usize>,
    edge: Edge,
    pub(crate) bounds: Bounds,
    search: Search,
}

/// The edge policy as numbers, so that it is applied without a branch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    /// Angles below this are increased by a turn.
    pub(crate) turn_below: f32,
    /// The range to which angles are clamped: at most the range of all angles, so that no NaN passes.
    pub(crate) clamp: [f32; 2],
    /// The value is 0 outside these.
    pub(crate) inside: [f32; 2],
}

impl Bounds {
    fn new(edge: Edge, first: f32, last: f32) -> Self {
        const EVERYWHERE: [f32; 2] = [f32::NEG_INFINITY, f32::INFINITY];
        let turn = std::f32::consts::TAU;
        let rounding = ROUNDING as f32;
        Bounds {
            turn_below: if edge == Edge::Periodic { first } else { f32::NEG_INFINITY },
            clamp: if edge == Edge::Extrapolate { [-turn, 2.0 * turn] } else { [first, last] },
            inside: if edge == Edge::Zero { [first - rounding, last + rounding] } else { EVERYWHERE },
        }
    }
}

/// Knots that cannot form an axis.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum AxisError {
    /// No knots.
    #[error("no knots; expected at least one")]
    NoKnots,
    /// A knot that is not finite, or not above the one before it after rounding to `f32`.
    #[error("knot {index} is {value} rad; expected finite, strictly ascending knots")]
    Knot {
        /// Position in the list of knots.
        index: usize,
        /// What was found.
        value: f64,
    },
    /// A function needs a value at each knot.
    #[error("{values} values at {knots} knots; expected one each")]
    Values {
        /// The number of knots.
        knots: usize,
        /// The number of values.
        values: usize,
    },
}

/// Stands for a knot that does not exist: no query is at or above it, not even an infinite one.
const BEYOND: f32 = f32::NAN;

/// The way to find the cell of a query.
#[derive(Clone, Debug)]
pub(crate) enum Search {
    /// One knot: cell 0, fraction 0.
    Constant,
    /// Equal cells: `cells_per_radian`, starting at the first knot.
    Uniform { cells_per_radian: f32 },
    /// Few cells: a search tree of the inner knots and the cells, both in registers.
    Registers(Box<Registers>),
    /// Many cells: a table over equal buckets gives the cell at the start of each. Wide registers may instead hold a
    /// tree of the cells.
    Guide { buckets_per_radian: f32, buckets: Vec<[f32; 2]>, steps: usize, tree: Option<Box<Tree>> },
}

/// Up to 31 inner knots, both sorted and in the order of a breadth-first search tree with root node 1, missing ones as
/// [`BEYOND`], and the first knots and inverse widths of the cells.
#[derive(Clone, Debug)]
pub(crate) struct Registers {
    pub(crate) levels: usize,
    pub(crate) sorted: [f32; 32],
    pub(crate) tree: [f32; 32],
    pub(crate) first: [f32; 32],
    pub(crate) inverse: [f32; 32],
    /// The same for wide registers.
    pub(crate) wide: Tree,
}

impl Axis {
    /// Prepares knots in radians.
    ///
    /// # Errors
    /// If there is no knot, one is not finite, or they do not ascend strictly in `f32`.
    pub fn new(knots: &[f64], edge: Edge) -> Result<Self, AxisError> {
        if knots.is_empty() {
            return Err(AxisError::NoKnots);
        }
        for (index, &value) in knots.iter().enumerate() {
            let ascends = index == 0 || value as f32 > knots[index - 1] as f32;
            if !(value.is_finite() && ascends) {
                return Err(AxisError::Knot { index, value });
            }
        }
        let mut source: Vec<usize> = (0..knots.len()).collect();
        let mut exact = knots.to_vec();
        let gap = knots[0] + TAU - knots[knots.len() - 1];
        if edge == Edge::Periodic && knots.len() > 1 && gap > ROUNDING {
            exact.push(knots[0] + TAU);
            source.push(0);
        }
        let knots: Vec<f32> = exact.iter().map(|&knot| knot as f32).collect();
        let cells: Vec<[f32; 2]> = exact.windows(2).map(|ends| [ends[0] as f32, inverse(ends[1] - ends[0])]).collect();
        let search = if cells.is_empty() {
            Search::Constant
        } else if let Some(cells_per_radian) = uniform(&exact) {
            Search::Uniform { cells_per_radian }
        } else if cells.len() <= MAX_REGISTER_CELLS {
            Search::Registers(Box::new(Registers::new(&knots, &cells)))
        } else {
            guide(&knots, &cells)
        };
        let bounds = Bounds::new(edge, knots[0], knots[knots.len() - 1]);
        Ok(Axis { knots, cells, source, edge, bounds, search })
    }

    /// The knots in radians.
    pub fn knots(&self) -> &[f32] {
        &self.knots
    }

    /// The behaviour outside the knots.
    pub fn edge(&self) -> Edge {
        self.edge
    }

    /// For each knot, the index among the given knots of the one whose values it has.
    pub(crate) fn source(&self) -> &[usize] {
        &self.source
    }

    pub(crate) fn cells(&self) -> &[[f32; 2]] {
        &self.cells
    }

    pub(crate) fn search(&self) -> &Search {
        &self.search
    }

    pub(crate) fn first(&self) -> f32 {
        self.knots[0]
    }

    /// Bytes of memory that this holds.
    pub fn bytes(&self) -> usize {
        let search = match &self.search {
            Search::Constant | Search::Uniform { .. } => 0,
            Search::Registers(_) => size_of::<Registers>(),
            Search::Guide { buckets, tree, .. } => {
                size_of_val(buckets.as_slice()) + tree.as_deref().map_or(0, size_of_val)
            }
        };
        size_of_val(self.knots.as_slice())
            + size_of_val(self.cells.as_slice())
            + size_of_val(self.source.as_slice())
            + search
    }
}

/// `1 / width`, at most the largest float: a cell may be so narrow that its inverse overflows.
fn inverse(width: f64) -> f32 {
    (1.0 / width).min(f64::from(f32::MAX)) as f32
}

/// Cells per radian if all cells are equal to within `f32` rounding of the knots.
fn uniform(knots: &[f64]) -> Option<f32> {
    let cells = knots.len() - 1;
    let (first, last) = (knots[0], knots[cells]);
    let width = (last - first) / cells as f64;
    let tolerance = f64::from(f32::EPSILON) * last.abs().max(width);
    let equal = knots.iter().enumerate().all(|(i, knot)| (knot - (first + i as f64 * width)).abs() <= tolerance);
    (equal && cells > 1).then(|| inverse(width))
}

impl Registers {
    fn new(knots: &[f32], cells: &[[f32; 2]]) -> Self {
        let inner = &knots[1..knots.len() - 1];
        // The searches exist in three depths.
        let levels = ((inner.len() + 1).next_power_of_two().ilog2() as usize).max(3);
        let mut tree = [BEYOND; 32];
        // Node k of level l is the middle of the k-th of 2^l parts of the sorted knots.
        for (node, knot) in tree.iter_mut().enumerate().take(1 << levels).skip(1) {
            let level = node.ilog2() as usize;
            let part = 1 << (levels - level);
            let rank = (node - (1 << level)) * part + part / 2 - 1;
            *knot = inner.get(rank).copied().unwrap_or(BEYOND);
        }
        // No lookup goes beyond the last cell; the padding repeats its values, so that nothing there is special.
        let padded = |column: usize| std::array::from_fn(|i| cells[i.min(cells.len() - 1)][column]);
        let sorted = std::array::from_fn(|i| inner.get(i).copied().unwrap_or(BEYOND));
        let wide = Tree::new(knots, cells);
        Registers { levels, sorted, tree, first: padded(0), inverse: padded(1), wide }
    }
}

/// The smallest in a sequence of bucket counts with at most one inner knot per bucket, or the largest that was tried.
fn guide(knots: &[f32], cells: &[[f32; 2]]) -> Search {
    let inner = &knots[1..knots.len() - 1];
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let mut count = 2 * knots.len();
    loop {
        let buckets_per_radian = count as f32 / (last - first);
        let bucket = |x: f32| (((x - first) * buckets_per_radian) as usize).min(count - 1);
        // Rounded exactly as a query is, so a knot's bucket is the bucket of every query at that knot.
        let mut buckets = vec![[0.0, BEYOND]; count];
        let mut steps = 1;
        let mut below = 0;
        for (b, entry) in buckets.iter_mut().enumerate() {
            let inside = inner[below..].iter().take_while(|&&knot| bucket(knot) == b).count();
            *entry = [below as f32, inner.get(below).copied().unwrap_or(BEYOND)];
            below += inside;
            steps = steps.max(inside);
        }
        if steps == 1 || count >= 64 * knots.len() {
            let tree = (cells.len() <= tree::MAX_CELLS).then(|| Box::new(Tree::new(knots, cells)));
            return Search::Guide { buckets_per_radian, buckets, steps, tree };
        }
        count += count / 2;
    }
}
