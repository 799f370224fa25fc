//! The warp of the unit square that turns uniform positions into samples of a piecewise bilinear density, and back.
//!
//! The density of a query is a blend of stored slices, each normalised to integrate to one. Rows are drawn from their
//! marginal distribution and columns from the conditional one; within a cell, both are quadratic and are inverted
//! exactly.

use super::images::{Images, bilinear, lerp, place};
use crate::grid::neighbours::Neighbours;

/// The slices of a table to blend, and their weights, which add up to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    /// Slice and weight; a slice may occur twice.
    pub terms: [(usize, f64); 4],
}

impl Blend {
    /// The blend at azimuth `phi` and zenith angle `theta` in a table of `[phi_i][theta_i]` slices, linear in both and
    /// constant beyond the first and last knot.
    pub fn new(phi_i: &[f32], theta_i: &[f32], phi: f64, theta: f64) -> Self {
        let (p, t) = (Neighbours::held(phi_i, phi), Neighbours::held(theta_i, theta));
        let term = |upper: [usize; 2]| {
            let slice = p.nodes[upper[0]] * theta_i.len() + t.nodes[upper[1]];
            (slice, p.weights[upper[0]] * t.weights[upper[1]])
        };
        Blend { terms: [term([0, 0]), term([0, 1]), term([1, 0]), term([1, 1])] }
    }

    /// The first slice of a table alone.
    pub const FIRST: Blend = Blend { terms: [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)] };

    /// Blends anything that has a value per slice.
    pub(super) fn mix(&self, mut value: impl FnMut(usize) -> f64) -> f64 {
        let mut sum = 0.0;
        for (slice, weight) in self.terms {
            // Isotropic tables use two of the four.
            if weight != 0.0 {
                sum += weight * value(slice);
            }
        }
        sum
    }
}

/// Normalised slices with their cumulative distributions.
///
/// Negative texels, which noise may cause, count as zero, and a slice without density adds nothing to a blend.
#[derive(Clone, Debug)]
pub struct Warp {
    images: Images,
    /// One factor per slice, which makes the cells of the slice add up to one.
    norm: Vec<f64>,
    /// `[slice][row][column]`: integral of the row up to the column, in cells.
    conditional: Vec<f64>,
    /// `[slice][row]`: integral of the slice up to the row, in cells.
    marginal: Vec<f64>,
}

impl Warp {
    /// Normalises the slices and sums them up.
    pub fn new(images: &Images) -> Self {
        let [height, width] = images.size();
        let mut norm = Vec::with_capacity(images.slices());
        let mut conditional = Vec::with_capacity(images.texels().len());
        let mut marginal = Vec::with_capacity(images.slices() * height);
        for slice in 0..images.slices() {
            let (first_row, first) = (marginal.len(), conditional.len());
            let (mut below, mut previous) = (0.0, None);
            for row in images.slice(slice).chunks_exact(width) {
                let mut sum = 0.0;
                conditional.push(sum);
                for pair in row.windows(2) {
                    sum += 0.5 * (density(pair[0]) + density(pair[1]));
                    conditional.push(sum);
                }
                below += previous.map_or(0.0, |previous: f64| 0.5 * (previous + sum));
                previous = Some(sum);
                marginal.push(below);
            }
            let factor = if below > 0.0 { 1.0 / below } else { 0.0 };
            marginal[first_row..].iter_mut().for_each(|m| *m *= factor);
            conditional[first..].iter_mut().for_each(|c| *c *= factor);
            norm.push(factor);
        }
        Warp { images: images.clone(), norm, conditional, marginal }
    }

    /// The factor that normalises each slice: after it, the bilinear integral over the cells of a slice, with a cell of
    /// unit area, is one. The density on the unit square has the further factor `(width - 1) (height - 1)`.
    pub fn norms(&self) -> &[f64] {
        &self.norm
    }

    /// The density at `u`, over the unit square.
    pub fn density(&self, u: [f64; 2], blend: &Blend) -> f64 {
        bilinear(&self.images, u, |texel| self.texel(texel, blend)) * self.cells()
    }

    /// The uniform position that [`sample`](Self::sample) turns into `u`, and the density at `u`.
    ///
    /// If a whole row has no density, the position in it is undefined, and set to 0.
    pub fn invert(&self, u: [f64; 2], blend: &Blend) -> ([f64; 2], f64) {
        let [height, width] = self.images.size();
        let ((col, fx), (row, fy)) = (place(u[0], width), place(u[1], height));
        let (c0, c1) = self.columns(row, col, fy, blend);
        let x = self.conditional(row, col, fy, blend) + integral(c0, c1, fx);
        let (r0, r1) = self.rows(row, blend);
        let total = lerp(r0, r1, fy);
        let y = self.marginal(row, blend) + integral(r0, r1, fy);
        let s = [if total > 0.0 { x / total } else { 0.0 }, y];
        (s, lerp(c0, c1, fx) * self.cells())
    }

    /// The position with the density of the blended slices that belongs to a uniform position, and its density.
    pub fn sample(&self, uniform: [f64; 2], blend: &Blend) -> ([f64; 2], f64) {
        let [height, width] = self.images.size();
        // The open interval, in steps that `f32` also has: at 0 and 1, rows without density would be chosen.
        let edge = 2.0f64.powi(-24);
        let [ux, uy] = uniform.map(|u| u.clamp(edge, 1.0 - edge));
        let row = last_below(height, |row| self.marginal(row, blend) < uy);
        let (r0, r1) = self.rows(row, blend);
        let fy = solve(r0, r1, uy - self.marginal(row, blend));
        let ux = ux * lerp(r0, r1, fy);
        let col = last_below(width, |col| self.conditional(row, col, fy, blend) < ux);
        let (c0, c1) = self.columns(row, col, fy, blend);
        let fx = solve(c0, c1, ux - self.conditional(row, col, fy, blend));
        let u = [(col as f64 + fx) / (width - 1) as f64, (row as f64 + fy) / (height - 1) as f64];
        (u, lerp(c0, c1, fx) * self.cells())
    }

    /// Density, in cells, and conditional integral at a texel of a slice.
    pub(super) fn node(&self, slice: usize, row: usize, col: usize) -> [f64; 2] {
        let [height, width] = self.images.size();
        let at = row * width + col;
        let value = self.norm[slice] * density(self.images.slice(slice)[at]);
        [value, self.conditional[slice * height * width + at]]
    }

    /// The integral of a row of a slice, and of the slice up to that row.
    pub(super) fn row(&self, slice: usize, row: usize) -> [f64; 2] {
        let [height, width] = self.images.size();
        let row = slice * height + row;
        [self.conditional[row * width + width - 1], self.marginal[row]]
    }

    /// The number of cells of the unit square.
    pub(super) fn cells(&self) -> f64 {
        let [height, width] = self.images.size();
        ((height - 1) * (width - 1)) as f64
    }

    fn texel(&self, at: usize, blend: &Blend) -> f64 {
        blend.mix(|slice| self.norm[slice] * density(self.images.slice(slice)[at]))
    }

    fn marginal(&self, row: usize, blend: &Blend) -> f64 {
        blend.mix(|slice| self.marginal[slice * self.images.height + row])
    }

    /// The integrals of a row and the next.
    fn rows(&self, row: usize, blend: &Blend) -> (f64, f64) {
        let [height, width] = self.images.size();
        let at = |row: usize| blend.mix(|slice| self.conditional[(slice * height + row) * width + width - 1]);
        (at(row), at(row + 1))
    }

    /// The integral up to a column at the height `fy` between a row and the next.
    fn conditional(&self, row: usize, col: usize, fy: f64, blend: &Blend) -> f64 {
        let [height, width] = self.images.size();
        let at = |row: usize| blend.mix(|slice| self.conditional[(slice * height + row) * width + col]);
        lerp(at(row), at(row + 1), fy)
    }

    /// The density, in cells, at a column and the next, at the height `fy` between a row and the next.
    fn columns(&self, row: usize, col: usize, fy: f64, blend: &Blend) -> (f64, f64) {
        let width = self.images.width;
        let at =
            |col: usize| lerp(self.texel(row * width + col, blend), self.texel((row + 1) * width + col, blend), fy);
        (at(col), at(col + 1))
    }
}

/// The density that a texel represents.
fn density(texel: f32) -> f64 {
    f64::from(texel).max(0.0)
}

/// The integral from 0 to `t` of a linear function with values `a` at 0 and `b` at 1.
fn integral(a: f64, b: f64, t: f64) -> f64 {
    t * a + 0.5 * t * t * (b - a)
}

/// The `t` in `[0, 1]` at which that integral is `q`. The quadratic formula is used with the root in the denominator,
/// which is also valid for `a = b`. The argument of the root is clamped, because rounding may make it negative.
fn solve(a: f64, b: f64, q: f64) -> f64 {
    let t = 2.0 * q / (a + (a * a - 2.0 * q * (a - b)).max(0.0).sqrt());
    // 0/0 in a cell without density.
    if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 }
}

/// The last of `n` places, except the very last, at which the cumulative distribution is still below.
fn last_below(n: usize, below: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, n - 1);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if below(middle) { low = middle } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two slices of 3 x 4 texels without symmetry.
    fn images() -> Images {
        let texels = (0..24).map(|i| 0.1 + ((i * 7) % 11) as f32).collect();
        Images::new("test", [2, 3, 4], texels).expect("valid images")
    }

    const HALVES: Blend = Blend { terms: [(0, 0.25), (1, 0.75), (0, 0.0), (0, 0.0)] };

    #[test]
    fn inversion_undoes_sampling() {
        let images = images();
        let warp = Warp::new(&images);
        for i in 0..=20 {
            for j in 0..=20 {
                let uniform = [f64::from(i) / 20.0, f64::from(j) / 20.0];
                let (u, density) = warp.sample(uniform, &HALVES);
                let (back, same) = warp.invert(u, &HALVES);
                assert!((back[0] - uniform[0]).abs() < 1e-7 && (back[1] - uniform[1]).abs() < 1e-7, "{uniform:?}");
                assert!((density - same).abs() < 1e-9 && (density - warp.density(u, &HALVES)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn density_integrates_to_one() {
        let images = images();
        let warp = Warp::new(&images);
        let n = 600;
        let place = |i: u32| (f64::from(i) + 0.5) / f64::from(n);
        let sum: f64 = (0..n * n).map(|i| warp.density([place(i % n), place(i / n)], &HALVES)).sum();
        assert!((sum / f64::from(n * n) - 1.0).abs() < 1e-5, "{sum}");
    }

    #[test]
    fn slices_without_density_break_nothing() {
        let mut texels = vec![0.0; 24];
        texels[13] = -1.0;
        let images = Images::new("test", [2, 3, 4], texels).expect("valid images");
        let warp = Warp::new(&images);
        let (u, density) = warp.sample([0.3, 0.7], &HALVES);
        let (s, same) = warp.invert([0.3, 0.7], &HALVES);
        assert_eq!((density, same), (0.0, 0.0));
        assert!(u.into_iter().chain(s).all(|x| (0.0..=1.0).contains(&x)), "{u:?} {s:?}");
    }

    #[test]
    fn blends_are_constant_beyond_their_knots() {
        let (phi, theta) = ([-1.0, 0.0, 1.0], [0.0, 1.0]);
        let blend = |p, t| Blend::new(&phi, &theta, p, t);
        assert_eq!(blend(-3.0, -1.0).mix(|slice| slice as f64), 0.0);
        assert_eq!(blend(3.0, 9.0).mix(|slice| slice as f64), 5.0);
        assert_eq!(blend(0.5, 0.25).mix(|slice| slice as f64), 3.25);
        assert_eq!(Blend::new(&phi[..1], &theta, 7.0, 0.25).mix(|slice| slice as f64), 0.25);
    }
}
