//! The slices around incident directions.

use lobe_lane::{Floats, Lanes};

use super::incident::Incident;
use super::slices::Place;
use crate::grid::axis::Axis;
use crate::passes::block::Column;

/// The slices around the incident directions of a block.
pub(super) struct Places {
    block: Column<i32>,
    weights: [Column; 4],
}

impl Places {
    pub(super) const ZERO: Self = Places { block: Column::<i32>::ZERO, weights: [Column::<f32>::ZERO; 4] };

    #[inline(always)]
    pub(super) fn load<L: Lanes>(&self, lanes: L, at: usize) -> Place<L> {
        let [a, b, c, d] = &self.weights;
        let weights = [a.load(lanes, at), b.load(lanes, at), c.load(lanes, at), d.load(lanes, at)];
        Place { block: self.block.load(lanes, at), weights }
    }

    #[inline(always)]
    pub(super) fn store<L: Lanes>(&mut self, lanes: L, at: usize, Place { block, weights }: Place<L>) {
        self.block.store(lanes, at, block);
        let mut slice = 0;
        while slice < 4 {
            self.weights[slice].store(lanes, at, weights[slice]);
            slice += 1;
        }
    }
}

/// The cell of an angle and the fraction into it, never outside.
#[inline(always)]
fn cell<L: Lanes>(lanes: L, axis: &Axis, angle: L::F) -> (L::I, L::F) {
    let cell = axis.cell(lanes, axis.bring_inside(lanes, angle));
    (cell.index, cell.fraction.max(lanes.splat(0.0)).min(lanes.splat(1.0)))
}

/// The slices around an incident direction, in sigma and psi.
#[inline(always)]
pub(super) fn place<L: Lanes>(lanes: L, sigma: &Axis, psi: Option<&Axis>, incident: &Incident<L>) -> Place<L> {
    let one = lanes.splat(1.0);
    let rest = incident.sin2 / (one + incident.cos);
    let (sigma, up) = cell(lanes, sigma, lobe_math::acos_from(lanes, incident.cos, rest));
    let down = one - up;
    let Some(axis) = psi else {
        let zero = lanes.splat(0.0);
        return Place { block: sigma, weights: [down, up, zero, zero] };
    };
    let [cos_psi, sin_psi] = incident.psi;
    let (psi, on) = cell(lanes, axis, lobe_math::azimuth(lanes, sin_psi, cos_psi));
    let back = one - on;
    let block = sigma * lanes.splat_int(axis.cells().len() as i32) + psi;
    Place { block, weights: [down * back, down * on, up * back, up * on] }
}
