//! The passes of a block in order, and their intermediate values.

use lobe_lane::{Floats, Kernel, Lanes, call};

use super::angles::{self, Incident};
use super::frame::{self, Frame};
use super::grid::Places;
use super::invert::{self, Blend, Inverse};
use super::spectra::At;
use super::table::Table;
use crate::grid::cells;
use crate::grid::texels::Tile;
use crate::grid::weights::{self, MAX_CORNERS};
use crate::passes::block::{BLOCK, Column, registers};
use crate::passes::pairs::Pairs;

/// The intermediate values of a block.
pub(super) struct Scratch {
    pub(super) frame: Frame,
    pub(super) incident: Incident,
    pub(super) blend: Blend,
    /// The position of the half vector, and the uniform position that the visible normals warp to it.
    pub(super) u_m: [Column; 2],
    pub(super) s: [Column; 2],
    places: Places,
    pub(super) density: Column,
    pub(super) weights: [Column; MAX_CORNERS],
    tile: Tile,
}

impl Scratch {
    pub(super) const ZERO: Self = Scratch {
        frame: Frame::ZERO,
        incident: Incident::ZERO,
        blend: Blend::ZERO,
        u_m: [Column::<f32>::ZERO; 2],
        s: [Column::<f32>::ZERO; 2],
        places: Places::ZERO,
        density: Column::<f32>::ZERO,
        weights: [Column::<f32>::ZERO; MAX_CORNERS],
        tile: [[0.0; BLOCK]; 4],
    };
}

impl Table {
    /// The passes shared by values and densities: the places of queries `0..n` in the tables.
    #[inline(always)]
    pub(super) fn locate<L: Lanes, const SLICES: usize>(
        &self,
        lanes: L,
        n: usize,
        pairs: Pairs<'_>,
        cosine: bool,
        scratch: &mut Scratch,
    ) {
        let Scratch { frame, incident, blend, u_m, places, s, density, .. } = scratch;
        frame::run(lanes, n, pairs, self.symmetry, cosine, frame);
        angles::incident(lanes, n, self.azimuthal, frame, incident);
        angles::half(lanes, n, frame, u_m);
        call(lanes, Slices::<SLICES> { table: self, n, valid: &mut frame.valid, incident, blend: &mut *blend });
        places.find(lanes, n, &self.vndf.grid, &blend.slice, u_m);
        invert::run::<L, SLICES>(lanes, n, &self.vndf, u_m, blend, places, Inverse { s, density });
    }

    /// The density over solid angle of the located queries `0..n`, which replaces that of the visible normals.
    #[inline(always)]
    pub(super) fn density<L: Lanes, const SLICES: usize>(&self, lanes: L, n: usize, scratch: &mut Scratch) {
        let Scratch { frame, blend, u_m, places, s, density, .. } = scratch;
        places.find(lanes, n, &self.luminance.grid, &blend.slice, s);
        invert::multiply_density::<L, SLICES>(lanes, n, &self.luminance, blend, places, density);
        let mut query = 0;
        while query < n {
            let sin_m = frame.sin2_m.load(lanes, query).sqrt();
            let jacobian = angles::jacobian(lanes, frame.cos_d.load(lanes, query), u_m[0].load(lanes, query), sin_m);
            density.store(lanes, query, density.load(lanes, query) / jacobian);
            query += L::LANES;
        }
    }
}

/// The slices that queries `0..n` blend; none if they are not `valid`. The angles become fractions. Evaluation and
/// sampling call this kernel, so that it is compiled once.
pub(super) struct Slices<'a, const SLICES: usize> {
    pub(super) table: &'a Table,
    pub(super) n: usize,
    pub(super) valid: &'a mut Column<i32>,
    pub(super) incident: &'a mut Incident,
    pub(super) blend: &'a mut Blend,
}

impl<const SLICES: usize> Kernel for Slices<'_, SLICES> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Slices { table, n, valid, incident: Incident { theta, phi, .. }, blend } = self;
        let n = registers(lanes, n);
        blend.slice = Column::<i32>::ZERO;
        let axes = [(&table.theta_i, 1), (&table.phi_i, table.theta_i.knots().len())];
        let mut axis = 0;
        while axis < SLICES / 2 {
            let (knots, stride) = axes[axis];
            let angle = if axis == 0 { &mut *theta } else { &mut *phi };
            cells::run(lanes, n, knots, stride, angle, &mut blend.slice, valid);
            axis += 1;
        }
        if SLICES == 4 {
            weights::run(lanes, n, [phi, theta], valid, 1.0, &mut blend.weights);
        } else {
            weights::run(lanes, n, [theta], valid, 1.0, &mut blend.weights);
        }
    }
}

/// The values of the located queries `0..n`. Evaluation and sampling call this kernel, so that it is compiled once.
pub(super) struct Values<'a, const SLICES: usize, const PAIRS: usize, const FOURS: usize> {
    pub(super) table: &'a Table,
    pub(super) n: usize,
    pub(super) scratch: &'a mut Scratch,
    pub(super) out: &'a mut [f32],
}

impl<const SLICES: usize, const PAIRS: usize, const FOURS: usize> Kernel for Values<'_, SLICES, PAIRS, FOURS> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Values { table, n, scratch, out } = self;
        let n = registers(lanes, n);
        let Scratch { frame, incident, blend, u_m, places, s, weights, tile, .. } = scratch;
        if let Some(factor) = &table.factor {
            factor.run(lanes, n, &incident.u, u_m, &mut frame.factor);
        }
        places.find(lanes, n, &table.spectra.grid, &blend.slice, s);
        let at = At { places, blend, factor: &frame.factor };
        table.spectra.run::<L, SLICES, PAIRS, FOURS>(lanes, n, at, weights, tile, out);
    }
}
