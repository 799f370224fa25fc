//! From the scattered light of a material to the slices of its distribution.

use std::f64::consts::FRAC_PI_2;

use super::budget::{Budget, Survey};
use super::grid::{Grid, candidate_columns, candidate_rows, spread};
use super::histogram::{Bin, Histogram, Light};
use super::incident::Surface;
use super::options::DistributionError;
use super::slices::Slices;
use crate::grid::axis::Axis;
use lobe_memory::Storage;

/// At most this many cells per slice, as a power of two, so that a few slices fit into the caches near a core.
const MOST_BITS: u32 = 13;
/// At least this many.
const LEAST_BITS: u32 = 4;
/// The number of midpoints per cell along each axis, except for the coarsest grid in a hurry.
const LEAST_POINTS: usize = 2;
/// The number of slices that decide where the grid is fine.
const SURVEYED: usize = 32;
/// Psi is undefined at the normal, and there is no light at the horizon, so slices of knots there are built slightly
/// away from it.
const SIGMAS: [f64; 2] = [1e-4, FRAC_PI_2 - 1e-3];
/// No slice is darker than this share of the brightest, so that none is lost to rounding.
const DARKEST: f64 = 1e-6;
/// No cell has less than this share of its row, and no row of its slice, so that sums also ascend in `f32`.
const LEAST_SHARE: f64 = 4.0 * f32::EPSILON as f64;

/// The inputs of a builder.
pub(crate) struct Builder<'a, 'l> {
    /// Runs a kernel in strict form.
    pub(crate) run: &'a dyn Fn(Histogram<'_>) -> Vec<Bin>,
    pub(crate) light: &'a mut Light<'l>,
    pub(crate) surface: &'a Surface,
    /// Incident directions: the knots of sigma and, if it matters, of psi.
    pub(crate) sigma: &'a Axis,
    pub(crate) psi: Option<&'a Axis>,
    /// The scale at which scattered light is likely to vary: knots of theta, and a number of steps in phi.
    pub(crate) theta: &'a [f32],
    pub(crate) phis: usize,
    /// At most this much memory.
    pub(crate) bytes: usize,
    pub(crate) budget: Budget,
    pub(crate) defensive: f64,
}

/// What a builder builds.
pub(crate) struct Built {
    pub(crate) slices: Slices,
    /// The brightness that a sum of 1 represents.
    pub(crate) brightest: f64,
    /// `true` if the number of evaluations was limited, and more would have given finer slices.
    pub(crate) is_limited: bool,
}

/// The grid of all slices.
struct Layout {
    phi: Vec<f64>,
    root_v: Vec<f64>,
    grid: Grid,
    /// The number of midpoints per cell along each axis.
    points: usize,
    is_limited: bool,
}

impl Builder<'_, '_> {
    /// Builds the slices, and reports the finished number and the total to `progress`.
    pub(crate) fn build(mut self, progress: &mut dyn FnMut(usize, usize)) -> Result<Built, DistributionError> {
        let (sigma, psi) = (knots(self.sigma), self.psi.map_or(vec![0.0], knots));
        let count = sigma.len() * psi.len();
        let incident = |slice: usize| {
            let (sin_sigma, cos_sigma) = sigma[slice / psi.len()].clamp(SIGMAS[0], SIGMAS[1]).sin_cos();
            let (sin_psi, cos_psi) = psi[slice % psi.len()].sin_cos();
            [sin_sigma * cos_psi, sin_sigma * sin_psi, cos_sigma].map(|x| x as f32)
        };
        let survey = Survey {
            slices: count,
            stride: count.div_ceil(SURVEYED),
            rows: candidate_rows(self.phis),
            columns: candidate_columns(self.theta),
        };
        let Layout { phi, root_v, grid, points, is_limited } = self.lay_out(survey, &incident)?;

        let mut slices = Vec::with_capacity(count);
        for slice in 0..count {
            slices.push(Slice::new(&self.histogram(incident(slice), &phi, &root_v, points), self.defensive));
            progress(slice + 1, count);
        }
        let brightest = slices.iter().fold(0.0, |most: f64, slice| most.max(slice.brightness));
        Ok(Built { slices: self.store(grid, &slices, brightest), brightest, is_limited })
    }

    fn histogram(&mut self, incident: [f32; 3], phi: &[f64], root_v: &[f64], points: usize) -> Vec<Bin> {
        let Builder { run, light, surface, .. } = self;
        run(Histogram { light, surface, incident, phi, root_v, points })
    }

    /// The finest grid that the size of the table and the budget allow, with edges where the light of the surveyed
    /// slices varies.
    fn lay_out(
        &mut self,
        mut survey: Survey,
        incident: &impl Fn(usize) -> [f32; 3],
    ) -> Result<Layout, DistributionError> {
        let mut is_limited = survey.limit(self.budget);
        let left = self.budget.after(&survey);
        let Survey { slices, stride, rows, columns } = survey;
        let (mut by_row, mut by_column) = (vec![0.0; rows.len() - 1], vec![0.0; columns.len() - 1]);
        for slice in (0..slices).step_by(stride) {
            let bins = self.histogram(incident(slice), &rows, &columns, 1);
            let total: f64 = bins.iter().map(|bin| bin.light).sum();
            if total > 0.0 {
                for (row, bins) in bins.chunks_exact(by_column.len()).enumerate() {
                    for (column, bin) in bins.iter().enumerate() {
                        by_row[row] += bin.light / total;
                        by_column[column] += bin.light / total;
                    }
                }
            }
        }
        let axes = self.sigma.bytes() + self.psi.map_or(0, Axis::bytes);
        let mut bits = MOST_BITS;
        loop {
            let row_bits = bits / 2;
            let phi = spread(&rows, &by_row, 1 << row_bits);
            let root_v = spread(&columns, &by_column, 1 << (bits - row_bits));
            let grid = Grid::new(&phi, &root_v).map_err(|source| DistributionError::Grid { source })?;
            let blended = self.blocks().iter().product::<usize>() * self.width();
            let (rows, columns) = (blended << row_bits, blended << bits);
            let sums = Storage::<f32>::bytes_for(rows) + Storage::<f32>::bytes_for(columns);
            let fits = axes + grid.bytes() + sums <= self.bytes && i32::try_from(rows + columns).is_ok();
            let cells = slices << bits;
            let is_affordable = left.allows(cells, LEAST_POINTS);
            if bits == LEAST_BITS || fits && is_affordable {
                let wanted = if phi.len() * root_v.len() > 2048 { LEAST_POINTS } else { 4 };
                let points = left.points(cells, wanted);
                is_limited |= points < wanted;
                return Ok(Layout { phi, root_v, grid, points, is_limited });
            }
            is_limited |= fits;
            bits -= 1;
        }
    }

    /// Cells in sigma and psi, at least one.
    fn blocks(&self) -> [usize; 2] {
        [Some(self.sigma), self.psi].map(|axis| axis.map_or(1, |axis| axis.cells().len().max(1)))
    }

    /// The number of slices that a lane blends.
    fn width(&self) -> usize {
        if self.psi.is_some() { 4 } else { 2 }
    }

    /// Places blended slices next to each other.
    fn store(&self, grid: Grid, slices: &[Slice], brightest: f64) -> Slices {
        let psis = self.psi.map_or(1, |psi| knots(psi).len());
        let sums: Vec<[Vec<f32>; 2]> = slices.iter().map(|slice| slice.sums(brightest, &grid)).collect();
        let (width, blocks) = (self.width(), self.blocks());
        let source =
            |axis: Option<&Axis>, knot: usize| axis.map_or(0, |axis| axis.source()[knot.min(axis.source().len() - 1)]);
        let [rows, columns] = [0, 1].map(|which| {
            let entries = sums[0][which].len();
            let mut storage = Storage::zeros(blocks[0] * blocks[1] * entries * width);
            let mut target = storage.as_mut_slice().chunks_exact_mut(entries * width);
            for sigma in 0..blocks[0] {
                for psi in 0..blocks[1] {
                    let block = target.next().expect("a chunk per block");
                    for corner in 0..width {
                        // If psi matters, it is the faster axis.
                        let (up_sigma, up_psi) = if width == 2 { (corner, 0) } else { (corner / 2, corner % 2) };
                        let slice = source(Some(self.sigma), sigma + up_sigma) * psis + source(self.psi, psi + up_psi);
                        for (entry, sum) in sums[slice][which].iter().enumerate() {
                            block[entry * width + corner] = *sum;
                        }
                    }
                }
            }
            storage
        });
        Slices { grid, width, rows, columns }
    }
}

/// The knots of an axis, without the one that closes a circle.
fn knots(axis: &Axis) -> Vec<f64> {
    let count = axis.source().iter().max().map_or(0, |last| last + 1);
    axis.knots()[..count].iter().map(|&knot| f64::from(knot)).collect()
}

/// The distribution of one slice: shares of its cells, which add up to 1, and their total in the table.
struct Slice {
    shares: Vec<f64>,
    brightness: f64,
}

impl Slice {
    /// Mixes the light of each cell with a part `defensive` of a cosine. A slice without light is all cosine.
    fn new(bins: &[Bin], defensive: f64) -> Self {
        let brightness: f64 = bins.iter().map(|bin| bin.light).sum();
        let cosine: f64 = bins.iter().map(|bin| bin.cosine).sum();
        let defensive = if brightness > 0.0 { defensive } else { 1.0 };
        let light = if brightness > 0.0 { (1.0 - defensive) / brightness } else { 0.0 };
        let shares = bins.iter().map(|bin| light * bin.light + defensive / cosine * bin.cosine).collect();
        Slice { shares, brightness }
    }

    /// The sums over rows, and over the columns of each row. The last sum of a row equals, to the bit, what the row
    /// adds to the sums over rows.
    fn sums(&self, brightest: f64, grid: &Grid) -> [Vec<f32>; 2] {
        let (rows, columns) = (1 << grid.row_bits, 1 << grid.column_bits);
        let scale = if brightest > 0.0 { (self.brightness / brightest).max(DARKEST) } else { 1.0 };
        let row_shares: Vec<f64> = self.shares.chunks_exact(columns).map(|row| row.iter().sum::<f64>()).collect();
        let by_row = ascending(&row_shares, scale as f32, rows);
        let mut by_column = Vec::with_capacity(rows * columns);
        let mut before = 0.0;
        for (row, sum) in self.shares.chunks_exact(columns).zip(&by_row) {
            by_column.extend(ascending(row, sum - before, columns));
            before = *sum;
        }
        [by_row, by_column]
    }
}

/// The sums of shares, scaled so that the last is `total`, each share at least [`LEAST_SHARE`] of them all.
fn ascending(shares: &[f64], total: f32, count: usize) -> Vec<f32> {
    let sum: f64 = shares.iter().sum();
    let share = |x: f64| if sum > 0.0 { x / sum + LEAST_SHARE } else { 1.0 };
    let all: f64 = shares.iter().map(|&x| share(x)).sum();
    let mut below = 0.0;
    let mut sums: Vec<f32> = shares
        .iter()
        .map(|&x| {
            below += share(x);
            (f64::from(total) * below / all) as f32
        })
        .collect();
    sums[count - 1] = total;
    sums
}
