//! The yarn on top at each point, and its height.

use std::f64::consts::{PI, TAU};

/// The family of a yarn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Thread {
    /// Along y.
    Warp,
    /// Along x.
    Weft,
}

/// The geometry of a cloth in which each warp yarn passes over `over` wefts, then under `under`, shifted by one step
/// from yarn to yarn: 1 and 1 is the plain weave, others are twills.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weave {
    /// Wefts that a warp yarn passes over in a row, at least 1.
    pub over: u32,
    /// Wefts that a warp yarn passes under in a row, at least 1.
    pub under: u32,
    /// The amplitude of the middle of a yarn.
    pub crimp: f64,
    /// Height of the elliptic cross section of a yarn, from its edge to its top.
    pub roundness: f64,
    /// The ridges of the plies, warp and weft.
    pub plies: [Ply; 2],
}

/// Ridges that wind around a yarn and guide its fibres.
///
/// Their phase is `along u + across v` turns, `u` along the yarn and `v` across it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ply {
    /// Ridges per unit of length along the yarn: 0 for an untwisted yarn. It must be a whole number, so that the cloth
    /// is periodic.
    pub along: u32,
    /// Ridges across the yarn; the sign says whether the twist is S or Z. It must not be 0.
    pub across: f64,
    /// Height of a ridge above the groove next to it; 0 for a smooth yarn.
    pub depth: f64,
}

impl Ply {
    /// Parallel fibres and no ridges.
    pub const SMOOTH: Ply = Ply { along: 0, across: 1.0, depth: 0.0 };

    /// The direction of the ridges and fibres, as components along and across the yarn, not normalised.
    fn fibre(&self) -> [f64; 2] {
        [1.0, -f64::from(self.along) / self.across]
    }
}

impl Weave {
    /// Number of yarns after which the pattern repeats, in both directions.
    pub(super) fn period(&self) -> u32 {
        self.over + self.under
    }

    /// The yarn on top at a point of the cloth, and its height.
    pub(super) fn top(&self, x: f64, y: f64) -> (Thread, f64) {
        let warp = self.height(Thread::Warp, x, y);
        let weft = self.height(Thread::Weft, x, y);
        if warp >= weft { (Thread::Warp, warp) } else { (Thread::Weft, weft) }
    }

    /// The direction of the fibres of a yarn in the plane of the cloth, not normalised.
    pub(super) fn fibre(&self, thread: Thread) -> [f64; 2] {
        match (thread, self.plies) {
            (Thread::Warp, [ply, _]) => [ply.fibre()[1], ply.fibre()[0]],
            (Thread::Weft, [_, ply]) => ply.fibre(),
        }
    }

    fn height(&self, thread: Thread, x: f64, y: f64) -> f64 {
        let (u, v, ply) = match thread {
            Thread::Warp => (y, x, self.plies[0]),
            Thread::Weft => (x, y, self.plies[1]),
        };
        // A yarn is at its highest or lowest where it crosses the middle of another, and follows a cosine in between.
        let crossing = (u - 0.5).floor();
        let swing = 0.5 - 0.5 * (PI * (u - 0.5 - crossing)).cos();
        let level = |crossing: f64| if self.on_top(thread, v.floor(), crossing) { self.crimp } else { -self.crimp };
        let middle = level(crossing) * (1.0 - swing) + level(crossing + 1.0) * swing;
        let v = v - v.floor() - 0.5;
        let section = (1.0 - 4.0 * v * v).max(0.0).sqrt();
        let ridge = 0.5 * ply.depth * (TAU * (f64::from(ply.along) * u + ply.across * v)).cos();
        middle + section * (self.roundness + ridge)
    }

    /// `true` if yarn number `yarn` is above the `crossing`-th yarn of the other family.
    fn on_top(&self, thread: Thread, yarn: f64, crossing: f64) -> bool {
        // Symmetric in warp and weft, so that where one is on top the other is not.
        let warp_on_top = (yarn + crossing).rem_euclid(f64::from(self.period())) < f64::from(self.over);
        warp_on_top == (thread == Thread::Warp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn twill(over: u32, under: u32) -> Weave {
        Weave { over, under, crimp: 0.2, roundness: 0.3, plies: [Ply { along: 2, across: 3.0, depth: 0.05 }; 2] }
    }

    #[test]
    fn plain_weave_is_a_chessboard() {
        let weave = twill(1, 1);
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1), (5, 2), (7, 3)] {
            let (thread, height) = weave.top(f64::from(i) + 0.5, f64::from(j) + 0.5);
            assert_eq!(thread, if (i + j) % 2 == 0 { Thread::Warp } else { Thread::Weft });
            // Crimp, cross section and half a ridge, up or down.
            assert!((height - 0.5).abs() <= 0.025 + 1e-12, "{height}");
        }
    }

    #[test]
    fn twill_shows_the_yarn_that_floats() {
        let weave = twill(3, 1);
        let side = 80;
        let warp = (0..side * side)
            .filter(|i| weave.top(f64::from(i / side) / 20.0, f64::from(i % side) / 20.0).0 == Thread::Warp)
            .count();
        let share = warp as f64 / f64::from(side * side);
        assert!((0.65..0.85).contains(&share), "{share}");
    }

    #[test]
    fn periodic() {
        let weave = twill(2, 1);
        for (x, y) in [(0.1, 0.2), (1.5, 2.7), (2.99, 0.01)] {
            for (dx, dy) in [(3.0, 0.0), (0.0, 3.0)] {
                let (a, b) = (weave.top(x, y), weave.top(x + dx, y + dy));
                assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-12, "{a:?} and {b:?}");
            }
        }
    }
}
