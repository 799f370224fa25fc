//! From directions to the patches of a basis, in SIMD lanes.

use std::f32::consts::{FRAC_1_PI, TAU};

use lobe_lane::{Floats, Ints, Lanes};

use super::matrix::{AngleBasis, SAME_BOUND};
use crate::grid::axis::Axis;
use crate::grid::cells;
use crate::grid::edges::Edge;
use crate::invalid::Invalid;
use crate::passes::block::Column;
use crate::passes::unit::spherical;

/// The rings of a basis, as an axis, and their sectors.
#[derive(Clone, Debug)]
pub(crate) struct Patches {
    basis: AngleBasis,
    /// -1 if the direction is reversed in the plane of the surface before the lookup, otherwise 1.
    sign: f32,
    rings: Axis,
    /// The first patch of each ring, and its number of patches.
    sectors: Vec<[f32; 2]>,
    /// Polar angles of at least this have no patch.
    end: f32,
}

/// The data for finding patches.
#[derive(Clone, Copy)]
pub(crate) struct PatchScratch {
    theta: Column,
    phi: Column,
    ring: Column<i32>,
}

impl PatchScratch {
    pub(crate) const ZERO: Self =
        PatchScratch { theta: Column::<f32>::ZERO, phi: Column::<f32>::ZERO, ring: Column::<i32>::ZERO };
}

impl Patches {
    /// The patches through which light arrives, found by the direction in which it travels.
    ///
    /// # Errors
    /// [`Invalid`] if no ring is wide enough for its bounds to differ in `f32`.
    pub(crate) fn arriving(basis: &AngleBasis) -> Result<Self, Invalid> {
        Patches::new(basis, -1.0)
    }

    /// The patches through which light leaves.
    ///
    /// # Errors
    /// The same as for [`arriving`](Self::arriving).
    pub(crate) fn leaving(basis: &AngleBasis) -> Result<Self, Invalid> {
        Patches::new(basis, 1.0)
    }

    fn new(basis: &AngleBasis, sign: f32) -> Result<Self, Invalid> {
        let (mut bounds, mut sectors, mut first) = (vec![0.0], Vec::new(), 0);
        for ring in basis.rings() {
            let upper = ring.upper.to_radians();
            // A ring that ends where another one ends, or before, contains no direction.
            if bounds.last().is_some_and(|&last: &f64| upper as f32 > last as f32) {
                bounds.push(upper);
                sectors.push([first as f32, ring.patches as f32]);
            }
            first += ring.patches;
        }
        let rings = Axis::new(&bounds, Edge::Clamp);
        let rings = rings.map_err(|error| Invalid::new("AngleBasis", error.to_string(), "ascending bounds"))?;
        if sectors.is_empty() {
            return Err(Invalid::new("AngleBasis", "rings of no width", "at least one ring"));
        }
        let last = basis.rings().last().map_or(0.0, |ring| ring.upper);
        // The horizon belongs to the last ring.
        let end = if last >= 90.0 - SAME_BOUND { TAU } else { last.to_radians() as f32 };
        Ok(Patches { basis: basis.clone(), sign, rings, sectors, end })
    }

    /// The basis that this was built from.
    pub(crate) fn basis(&self) -> &AngleBasis {
        &self.basis
    }

    /// The patches of queries `0..n`. `toward` are unit vectors on any side. Directions without a patch lose their
    /// `valid` bits.
    #[inline(always)]
    pub(crate) fn find<L: Lanes>(
        &self,
        lanes: L,
        n: usize,
        toward: &[Column; 3],
        PatchScratch { theta, phi, ring }: &mut PatchScratch,
        patch: &mut Column<i32>,
        valid: &mut Column<i32>,
    ) {
        let (zero, half) = (lanes.splat(0.0), lanes.splat(0.5));
        let (sign, end) = (lanes.splat(self.sign), lanes.splat(self.end));
        let none = lanes.splat_int(0);
        let [x, y, z] = toward;
        let mut query = 0;
        while query < n {
            let x = x.load(lanes, query).mul_sign(sign);
            let y = y.load(lanes, query).mul_sign(sign);
            let [polar, azimuth] = spherical(lanes, [x, y, z.load(lanes, query).abs()]);
            theta.store(lanes, query, polar);
            phi.store(lanes, query, azimuth);
            valid.store(lanes, query, lanes.select_int(polar.lt(end), valid.load(lanes, query), none));
            query += L::LANES;
        }
        *ring = Column::<i32>::ZERO;
        cells::run(lanes, n, &self.rings, 1, theta, ring, valid);
        let turns = lanes.splat(0.5 * FRAC_1_PI);
        let mut query = 0;
        while query < n {
            let [first, count] = lanes.gather_pair(&self.sectors, ring.load(lanes, query));
            // The first sector of a ring is centred on +x, so the end of the turn also belongs to it.
            let sector = lanes.mul_add(phi.load(lanes, query) * turns, count, half).to_int().to_float();
            let sector = lanes.select(sector.lt(count), sector, zero);
            patch.store(lanes, query, (first + sector).to_int());
            query += L::LANES;
        }
    }
}
