//! From pairs of directions to polar angles and azimuths, in lanes.

use lobe_lane::{Floats, Lanes};

use crate::passes::block::Column;
use crate::passes::pairs::Pairs;
use crate::passes::unit::{POLE, across, azimuth, polar, unit};

/// The pairs of directions that have a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sides {
    /// Both are above the surface.
    Above,
    /// Both are on the same side of the surface.
    Same,
    /// They are on different sides of the surface.
    Opposite,
}

/// The lookup of the azimuths of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Azimuths {
    /// Both of them.
    Both,
    /// The azimuth of `wo` relative to that of `wi`, plus the angle with this cosine and sine.
    Between([f32; 2]),
    /// The angle between both, in `[0, pi]`.
    Unsigned,
}

/// Fills `theta_i`, `phi_i` (only for [`Azimuths::Both`]), `theta_o` and `phi_o`, in radians, of queries `0..n`, and
/// sets all bits of `valid` for those that have a value. `n` is a multiple of the lanes.
#[inline(always)]
pub(crate) fn run<L: Lanes, const B: usize>(
    lanes: L,
    n: usize,
    pairs: Pairs<'_, B>,
    sides: Sides,
    azimuths: Azimuths,
    angles: &mut [Column<f32, B>; 4],
    valid: &mut Column<i32, B>,
) {
    match azimuths {
        Azimuths::Both => pass(lanes, n, pairs, sides, Both, angles, valid),
        Azimuths::Between(turn) => pass(lanes, n, pairs, sides, Between { turn }, angles, valid),
        Azimuths::Unsigned => pass(lanes, n, pairs, sides, Unsigned, angles, valid),
    }
}

/// The lookup angles for the azimuths of two unit vectors above the surface, whose projections have these lengths.
trait LookUp: Copy {
    fn azimuths<L: Lanes>(self, lanes: L, wi: Across<L>, wo: Across<L>) -> [L::F; 2];
}

/// The projection of a unit vector onto the surface.
#[derive(Clone, Copy)]
struct Across<L: Lanes> {
    x: L::F,
    y: L::F,
    length: L::F,
}

impl<L: Lanes> Across<L> {
    #[inline(always)]
    fn new(lanes: L, [x, y, _]: [L::F; 3]) -> Self {
        Across { x, y, length: across(lanes, x, y) }
    }

    /// Along x if it has no length.
    #[inline(always)]
    fn tilted(self, lanes: L) -> Self {
        let (one, tilted) = (lanes.splat(1.0), lanes.splat(POLE).lt(self.length));
        Across {
            x: lanes.select(tilted, self.x, one),
            y: self.y.masked(tilted),
            length: lanes.select(tilted, self.length, one),
        }
    }

    /// Relative to `from`: the azimuth becomes the angle between both.
    #[inline(always)]
    fn seen_from(self, lanes: L, from: Self) -> Self {
        let (from, to) = (from.tilted(lanes), self.tilted(lanes));
        Across {
            x: lanes.mul_add(from.x, to.x, from.y * to.y),
            y: lanes.mul_add(from.x, to.y, -(from.y * to.x)),
            length: from.length * to.length,
        }
    }

    #[inline(always)]
    fn azimuth(self, lanes: L) -> L::F {
        azimuth(lanes, self.x, self.y, self.length)
    }
}

#[derive(Clone, Copy)]
struct Both;

impl LookUp for Both {
    #[inline(always)]
    fn azimuths<L: Lanes>(self, lanes: L, wi: Across<L>, wo: Across<L>) -> [L::F; 2] {
        [wi.azimuth(lanes), wo.azimuth(lanes)]
    }
}

#[derive(Clone, Copy)]
struct Between {
    turn: [f32; 2],
}

impl LookUp for Between {
    #[inline(always)]
    fn azimuths<L: Lanes>(self, lanes: L, wi: Across<L>, wo: Across<L>) -> [L::F; 2] {
        let [cos, sin] = [lanes.splat(self.turn[0]), lanes.splat(self.turn[1])];
        let Across { x, y, length } = wo.seen_from(lanes, wi);
        let turned = Across { x: lanes.mul_add(cos, x, -(sin * y)), y: lanes.mul_add(cos, y, sin * x), length };
        [lanes.splat(0.0), turned.azimuth(lanes)]
    }
}

#[derive(Clone, Copy)]
struct Unsigned;

impl LookUp for Unsigned {
    #[inline(always)]
    fn azimuths<L: Lanes>(self, lanes: L, wi: Across<L>, wo: Across<L>) -> [L::F; 2] {
        let Across { x, y, length } = wo.seen_from(lanes, wi);
        [lanes.splat(0.0), Across { x, y: y.abs(), length }.azimuth(lanes)]
    }
}

#[inline(always)]
fn pass<L: Lanes, K: LookUp, const B: usize>(
    lanes: L,
    n: usize,
    Pairs { wi, wo }: Pairs<'_, B>,
    sides: Sides,
    look_up: K,
    angles: &mut [Column<f32, B>; 4],
    valid: &mut Column<i32, B>,
) {
    let zero = lanes.splat(0.0);
    let [theta_i, phi_i, theta_o, phi_o] = angles;
    let mut query = 0;
    while query < n {
        let (wi, wo) = (wi.load(lanes, query), wo.load(lanes, query));
        let above = [zero.lt(wi[2]), zero.lt(wo[2])];
        let below = [wi[2].lt(zero), wo[2].lt(zero)];
        let measured = match sides {
            Sides::Above => above[0] & above[1],
            Sides::Same => (above[0] & above[1]) | (below[0] & below[1]),
            Sides::Opposite => (above[0] & below[1]) | (below[0] & above[1]),
        };
        let ((wi, lit), (wo, seen)) = (unit(lanes, wi), unit(lanes, wo));
        let (across_i, across_o) = (Across::new(lanes, wi), Across::new(lanes, wo));
        theta_i.store(lanes, query, polar(lanes, across_i.length, wi[2].abs()));
        theta_o.store(lanes, query, polar(lanes, across_o.length, wo[2].abs()));
        let [incident, exit] = look_up.azimuths(lanes, across_i, across_o);
        phi_i.store(lanes, query, incident);
        phi_o.store(lanes, query, exit);
        valid.store(lanes, query, lanes.select_int(measured & lit & seen, lanes.splat_int(-1), lanes.splat_int(0)));
        query += L::LANES;
    }
}
