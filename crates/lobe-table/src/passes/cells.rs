//! Angles to cells, one axis at a time.

use lobe_lane::{Ints, Lanes};

use super::block::{BLOCK, Column};
use crate::Edge;
use crate::axis::Axis;
use crate::search::{Cell, Find, Visitor};

/// Replaces the angles of queries `0..n` by the fraction into their cell, and adds the cell's offset to `base`.
///
/// Queries outside an axis of [`Edge::Zero`] lose their `valid` bits.
#[inline(always)]
pub(crate) fn run<L: Lanes>(
    lanes: L,
    n: usize,
    axis: &Axis,
    stride: usize,
    angle: &mut Column,
    base: &mut Column<i32>,
    valid: &mut Column<i32>,
) {
    axis.visit(lanes, Pass { lanes, n, axis, stride, angle, base, valid });
}

struct Pass<'a, L> {
    lanes: L,
    n: usize,
    axis: &'a Axis,
    stride: usize,
    angle: &'a mut Column,
    base: &'a mut Column<i32>,
    valid: &'a mut Column<i32>,
}

impl<L: Lanes> Visitor<L> for Pass<'_, L> {
    type Out = ();

    #[inline(always)]
    fn visit<S: Find<L>>(self, find: S) {
        let Pass { lanes, n, axis, stride, angle, base, valid } = self;
        let stride = lanes.splat_int(stride as i32);
        let zero_outside = axis.edge() == Edge::Zero;
        let mut query = 0;
        while query < n && query < BLOCK {
            let (x, inside) = axis.bring_inside(lanes, angle.load(lanes, query));
            if zero_outside {
                let keep = inside & valid.load(lanes, query).lt(lanes.splat_int(0));
                valid.store(lanes, query, lanes.select_int(keep, lanes.splat_int(-1), lanes.splat_int(0)));
            }
            let Cell { index, fraction } = find.find(lanes, x);
            angle.store(lanes, query, fraction);
            base.store(lanes, query, base.load(lanes, query) + index * stride);
            query += L::LANES;
        }
    }
}
