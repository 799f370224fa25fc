//! From angles to cells: the cell of an axis that each lane is in, and the fraction into it.
//!
//! Each kind of axis has its own searcher, a [`Find`], so that the loop around it has no branch and keeps the data of
//! the search in registers. [`Axis::visit`] selects the kind once.

use std::f32::consts::TAU;

use lobe_lane::{Floats, Ints, Lanes};

use super::axis::{Axis, Registers, Search};
use super::descend::Descend;
use super::find::{Cell, Find, Visitor};

impl Axis {
    /// The cell of each lane of `x`, in radians, without the edge policy.
    ///
    /// For lanes inside a caller's own kernel; a loop over many angles should look up the searcher once.
    #[inline(always)]
    pub fn cell<L: Lanes>(&self, lanes: L, x: L::F) -> Cell<L> {
        struct One<L: Lanes>(L, L::F);
        impl<L: Lanes> Visitor<L> for One<L> {
            type Out = Cell<L>;
            #[inline(always)]
            fn visit<S: Find<L>>(self, find: S) -> Cell<L> {
                find.find(self.0, self.1)
            }
        }
        self.visit(lanes, One(lanes, x))
    }

    /// The cell of each lane of `x`, in radians, and the weights of its two knots. They add up to 1, or are both 0 if
    /// `x` is outside an axis of [`Edge::Zero`](crate::Edge::Zero).
    #[inline(always)]
    pub fn weights<L: Lanes>(&self, lanes: L, x: L::F) -> (L::I, [L::F; 2]) {
        let inside = self.contains(lanes, x);
        let Cell { index, fraction } = self.cell(lanes, self.bring_inside(lanes, x));
        (index, [(lanes.splat(1.0) - fraction).masked(inside), fraction.masked(inside)])
    }

    /// `true` in the lanes where the table has a value: everywhere except outside an axis of
    /// [`Edge::Zero`](crate::Edge::Zero).
    #[inline(always)]
    pub(crate) fn contains<L: Lanes>(&self, lanes: L, x: L::F) -> L::M {
        let [low, high] = self.bounds.inside;
        lanes.splat(low).le(x) & x.le(lanes.splat(high))
    }

    /// The angle at which to read the table, for angles in radians. Angles on a periodic axis are at most a turn below
    /// its first knot, and not above.
    #[inline(always)]
    pub(crate) fn bring_inside<L: Lanes>(&self, lanes: L, x: L::F) -> L::F {
        let [low, high] = self.bounds.clamp;
        let turned = x + lanes.splat(TAU).masked(x.lt(lanes.splat(self.bounds.turn_below)));
        turned.max(lanes.splat(low)).min(lanes.splat(high))
    }

    /// Passes the searcher of this axis to `visitor`.
    #[inline(always)]
    pub(crate) fn visit<L: Lanes, V: Visitor<L>>(&self, lanes: L, visitor: V) -> V::Out {
        match self.search() {
            Search::Constant => visitor.visit(Constant),
            Search::Uniform { cells_per_radian } => visitor.visit(Uniform::<L> {
                first: lanes.splat(self.first()),
                cells_per_radian: lanes.splat(*cells_per_radian),
                last_cell: lanes.splat((self.cells().len() - 1) as f32),
            }),
            Search::Registers(registers) if L::PERMUTES && L::LANES == 16 => match registers.wide.levels {
                3 => visitor.visit(Descend::<L, 3, 1>::new(lanes, &registers.wide)),
                4 => visitor.visit(Descend::<L, 4, 1>::new(lanes, &registers.wide)),
                _ => visitor.visit(Descend::<L, 5, 2>::new(lanes, &registers.wide)),
            },
            Search::Guide { tree: Some(tree), .. } if L::PERMUTES && L::LANES == 16 => {
                visitor.visit(Descend::<L, 6, 4>::new(lanes, tree))
            }
            Search::Registers(registers) if L::PERMUTES => match self.knots().len() {
                0..=5 => visitor.visit(Compare::<L, 3, 1>::new(lanes, registers)),
                6..=7 => visitor.visit(Compare::<L, 5, 1>::new(lanes, registers)),
                8..=9 => visitor.visit(Compare::<L, 7, 1>::new(lanes, registers)),
                10..=11 => visitor.visit(Compare::<L, 9, 2>::new(lanes, registers)),
                12..=13 => visitor.visit(Compare::<L, 11, 2>::new(lanes, registers)),
                14..=17 => visitor.visit(Permute::<L, 4, 2>::new(lanes, registers)),
                _ => visitor.visit(Permute::<L, 5, 4>::new(lanes, registers)),
            },
            Search::Registers(_) => {
                visitor.visit(Count { inner: &self.knots()[1..self.knots().len() - 1], cells: self.cells() })
            }
            Search::Guide { buckets_per_radian, buckets, steps, .. } => visitor.visit(Guide::<L> {
                first: lanes.splat(self.first()),
                buckets_per_radian: lanes.splat(*buckets_per_radian),
                last_bucket: lanes.splat((buckets.len() - 1) as f32),
                buckets,
                further: steps - 1,
                inner: &self.knots()[1..self.knots().len() - 1],
                cells: self.cells(),
            }),
        }
    }
}

/// The integer part of a position, in `[0, last]`. It is clamped first, because far outside it would not fit an
/// integer.
#[inline(always)]
fn whole_within<L: Lanes>(lanes: L, position: L::F, last: L::F) -> L::I {
    position.max(lanes.splat(0.0)).min(last).to_int()
}

/// An axis of one knot.
#[derive(Clone, Copy)]
struct Constant;

impl<L: Lanes> Find<L> for Constant {
    #[inline(always)]
    fn find(self, lanes: L, _x: L::F) -> Cell<L> {
        Cell { index: lanes.splat_int(0), fraction: lanes.splat(0.0) }
    }
}

/// An axis of equal cells.
#[derive(Clone, Copy)]
struct Uniform<L: Lanes> {
    first: L::F,
    cells_per_radian: L::F,
    last_cell: L::F,
}

impl<L: Lanes> Find<L> for Uniform<L> {
    #[inline(always)]
    fn find(self, lanes: L, x: L::F) -> Cell<L> {
        let position = (x - self.first) * self.cells_per_radian;
        let index = whole_within(lanes, position, self.last_cell);
        Cell { index, fraction: position - index.to_float() }
    }
}

/// Up to `KNOTS` inner knots, each compared with the query, and `OCTS` times eight cells, all in registers.
///
/// This takes more instructions than a tree of lookups, but none of them waits for another.
#[derive(Clone, Copy)]
struct Compare<L: Lanes, const KNOTS: usize, const OCTS: usize> {
    inner: [L::F; KNOTS],
    first: [L::Oct; OCTS],
    inverse: [L::Oct; OCTS],
}

impl<L: Lanes, const KNOTS: usize, const OCTS: usize> Compare<L, KNOTS, OCTS> {
    #[inline(always)]
    fn new(lanes: L, registers: &Registers) -> Self {
        let mut inner = [lanes.splat(registers.sorted[0]); KNOTS];
        let mut k = 0;
        while k < KNOTS {
            inner[k] = lanes.splat(registers.sorted[k]);
            k += 1;
        }
        Compare { inner, first: octs(lanes, &registers.first), inverse: octs(lanes, &registers.inverse) }
    }
}

impl<L: Lanes, const KNOTS: usize, const OCTS: usize> Find<L> for Compare<L, KNOTS, OCTS> {
    #[inline(always)]
    fn find(self, lanes: L, x: L::F) -> Cell<L> {
        let mut index = lanes.splat_int(0);
        let mut k = 0;
        while k < KNOTS {
            index = index.count(self.inner[k].le(x));
            k += 1;
        }
        let first = look_up(lanes, self.first, index);
        let inverse = look_up(lanes, self.inverse, index);
        Cell { index, fraction: (x - first) * inverse }
    }
}

/// A search tree of `LEVELS` levels, and `OCTS` times eight cells, all in registers.
#[derive(Clone, Copy)]
struct Permute<L: Lanes, const LEVELS: usize, const OCTS: usize> {
    tree: [L::Oct; OCTS],
    first: [L::Oct; OCTS],
    inverse: [L::Oct; OCTS],
}

impl<L: Lanes, const LEVELS: usize, const OCTS: usize> Permute<L, LEVELS, OCTS> {
    #[inline(always)]
    fn new(lanes: L, registers: &Registers) -> Self {
        Permute {
            tree: octs(lanes, &registers.tree),
            first: octs(lanes, &registers.first),
            inverse: octs(lanes, &registers.inverse),
        }
    }
}

#[inline(always)]
fn octs<L: Lanes, const OCTS: usize>(lanes: L, from: &[f32; 32]) -> [L::Oct; OCTS] {
    let mut octs = [lanes.oct_load(&from[..8]); OCTS];
    let mut i = 1;
    while i < OCTS {
        octs[i] = lanes.oct_load(&from[8 * i..][..8]);
        i += 1;
    }
    octs
}

/// Entry `index` of up to 32 in registers.
#[inline(always)]
fn look_up<L: Lanes, const OCTS: usize>(lanes: L, octs: [L::Oct; OCTS], index: L::I) -> L::F {
    let mut value = lanes.oct_lookup(octs[0], index);
    if OCTS >= 2 {
        let eights = index.shl::<28>();
        value = lanes.select_negative(eights, lanes.oct_lookup(octs[1], index), value);
        if OCTS == 4 {
            let upper =
                lanes.select_negative(eights, lanes.oct_lookup(octs[3], index), lanes.oct_lookup(octs[2], index));
            value = lanes.select_negative(index.shl::<27>(), upper, value);
        }
    }
    value
}

impl<L: Lanes, const LEVELS: usize, const OCTS: usize> Find<L> for Permute<L, LEVELS, OCTS> {
    #[inline(always)]
    fn find(self, lanes: L, x: L::F) -> Cell<L> {
        // From node n, the search goes to node 2 n, or to 2 n + 1 if the query is not below its knot. Levels 1 to 3 are
        // nodes 1 to 7, in the first oct; level 4 fills the second oct, and level 5 the last two: one lookup per level
        // up to the fourth.
        let mut node = lanes.splat_int(1);
        let mut level = 0;
        while level < LEVELS {
            let knot = if level < 3 {
                lanes.oct_lookup(self.tree[0], node)
            } else if level == 3 {
                lanes.oct_lookup(self.tree[1], node)
            } else {
                let eights = node.shl::<28>();
                lanes.select_negative(
                    eights,
                    lanes.oct_lookup(self.tree[3], node),
                    lanes.oct_lookup(self.tree[2], node),
                )
            };
            node = (node + node).count(knot.le(x));
            level += 1;
        }
        let index = node - lanes.splat_int(1 << LEVELS);
        let first = look_up(lanes, self.first, index);
        let inverse = look_up(lanes, self.inverse, index);
        Cell { index, fraction: (x - first) * inverse }
    }
}

/// A few knots, each compared with the query.
#[derive(Clone, Copy)]
struct Count<'a> {
    inner: &'a [f32],
    cells: &'a [[f32; 2]],
}

impl<L: Lanes> Find<L> for Count<'_> {
    #[inline(always)]
    fn find(self, lanes: L, x: L::F) -> Cell<L> {
        let mut index = lanes.splat_int(0);
        let mut k = 0;
        while k < self.inner.len() {
            index = index.count(lanes.splat(self.inner[k]).le(x));
            k += 1;
        }
        let [first, inverse] = lanes.gather_pair(self.cells, index);
        Cell { index, fraction: (x - first) * inverse }
    }
}

/// Many knots, reached through equal buckets.
#[derive(Clone, Copy)]
struct Guide<'a, L: Lanes> {
    first: L::F,
    buckets_per_radian: L::F,
    last_bucket: L::F,
    /// The cell at the start of the bucket, and the first knot inside or beyond the bucket.
    buckets: &'a [[f32; 2]],
    /// The number of knots in the fullest bucket, minus one.
    further: usize,
    inner: &'a [f32],
    cells: &'a [[f32; 2]],
}

impl<L: Lanes> Find<L> for Guide<'_, L> {
    #[inline(always)]
    fn find(self, lanes: L, x: L::F) -> Cell<L> {
        let bucket = whole_within(lanes, (x - self.first) * self.buckets_per_radian, self.last_bucket);
        let [start, knot] = lanes.gather_pair(self.buckets, bucket);
        let mut index = start.to_int().count(knot.le(x));
        let mut step = 0;
        while step < self.further {
            // Beyond the last inner knot, the gather reads that knot again; it has already been counted.
            let within = index.lt(lanes.splat_int(self.inner.len() as i32));
            index = index.count(lanes.gather(self.inner, index).le(x) & within);
            step += 1;
        }
        let [first, inverse] = lanes.gather_pair(self.cells, index);
        Cell { index, fraction: (x - first) * inverse }
    }
}
