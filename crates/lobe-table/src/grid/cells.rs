//! Angles to cells, one axis at a time.

use lobe_lane::{Floats, Ints, Lanes};

use super::axis::Axis;
use super::edges::Edge;
use super::find::{Cell, Find, Visitor};
use crate::passes::block::Column;

/// Replaces the angles of queries `0..n` by the fraction into their cell, and adds the cell's offset to `base`.
///
/// Queries outside an axis of [`Edge::Zero`] lose their `valid` bits.
#[inline(always)]
pub(crate) fn run<L: Lanes, const B: usize>(
    lanes: L,
    n: usize,
    axis: &Axis,
    stride: usize,
    angle: &mut Column<f32, B>,
    base: &mut Column<i32, B>,
    valid: &mut Column<i32, B>,
) {
    axis.visit(lanes, Pass { lanes, n, axis, stride, angle, base, valid });
}

struct Pass<'a, L, const B: usize> {
    lanes: L,
    n: usize,
    axis: &'a Axis,
    stride: usize,
    angle: &'a mut Column<f32, B>,
    base: &'a mut Column<i32, B>,
    valid: &'a mut Column<i32, B>,
}

impl<L: Lanes, const B: usize> Visitor<L> for Pass<'_, L, B> {
    type Out = ();

    #[inline(always)]
    fn visit<S: Find<L>>(self, find: S) {
        let Pass { lanes, n, axis, stride, angle, base, valid } = self;
        if axis.edge() == Edge::Zero {
            leave_out(lanes, n, axis, angle, valid);
        }
        let [low, high] = axis.bounds.clamp;
        let (low, high) = (lanes.splat(low), lanes.splat(high));
        let stride = lanes.splat_int(stride as i32);
        // Few axes begin above 0, so few angles have to be wrapped.
        if axis.bounds.turn_below > 0.0 {
            turn_up(lanes, n, axis, angle);
        }
        let mut query = 0;
        while query < n {
            let x = angle.load(lanes, query).max(low).min(high);
            let Cell { index, fraction } = find.find(lanes, x);
            angle.store(lanes, query, fraction);
            base.store(lanes, query, base.load(lanes, query) + index * stride);
            query += L::LANES;
        }
    }
}

/// Queries outside the axis lose their `valid` bits.
#[inline(always)]
fn leave_out<L: Lanes, const B: usize>(
    lanes: L,
    n: usize,
    axis: &Axis,
    angle: &Column<f32, B>,
    valid: &mut Column<i32, B>,
) {
    let zero = lanes.splat_int(0);
    let mut query = 0;
    while query < n {
        let keep = axis.contains(lanes, angle.load(lanes, query)) & valid.load(lanes, query).lt(zero);
        valid.store(lanes, query, lanes.select_int(keep, lanes.splat_int(-1), zero));
        query += L::LANES;
    }
}

/// Angles below the first knot are increased by a turn.
#[inline(always)]
fn turn_up<L: Lanes, const B: usize>(lanes: L, n: usize, axis: &Axis, angle: &mut Column<f32, B>) {
    let mut query = 0;
    while query < n {
        angle.store(lanes, query, axis.bring_inside(lanes, angle.load(lanes, query)));
        query += L::LANES;
    }
}
