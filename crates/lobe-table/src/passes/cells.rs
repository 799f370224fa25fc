//! Angles to cells, one axis at a time.

use lobe_lane::{Floats, Ints, Lanes};

use super::block::Column;
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
        axis.restrict(lanes, n, angle, valid);
        let (low, high) = axis.limits();
        let (low, high, stride) = (lanes.splat(low), lanes.splat(high), lanes.splat_int(stride as i32));
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

impl Axis {
    /// The part of the edge policy that few axes need: angles of a periodic axis below its first knot move up a turn, and
    /// queries outside an axis of [`Edge::Zero`] lose their `valid` bits.
    #[inline(always)]
    fn restrict<L: Lanes>(&self, lanes: L, n: usize, angle: &mut Column, valid: &mut Column<i32>) {
        let zero = lanes.splat_int(0);
        let mut query = 0;
        match self.edge() {
            Edge::Periodic if self.first() > 0.0 => {
                while query < n {
                    angle.store(lanes, query, self.turn_up(lanes, angle.load(lanes, query)));
                    query += L::LANES;
                }
            }
            Edge::Zero => {
                while query < n {
                    let keep = self.contains(lanes, angle.load(lanes, query)) & valid.load(lanes, query).lt(zero);
                    valid.store(lanes, query, lanes.select_int(keep, lanes.splat_int(-1), zero));
                    query += L::LANES;
                }
            }
            _ => {}
        }
    }
}
