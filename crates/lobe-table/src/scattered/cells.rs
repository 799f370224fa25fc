//! Squares of the plane that lead to the region of a point in one or two steps.
//!
//! A square in which many regions meet is divided into sixteen smaller ones, so that there are enough squares where
//! points are dense, and few elsewhere.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::FRAC_PI_2;

use super::regions::Region;

/// The plane is covered up to here in `x` and in `y`, slightly more than any polar angle.
pub(super) const REACH: f64 = FRAC_PI_2 * (1.0 + 1e-6);
/// The number of squares along each axis, and the number of parts along each axis of a divided square.
pub(super) const SQUARES: usize = 16;
pub(super) const PARTS: usize = 4;
/// Entries of this value or more point to the first entry of a divided square; others are regions. They are stored as
/// the bits of floats, none of which is NaN, because a processor need not preserve the bits of a NaN.
pub(super) const DIVIDED: u32 = 0x4000_0000;
/// The largest value of an entry.
pub(super) const MOST: usize = 0x3f00_0000;

/// A square, and the range of the regions that reach into it among the [lists](Squares::lists).
#[derive(Clone, Copy)]
struct Square {
    entry: usize,
    middle: [f64; 2],
    half: f64,
    list: [usize; 2],
}

impl Square {
    fn is_divisible(&self) -> bool {
        self.list[1] - self.list[0] > 1 && self.half > 1e-5
    }

    /// The number of steps that dividing it may save: the regions in it, weighted by how often points fall there.
    fn gain(&self) -> f64 {
        self.half * self.half * (self.list[1] - self.list[0] - 1) as f64
    }

    /// The middle of a part.
    fn middle_of(&self, [column, row]: [usize; 2]) -> [f64; 2] {
        let half = self.half / PARTS as f64;
        let offset = |part: usize| half * (2 * part + 1) as f64 - self.half;
        [self.middle[0] + offset(column), self.middle[1] + offset(row)]
    }
}

/// The squares that may be divided.
struct Squares<'a> {
    regions: &'a [Region],
    /// The regions of one square after those of another.
    lists: Vec<u32>,
    divisible: Vec<Square>,
    /// Their indices, that of the largest gain on top. The bits of gains, which are above 0, are in the same order.
    pending: BinaryHeap<(u64, Reverse<usize>, usize)>,
}

impl Squares<'_> {
    /// Adds a square whose regions are in a list: those of the list that reach into it. Returns its region if it cannot be
    /// divided.
    fn add(&mut self, square: Square, list: [usize; 2]) -> Option<u32> {
        let start = self.lists.len();
        for at in list[0]..list[1] {
            let region = self.lists[at];
            if self.regions[region as usize].may_reach(square.middle, square.half) {
                self.lists.push(region);
            }
        }
        let mut square = square;
        if self.lists.len() > start {
            square.list = [start, self.lists.len()];
        }
        if square.is_divisible() {
            self.pending.push((square.gain().to_bits(), Reverse(square.entry), self.divisible.len()));
            self.divisible.push(square);
            return None;
        }
        let region = self.start(&square);
        self.lists.truncate(start);
        Some(region)
    }

    /// The region that contains the middle of a square, or nearly so.
    fn start(&self, square: &Square) -> u32 {
        let list = self.lists[square.list[0]..square.list[1]].iter();
        let depths = list.map(|&region| (self.regions[region as usize].depth(square.middle), region));
        depths.max_by(|(a, _), (b, _)| a.total_cmp(b)).map_or(0, |(_, region)| region)
    }
}

/// Appends the squares of some regions, whose numbers start at `first`, to `entries`, one row along `x` after the
/// other. Returns their start, or `None` if there are more than an entry can represent.
pub(super) fn lay_out(regions: &[Region], first: usize, entries: &mut Vec<u32>) -> Option<usize> {
    let root = entries.len();
    entries.resize(root + SQUARES * SQUARES, 0);
    let lists: Vec<u32> = (0..regions.len() as u32).collect();
    let mut squares = Squares { regions, lists, divisible: Vec::new(), pending: BinaryHeap::new() };
    let (whole, half) = ([0, regions.len()], REACH / SQUARES as f64);
    for row in 0..SQUARES {
        // Rows first, so that no square has to examine all regions.
        let y = half * (2 * row + 1) as f64 - REACH;
        let start = squares.lists.len();
        for (region, wide) in regions.iter().enumerate() {
            if wide.inside.iter().all(|[a, b, c]| b * y + c + REACH * a.abs() + half * b.abs() >= 0.0) {
                squares.lists.push(region as u32);
            }
        }
        let of_row = [start, squares.lists.len()];
        for column in 0..SQUARES {
            let middle = [half * (2 * column + 1) as f64 - REACH, y];
            let entry = root + row * SQUARES + column;
            // All regions if rounding leaves none.
            if let Some(region) = squares.add(Square { entry, middle, half, list: whole }, of_row) {
                entries[entry] = (first + region as usize) as u32;
            }
        }
    }
    // Slightly more divisions than regions: the entries take less memory than the regions.
    let mut divisions = 64 + regions.len();
    while let Some((.., index)) = squares.pending.pop() {
        let square = squares.divisible[index];
        if divisions == 0 {
            entries[square.entry] = (first + squares.start(&square) as usize) as u32;
            continue;
        }
        divisions -= 1;
        let parts = entries.len();
        if parts + PARTS * PARTS > MOST {
            return None;
        }
        entries[square.entry] = DIVIDED + parts as u32;
        entries.resize(parts + PARTS * PARTS, 0);
        for part in 0..PARTS * PARTS {
            let middle = square.middle_of([part % PARTS, part / PARTS]);
            let part = Square { entry: parts + part, middle, half: square.half / PARTS as f64, list: square.list };
            if let Some(region) = squares.add(part, square.list) {
                entries[part.entry] = (first + region as usize) as u32;
            }
        }
    }
    (first + regions.len() <= MOST).then_some(root)
}
