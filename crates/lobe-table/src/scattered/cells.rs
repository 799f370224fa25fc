//! Squares of the plane that lead to the region of a point in one or two steps.
//!
//! A square in which many regions meet is divided into sixteen smaller ones, so that there are enough squares where
//! points are dense, and few elsewhere.

use std::cmp::Ordering;
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

/// A square with the regions that reach into it.
struct Square {
    entry: usize,
    middle: [f64; 2],
    half: f64,
    regions: Vec<u32>,
}

impl Square {
    /// The number of steps that dividing it may save: the regions in it, weighted by how often points fall there.
    fn gain(&self) -> f64 {
        self.half * self.half * (self.regions.len() - 1) as f64
    }

    fn part(&self, [column, row]: [usize; 2], entry: usize, regions: &[Region]) -> Square {
        let half = self.half / PARTS as f64;
        let offset = |part: usize| half * (2 * part + 1) as f64 - self.half;
        let middle = [self.middle[0] + offset(column), self.middle[1] + offset(row)];
        let mut reaching: Vec<u32> = self.regions.clone();
        reaching.retain(|&region| regions[region as usize].may_reach(middle, half));
        if reaching.is_empty() {
            reaching.clone_from(&self.regions);
        }
        Square { entry, middle, half, regions: reaching }
    }

    /// The region that contains its middle, or nearly so.
    fn start(&self, regions: &[Region]) -> u32 {
        let depth = |region: &u32| regions[*region as usize].depth(self.middle);
        self.regions.iter().copied().max_by(|a, b| depth(a).total_cmp(&depth(b))).unwrap_or(0)
    }
}

impl PartialEq for Square {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Square {}

impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Square {
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain().total_cmp(&other.gain()).then(other.entry.cmp(&self.entry))
    }
}

/// Appends the squares of some regions, whose numbers start at `first`, to `entries`, one row along `x` after the
/// other. Returns their start, or `None` if there are more than an entry can represent.
pub(super) fn lay_out(regions: &[Region], first: usize, entries: &mut Vec<u32>) -> Option<usize> {
    let root = entries.len();
    entries.resize(root + SQUARES * SQUARES, 0);
    let whole = Square { entry: 0, middle: [0.0; 2], half: REACH, regions: (0..regions.len() as u32).collect() };
    let half = REACH / SQUARES as f64;
    let mut pending = BinaryHeap::new();
    for row in 0..SQUARES {
        // Rows first, so that no square has to examine all regions.
        let middle = [0.0, half * (2 * row + 1) as f64 - REACH];
        let mut of_row = whole.regions.clone();
        of_row.retain(|&region| {
            let wide = &regions[region as usize];
            wide.inside.iter().all(|[a, b, c]| b * middle[1] + c + REACH * a.abs() + half * b.abs() >= 0.0)
        });
        for column in 0..SQUARES {
            let middle = [half * (2 * column + 1) as f64 - REACH, middle[1]];
            let mut reaching = of_row.clone();
            reaching.retain(|&region| regions[region as usize].may_reach(middle, half));
            let entry = root + row * SQUARES + column;
            let regions = if reaching.is_empty() { whole.regions.clone() } else { reaching };
            pending.push(Square { entry, middle, half, regions });
        }
    }
    // Slightly more divisions than regions: the entries take less memory than the regions.
    let mut divisions = 64 + regions.len();
    while let Some(square) = pending.pop() {
        let is_divided = divisions > 0 && square.regions.len() > 1 && square.half > 1e-5;
        if !is_divided {
            entries[square.entry] = (first + square.start(regions) as usize) as u32;
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
            pending.push(square.part([part % PARTS, part / PARTS], parts + part, regions));
        }
    }
    (first + regions.len() <= MOST).then_some(root)
}
