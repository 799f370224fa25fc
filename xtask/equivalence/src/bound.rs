//! Bounds of the difference between a fused and a strict evaluation. `docs/accuracy.md` derives the figures.

use std::f64::consts::{FRAC_PI_2, TAU};

use lobe_math::bounds;
use lobe_table::specular::coords::directions_to_angles;
use lobe_table::specular::reference::zenith;
use lobe_table::{Edge, Edges, Scatter, specular};

/// The relative error of one rounding.
const UNIT: f64 = 1.0 / (1 << 24) as f64;
/// Difference in an angle due to its last place, for angles up to 2 pi.
const LAST_PLACE: f64 = 4.0 * UNIT * TAU;
/// Roundings of the tangent of half an angle, in both forms together; its error at most doubles in the angle.
const TANGENT: f64 = 12.0 * UNIT;
/// Differences in sigma and psi: two functions of `lobe_math`, each within its bound, and their arguments.
const SIGMA: f64 = 2.0 * bounds::DOUBLE_ATAN.abs + TANGENT + LAST_PLACE;
const PSI: f64 = 2.0 * bounds::AZIMUTH.abs + TANGENT + LAST_PLACE;
/// Roundings between the sines of the angles and the vector across the zenith, both forms together.
const ACROSS: f64 = 45.0 * UNIT;
/// Roundings of weights and sums of up to 16 corners, both forms together.
pub(super) const SUM: f64 = 44.0 * UNIT;
/// How far outside an axis a query counts as inside, as in the table.
const INSIDE: f64 = 1e-6;

/// The properties of a table on which the bound depends.
pub(super) struct FusedBound<'a> {
    samples: &'a specular::Data,
    edges: &'a Edges,
    /// The largest magnitude of a value.
    largest: f64,
    /// The steepest slope along each axis, in values per radian.
    slopes: [f64; 4],
    /// The largest step from the last knot of psi and phi to the first.
    steps: [f64; 4],
    refraction_slope: f64,
}

impl<'a> FusedBound<'a> {
    pub(super) fn new(samples: &'a specular::Data, edges: &'a Edges) -> Self {
        let largest = samples.values().iter().fold(0.0, |most, value| f64::max(most, f64::from(value.abs())));
        let mut bound = FusedBound {
            samples,
            edges,
            largest,
            slopes: [0.0; 4],
            steps: [0.0; 4],
            refraction_slope: samples.refraction().map_or(0.0, |offsets| {
                let slope =
                    |k: usize| (offsets[k + 1] - offsets[k]) / (samples.knots()[0][k + 1] - samples.knots()[0][k]);
                (0..offsets.len() - 1).map(slope).fold(0.0, |most, slope| f64::max(most, slope.abs()))
            }),
        };
        for axis in 0..4 {
            let knots = &samples.knots()[axis];
            let last = knots.len() - 1;
            for k in 0..last {
                let slope = bound.largest_step(axis, k, k + 1) / (knots[k + 1] - knots[k]);
                bound.slopes[axis] = bound.slopes[axis].max(slope);
            }
            let gap = knots[0] + TAU - knots[last];
            if edges.axes[axis] == Edge::Periodic && gap > INSIDE {
                bound.slopes[axis] = bound.slopes[axis].max(bound.largest_step(axis, last, 0) / gap);
            } else if last > 0 {
                let whole_circle = gap <= INSIDE;
                bound.steps[axis] = if whole_circle { bound.largest_step(axis, last, 0) } else { 2.0 * largest };
            }
        }
        bound
    }

    /// The largest magnitude of a value of the table.
    pub(super) fn largest(&self) -> f64 {
        self.largest
    }

    /// The largest difference between the values at two knots of an axis.
    fn largest_step(&self, axis: usize, from: usize, to: usize) -> f64 {
        let sizes: [usize; 4] = std::array::from_fn(|k| self.samples.knots()[k].len());
        let stride = sizes[axis + 1..].iter().product::<usize>() * self.samples.channels().count();
        let values = self.samples.values();
        let mut largest = 0.0;
        for outer in values.chunks_exact(stride * sizes[axis]) {
            for inner in 0..stride {
                let step = f64::from(outer[from * stride + inner]) - f64::from(outer[to * stride + inner]);
                largest = f64::max(largest, step.abs());
            }
        }
        largest
    }

    /// `true` if a bound allows any value of the table, as at a step; it is then meaningless.
    pub(super) fn is_void(&self, bound: f64) -> bool {
        bound >= 2.0 * self.largest
    }

    /// The largest difference, for unit vectors or for directions whose value is 0 in both forms.
    pub(super) fn at(&self, wi: [f32; 3], wo: [f32; 3]) -> f64 {
        let fold = self.samples.scatter() == Scatter::Transmission;
        let [wi, wo] = [wi, wo].map(|w| w.map(f64::from)).map(|[x, y, z]| [x, y, if fold { z.abs() } else { z }]);
        let finite = wi.iter().chain(&wo).all(|c| c.is_finite());
        if !(finite && wi[2] > 0.0 && wo[2] > 0.0) {
            return 0.0;
        }
        // If wi is the pole, psi is 0 by definition.
        let at_pole = wi[0] * wi[0] + wi[1] * wi[1] < 1e-30;
        let wi = if at_pole { [0.0, 0.0, wi[2]] } else { wi };
        let angles = directions_to_angles(wi, wo, |sigma| zenith(self.samples, self.edges, sigma));
        let errors = self.angle_errors(angles[2]);

        let stretch: [f64; 4] = std::array::from_fn(|axis| self.stretch(axis, angles[axis], errors[axis]));
        let product: f64 = stretch.iter().product();
        let whole = 2.0 * self.largest * product;
        let mut bound = SUM * self.largest * product;
        for axis in 0..4 {
            let sloping = self.slopes[axis] * errors[axis] * product / stretch[axis];
            let stepping = if self.is_near_step(axis, angles[axis], errors[axis]) { whole } else { 0.0 };
            // Whatever the error of the angle, both values are within the stretched range of the table.
            bound += (sloping + stepping).min(whole);
        }
        bound
    }

    /// The largest differences of sigma, psi, theta and phi.
    fn angle_errors(&self, theta: f64) -> [f64; 4] {
        // The zenith is exact unless refraction moves it.
        let zenith = match self.samples.refraction() {
            None => 0.0,
            Some(_) => SIGMA * (1.0 + self.refraction_slope) + 2.0 * bounds::SIN_COS.abs + 4.0 * UNIT,
        };
        let distance = 2.0 * (theta / 2.0).sin();
        let across = ACROSS * distance + 3.0 * zenith;
        let sine = theta.sin();
        let phi = if sine > 2.0 * across { across / (sine - across) } else { TAU };
        [
            SIGMA,
            PSI,
            FRAC_PI_2 * across + 2.0 * bounds::DOUBLE_ATAN.abs + 9.0 * UNIT + TANGENT + LAST_PLACE,
            phi + 2.0 * bounds::AZIMUTH.abs + TANGENT + LAST_PLACE,
        ]
    }

    /// The largest sum of the two weights' sizes within reach: more than 1 if a straight line continues beyond the
    /// knots.
    fn stretch(&self, axis: usize, x: f64, error: f64) -> f64 {
        let knots = &self.samples.knots()[axis];
        let last = knots.len() - 1;
        if last == 0 || self.edges.axes[axis] != Edge::Extrapolate {
            return 1.0;
        }
        let (mut lowest, mut highest) = (x - error, x + error);
        // An angle that crosses the seam of a circle may reappear at its other end.
        if axis % 2 == 1 && (lowest <= 0.0 || highest >= TAU) {
            (lowest, highest) = (0.0, TAU);
        }
        let below = (knots[0] - lowest) / (knots[1] - knots[0]);
        let above = (highest - knots[last]) / (knots[last] - knots[last - 1]);
        1.0 + 2.0 * below.max(above).max(0.0)
    }

    /// `true` if the two forms may read on different sides of a step.
    fn is_near_step(&self, axis: usize, x: f64, error: f64) -> bool {
        let knots = &self.samples.knots()[axis];
        if knots.len() == 1 {
            return false;
        }
        let ends = [knots[0] - INSIDE, knots[knots.len() - 1] + INSIDE];
        let leaves = self.edges.axes[axis] == Edge::Zero && ends.iter().any(|end| (x - end).abs() <= error);
        let turns = axis % 2 == 1 && self.steps[axis] > 0.0 && (x <= error || x >= TAU - error);
        leaves || turns
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lobe_table::Channels;

    fn ramp(edges: &Edges) -> (specular::Data, Edges) {
        let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 1.0, 3.0], vec![0.0, 3.0]];
        let values = (0..12).map(|i| i as f32).collect();
        (specular::Data::new(Scatter::Reflection, knots, Channels::Mono, values).unwrap(), *edges)
    }

    #[test]
    fn slopes_are_the_steepest_of_each_axis() {
        let (samples, edges) = ramp(&Edges::default());
        let bound = FusedBound::new(&samples, &edges);
        assert_eq!(bound.largest, 11.0);
        // phi: the gap from 3 back to the full turn is wider than the cell from 0 to 3.
        assert_eq!(bound.slopes, [6.0, 0.0, 2.0, 1.0 / 3.0]);
        assert_eq!(bound.steps, [22.0, 0.0, 22.0, 0.0]);
    }

    #[test]
    fn nothing_is_allowed_below_the_horizon_and_anything_across_a_seam() {
        let (samples, edges) = ramp(&Edges::extrapolate());
        let bound = FusedBound::new(&samples, &edges);
        assert_eq!(bound.at([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), 0.0);
        assert_eq!(bound.at([f32::NAN, 0.0, 1.0], [0.0, 0.0, 1.0]), 0.0);
        let (wi, inside) = ([0.6, 0.0, 0.8], [-0.3, 0.5, 0.812_403_85]);
        assert!(bound.at(wi, inside) < 1e-3, "{}", bound.at(wi, inside));
        assert!(!bound.is_void(bound.at(wi, inside)) && bound.is_void(bound.at(wi, wi)));
        assert!(bound.at(wi, wi) > 20.0, "phi is 0, and the values at 0 and at the full turn differ");
    }
}
