//! The place of an angle among knots, one query at a time in `f64`: the reference for the cells of the lanes.

use std::f64::consts::TAU;

use super::edges::{Edge, ROUNDING};

/// The two nodes around a query on one axis, and their weights. A query at a knot is in the cell above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neighbours {
    pub(crate) nodes: [usize; 2],
    pub(crate) weights: [f64; 2],
}

impl Neighbours {
    /// On an axis of one knot.
    pub(crate) const ONLY: Self = Neighbours { nodes: [0, 0], weights: [1.0, 0.0] };

    /// The place of `x` among ascending knots, of which there is at least one. `None` if the value is 0 because `x` is
    /// outside.
    pub(crate) fn find<K: Copy + Into<f64>>(knots: &[K], edge: Edge, x: f64) -> Option<Self> {
        let (first, last) = (knots[0].into(), knots[knots.len() - 1].into());
        if knots.len() == 1 {
            return Some(Neighbours::ONLY);
        }
        let x = match edge {
            Edge::Extrapolate => x,
            Edge::Zero if x < first - ROUNDING || x > last + ROUNDING => return None,
            Edge::Clamp | Edge::Zero => x.clamp(first, last),
            Edge::Periodic => {
                let x = wrap(x, first);
                let end = first + TAU;
                if last < end - ROUNDING && x > last {
                    return Some(Neighbours::between([knots.len() - 1, 0], [last, end], x));
                }
                x.min(last)
            }
        };
        let upper = knots.partition_point(|&knot| knot.into() <= x).clamp(1, knots.len() - 1);
        Some(Neighbours::between([upper - 1, upper], [knots[upper - 1].into(), knots[upper].into()], x))
    }

    /// The place of `x` among ascending knots, of which there is at least one; beyond them, the outermost one counts.
    pub(crate) fn held<K: Copy + Into<f64>>(knots: &[K], x: f64) -> Self {
        Neighbours::find(knots, Edge::Clamp, x).unwrap_or(Neighbours::ONLY)
    }

    fn between(nodes: [usize; 2], ends: [f64; 2], x: f64) -> Self {
        let fraction = (x - ends[0]) / (ends[1] - ends[0]);
        Neighbours { nodes, weights: [1.0 - fraction, fraction] }
    }
}

/// Calls `add` with the node of each corner of a cell in a grid and its weight, except for corners without weight.
pub(crate) fn corners<const AXES: usize>(cell: &[Neighbours; AXES], mut add: impl FnMut([usize; AXES], f64)) {
    for corner in 0..1_usize << AXES {
        let upper = |axis: usize| corner >> axis & 1;
        let weight: f64 = (0..AXES).map(|axis| cell[axis].weights[upper(axis)]).product();
        if weight != 0.0 {
            add(std::array::from_fn(|axis| cell[axis].nodes[upper(axis)]), weight);
        }
    }
}

/// `x` moved into `[start, start + 2 pi)`, unchanged if it already is there.
fn wrap(x: f64, start: f64) -> f64 {
    if (start..start + TAU).contains(&x) {
        return x;
    }
    let wrapped = start + (x - start).rem_euclid(TAU);
    // The remainder of a tiny negative number rounds to the full circle.
    if wrapped < start + TAU { wrapped } else { start }
}
