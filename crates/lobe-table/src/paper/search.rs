//! Binary search of a knot array for all lanes at once (paper, section 2.2).
//!
//! All lanes take the same branch as long as they agree. When they do not, the branch of the lanes at or above the knot
//! waits on a stack, and the others continue. The sets of lanes on the stack and in progress are disjoint, so at most
//! `LANES - 1` branches ever wait.
//!
//! A caller seldom wants just the index. The specialised versions write the interpolation weights, or the value of a
//! function of one variable, at the end of a branch: there, every lane of the branch has the same cell, so the cell is
//! read once and no indexing by lane is needed.

use lobe_lane::{Floats, Ints, Lanes, MAX_LANES, Mask};

/// The cell of each lane of `x` as a float; 0 in lanes outside the mask. Queries outside the knots belong to the
/// outermost cells.
///
/// # Panics
/// If there are fewer than two knots.
#[inline(always)]
pub fn index<L: Lanes>(lanes: L, knots: &[f32], x: L::F, mask: L::M) -> L::F {
    let mut index = lanes.splat(0.0);
    search(lanes, knots, x, mask, Index(&mut index));
    index
}

/// The cell of each lane of `x` as a float, and the weights of its two knots; all 0 in lanes outside the mask.
///
/// `cells[i]` is `[knots[i], 1 / (knots[i + 1] - knots[i])]`.
///
/// # Panics
/// If there are fewer than two knots, or fewer cells than the number of knots minus one.
#[inline(always)]
pub fn weights<L: Lanes>(lanes: L, knots: &[f32], cells: &[[f32; 2]], x: L::F, mask: L::M) -> (L::F, [L::F; 2]) {
    let zero = lanes.splat(0.0);
    let (mut index, mut weights) = (zero, [zero; 2]);
    search(lanes, knots, x, mask, Weights { cells, x, index: &mut index, weights: &mut weights });
    (index, weights)
}

/// The value at `x` of a piecewise linear function; 0 in lanes outside the mask.
///
/// `cells[i]` is the value at `knots[i]` and the slope from there to the next knot.
///
/// # Panics
/// If there are fewer than two knots, or fewer cells than the number of knots minus one.
#[inline(always)]
pub fn value<L: Lanes>(lanes: L, knots: &[f32], cells: &[[f32; 2]], x: L::F, mask: L::M) -> L::F {
    let mut value = lanes.splat(0.0);
    search(lanes, knots, x, mask, Value { knots, cells, x, value: &mut value });
    value
}

/// The output that is written at the end of a branch.
trait Leaf<L: Lanes> {
    /// Writes for `cell` under the mask. Must be `#[inline(always)]`.
    fn write(&mut self, lanes: L, cell: usize, mask: L::M);
}

struct Index<'a, F>(&'a mut F);

impl<L: Lanes> Leaf<L> for Index<'_, L::F> {
    #[inline(always)]
    fn write(&mut self, lanes: L, cell: usize, mask: L::M) {
        *self.0 = lanes.select(mask, lanes.splat(cell as f32), *self.0);
    }
}

struct Weights<'a, F> {
    cells: &'a [[f32; 2]],
    x: F,
    index: &'a mut F,
    weights: &'a mut [F; 2],
}

impl<L: Lanes> Leaf<L> for Weights<'_, L::F> {
    #[inline(always)]
    fn write(&mut self, lanes: L, cell: usize, mask: L::M) {
        let [first, inverse] = self.cells[cell];
        let upper = (self.x - lanes.splat(first)) * lanes.splat(inverse);
        let lower = lanes.splat(1.0) - upper;
        *self.index = lanes.select(mask, lanes.splat(cell as f32), *self.index);
        self.weights[0] = lanes.select(mask, lower, self.weights[0]);
        self.weights[1] = lanes.select(mask, upper, self.weights[1]);
    }
}

struct Value<'a, F> {
    knots: &'a [f32],
    cells: &'a [[f32; 2]],
    x: F,
    value: &'a mut F,
}

impl<L: Lanes> Leaf<L> for Value<'_, L::F> {
    #[inline(always)]
    fn write(&mut self, lanes: L, cell: usize, mask: L::M) {
        let [value, slope] = self.cells[cell];
        let into = self.x - lanes.splat(self.knots[cell]);
        let value = lanes.mul_add(into, lanes.splat(slope), lanes.splat(value));
        *self.value = lanes.select(mask, value, *self.value);
    }
}

/// The lanes whose cell is in `low..high`.
#[derive(Clone, Copy)]
struct Branch {
    low: u32,
    high: u32,
    /// One bit per lane.
    lanes: u32,
}

impl Branch {
    /// Descends until one cell is left, or until the lanes disagree; then the branch of the upper lanes is returned.
    #[inline(always)]
    fn descend<L: Lanes>(&mut self, lanes: L, knots: &[f32], x: L::F) -> Option<Branch> {
        while self.high - self.low > 1 {
            let middle = (self.low + self.high) / 2;
            let below = x.lt(lanes.splat(knots[middle as usize])).bits() & self.lanes;
            if below == self.lanes {
                self.high = middle;
            } else if below == 0 {
                self.low = middle;
            } else {
                let upper = Branch { low: middle, high: self.high, lanes: self.lanes & !below };
                *self = Branch { low: self.low, high: middle, lanes: below };
                return Some(upper);
            }
        }
        None
    }

    /// The lanes as a mask.
    #[inline(always)]
    fn mask<L: Lanes>(&self, lanes: L) -> L::M {
        const BITS: [i32; MAX_LANES] = {
            let mut bits = [0; MAX_LANES];
            let mut lane = 0;
            while lane < MAX_LANES {
                bits[lane] = 1 << lane;
                lane += 1;
            }
            bits
        };
        let bit = lanes.load_int(&BITS);
        (lanes.splat_int(self.lanes as i32) & bit).eq(bit)
    }
}

#[inline(always)]
fn search<L: Lanes>(lanes: L, knots: &[f32], x: L::F, mask: L::M, mut leaf: impl Leaf<L>) {
    assert!(knots.len() > 1, "a search needs two knots");
    let mut here = Branch { low: 0, high: knots.len() as u32 - 1, lanes: mask.bits() };
    // A coherent packet arrives here with an empty stack.
    let Some(upper) = here.descend(lanes, knots, x) else {
        return leaf.write(lanes, here.low as usize, mask);
    };
    let mut stack = [upper; MAX_LANES - 1];
    let mut waiting = 1;
    loop {
        while let Some(upper) = here.descend(lanes, knots, x) {
            stack[waiting] = upper;
            waiting += 1;
        }
        leaf.write(lanes, here.low as usize, here.mask(lanes));
        if waiting == 0 {
            return;
        }
        waiting -= 1;
        here = stack[waiting];
    }
}
