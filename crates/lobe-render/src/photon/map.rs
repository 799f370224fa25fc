//! The photon map: a hashed grid of cells.

use lobe_lane::MAX_LANES;

use crate::channels::Channels as _;
use crate::connect::{LightPart, Mis};
use crate::light::SceneBounds;
use crate::transport::Transport;
use crate::vec3::Vec3;

/// Light that has arrived at a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Photon<T: Transport> {
    /// The direction from which it came, a unit vector in the world.
    pub wi: Vec3,
    /// The normal of the triangle.
    pub normal: Vec3,
    /// Its power in W, per light path.
    pub flux: T::Spectrum,
    pub mis: Mis,
    /// Number of surfaces that its path has met, including this one.
    pub surfaces: u32,
}

/// Photons sorted by cell; the edge of a cell is at least the diameter within which photons are gathered.
#[derive(Clone, Debug)]
pub(crate) struct Photons<T: Transport> {
    grid: Grid,
    /// Where the photons of each slot of the table begin, and the end.
    starts: Vec<u32>,
    /// Longer than the number of photons, so that all lanes are inside the columns.
    position: [Vec<f32>; 3],
    row: Vec<i32>,
    photons: Vec<Photon<T>>,
}

/// The largest number of cells along each axis: a row is two of these numbers in 32 bits.
const CELLS: f32 = 32_000.0;

/// Cubic cells in space, and the slots of a table to which they are hashed.
#[derive(Clone, Copy, Debug)]
struct Grid {
    origin: Vec3,
    /// Cells per unit of length.
    scale: f32,
    /// One less than the number of slots, which is a power of two.
    mask: u32,
}

impl Grid {
    fn new(bounds: &SceneBounds, radius: f32, photons: usize) -> Self {
        let reach = bounds.radius as f32;
        let edge = (2.0 * radius).max(2.0 * reach / CELLS).max(f32::MIN_POSITIVE);
        // A little larger, to allow for rounding.
        let edge = edge * 1.0001;
        let slots = photons.next_power_of_two().clamp(64, 1 << 28) as u32;
        Grid { origin: bounds.center.map(|x| x - reach), scale: 1.0 / edge, mask: slots - 1 }
    }

    /// The index of a cell along an axis. Photons are outside the bounds only by rounding.
    fn along(&self, axis: usize, x: f32) -> i32 {
        ((x - self.origin[axis]) * self.scale).clamp(0.0, 32_767.0) as i32
    }

    fn slot(&self, x: i32, row: i32) -> u32 {
        // Neighbouring cells of a row are also neighbours in the table.
        let hash = (row as u32).wrapping_mul(0x9e37_79b9);
        ((hash ^ hash >> 15).wrapping_add(x as u32)) & self.mask
    }

    fn row(y: i32, z: i32) -> i32 {
        y << 16 | z
    }
}

/// Photons that may be near a place: those with indices between two numbers that are in a row of cells.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Candidates {
    pub begin: u32,
    pub end: u32,
    pub row: i32,
}

/// The most ranges of candidates of a place: two rows each in y and z, each in two parts if it wraps around the table.
pub(super) const PARTS: usize = 8;

impl<T: Transport> Photons<T> {
    /// A map without photons.
    pub fn none() -> Self {
        let grid = Grid { origin: [0.0; 3], scale: 1.0, mask: 63 };
        Photons { grid, starts: vec![0; 65], position: [const { Vec::new() }; 3], row: Vec::new(), photons: Vec::new() }
    }

    /// A map of the surfaces of light paths that have met at least this many, for gathering within a radius.
    pub fn new(parts: &[LightPart<T>], least: u32, bounds: &SceneBounds, radius: f32) -> Self {
        let counts = || parts.iter().flat_map(|part| &part.vertices).filter(|vertex| vertex.surfaces >= least);
        let count = counts().count();
        let grid = Grid::new(bounds, radius, count);
        let mut cells: Vec<[i32; 2]> = Vec::with_capacity(count);
        let mut starts = vec![0u32; grid.mask as usize + 2];
        for vertex in counts() {
            let [x, y, z] = [0, 1, 2].map(|axis| grid.along(axis, vertex.place.position[axis]));
            let row = Grid::row(y, z);
            let slot = grid.slot(x, row);
            cells.push([slot as i32, row]);
            starts[slot as usize + 1] += 1;
        }
        for slot in 0..=grid.mask as usize {
            starts[slot + 1] += starts[slot];
        }
        // A stable counting sort: within a slot photons stay in the order of paths and surfaces.
        let mut next = starts.clone();
        let mut order = vec![0u32; count];
        for (at, [slot, _]) in cells.iter().enumerate() {
            let next = &mut next[*slot as usize];
            order[at] = *next;
            *next += 1;
        }
        let long = count + MAX_LANES;
        let mut position = [vec![f32::NAN; long], vec![f32::NAN; long], vec![f32::NAN; long]];
        let mut rows = vec![-1; long];
        let nothing =
            Photon { wi: [0.0; 3], normal: [0.0; 3], flux: T::Spectrum::ZERO, mis: Mis::default(), surfaces: 0 };
        let mut photons = vec![nothing; count];
        for (at, vertex) in counts().enumerate() {
            let to = order[at] as usize;
            for (column, x) in position.iter_mut().zip(vertex.place.position) {
                column[to] = x;
            }
            rows[to] = cells[at][1];
            photons[to] = Photon {
                wi: vertex.place.world(vertex.wo),
                normal: vertex.place.geometric,
                flux: vertex.flux,
                mis: vertex.mis,
                surfaces: vertex.surfaces,
            };
        }
        Photons { grid, starts, position, row: rows, photons }
    }

    /// Number of photons.
    pub fn len(&self) -> usize {
        self.photons.len()
    }

    /// The photons, in the order of the map.
    pub fn photons(&self) -> &[Photon<T>] {
        &self.photons
    }

    pub(super) fn columns(&self) -> Columns<'_> {
        Columns { position: self.position.each_ref().map(Vec::as_slice), row: &self.row }
    }

    /// The photons that may be within a radius of a place.
    pub(super) fn candidates(&self, from: Vec3, radius: f32) -> [Candidates; PARTS] {
        let mut parts = [Candidates::default(); PARTS];
        let mut count = 0;
        let ends =
            |axis: usize| [self.grid.along(axis, from[axis] - radius), self.grid.along(axis, from[axis] + radius)];
        let ([x0, x1], [y0, y1], [z0, z1]) = (ends(0), ends(1), ends(2));
        // The diameter is less than an edge.
        let x1 = x1.min(x0 + 1);
        for z in z0..=z1.min(z0 + 1) {
            for y in y0..=y1.min(y0 + 1) {
                let row = Grid::row(y, z);
                let (a, b) = (self.grid.slot(x0, row), self.grid.slot(x1, row));
                let slots = if a <= b { [[a, b + 1], [0, 0]] } else { [[a, self.grid.mask + 1], [0, b + 1]] };
                for [from, until] in slots {
                    let [begin, end] = [from, until].map(|slot| self.starts[slot as usize]);
                    if begin < end {
                        parts[count] = Candidates { begin, end, row };
                        count += 1;
                    }
                }
            }
        }
        parts
    }
}

/// The columns that lanes compare.
#[derive(Clone, Copy, Debug)]
pub(super) struct Columns<'a> {
    pub position: [&'a [f32]; 3],
    pub row: &'a [i32],
}
