//! Integrals over the hemisphere by adaptive Gaussian quadrature.
//!
//! The coordinates are a polar angle and an azimuth about an axis in the plane of incidence: the mirror direction,
//! where the peak is, or the normal. The horizon is a known limit of the polar angle for every azimuth, so no panel
//! contains a step; and if panels begin at the knots of a table, its interpolation is smooth within each.

use std::f64::consts::{PI, TAU};

use lobe_table::specular::coords::angles_to_directions;

/// The first subdivision of an integral: rectangles of polar angle and azimuth about an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Panels {
    /// The polar angle of the axis, on the other side of the normal from the light; 0 is the normal.
    pub zenith: f64,
    /// The azimuth of the light.
    pub psi: f64,
    /// Bounds of the polar angle about the axis, ascending from 0 to pi.
    pub thetas: Vec<f64>,
    /// Bounds of the azimuth about the axis, ascending over a full turn.
    pub phis: Vec<f64>,
}

/// An integral over the hemisphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Integral {
    /// One value per channel.
    pub values: Vec<f64>,
    /// The largest estimated error of a channel.
    pub error: f64,
    /// The number of directions at which the integrand was evaluated.
    pub evaluations: usize,
}

/// The accuracy of an integral, and its largest cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The acceptable error: absolute, but relative for integrals above 1.
    pub tolerance: f64,
    /// After this many directions, the estimate is accepted.
    pub evaluations: usize,
}

impl Default for Effort {
    /// An error of 1e-4 in an albedo, or two million directions.
    fn default() -> Self {
        Effort { tolerance: 1e-4, evaluations: 2_000_000 }
    }
}

impl Panels {
    /// Panels about an axis at polar angle `zenith` for light at azimuth `psi`, which shrink toward the axis.
    pub fn graded(zenith: f64, psi: f64) -> Self {
        let thetas = (0..=24).map(|i| PI * (f64::from(i) / 24.0).powi(3)).collect();
        let phis: Vec<f64> = (0..=24).map(|i| TAU * f64::from(i) / 24.0).collect();
        Panels { zenith, psi, thetas, phis: with_horizon(zenith, phis) }
    }

    /// Panels whose bounds are the knots of a grid of polar angles and azimuths.
    pub fn of_knots(zenith: f64, psi: f64, thetas: &[f64], phis: &[f64]) -> Self {
        let start = phis.first().copied().unwrap_or(0.0);
        // Knots this dense are left to the subdivision of panels.
        let mut sparse: Vec<f64> = Vec::new();
        for &phi in phis {
            if sparse.last().is_none_or(|last| phi - last > DENSE) {
                sparse.push(phi);
            }
        }
        let phis = bounds(&sparse, start, start + TAU);
        Panels { zenith, psi, thetas: bounds(thetas, 0.0, PI), phis: with_horizon(zenith, phis) }
    }

    /// The direction with z >= 0 at these coordinates.
    fn direction(&self, theta: f64, phi: f64) -> [f64; 3] {
        angles_to_directions([self.zenith, self.psi, theta, phi], |zenith| zenith).1
    }

    /// The polar angle at which this azimuth reaches the horizon.
    fn horizon(&self, phi: f64) -> f64 {
        let (sin, cos) = self.zenith.sin_cos();
        cos.atan2(-sin * phi.cos())
    }
}

/// The largest extent of a panel in polar angle and azimuth: 15 degrees, over which a cosine is a parabola to within
/// 1e-5.
const STEP: f64 = PI / 12.0;

/// Azimuths, with those in between at which the horizon is at a multiple of 30 degrees. For a low axis, the horizon
/// goes from nearly 0 to nearly half a turn within a few degrees of azimuth, which a rule with few points would miss.
fn with_horizon(zenith: f64, mut phis: Vec<f64>) -> Vec<f64> {
    let (start, end) = (phis[0], phis[phis.len() - 1]);
    for step in 1..6 {
        let cos = -zenith.cos() / (zenith.sin() * (f64::from(step) * PI / 6.0).tan());
        if cos.abs() < 1.0 {
            phis.extend([cos.acos(), -cos.acos()].map(|phi| start + (phi - start).rem_euclid(TAU)));
        }
    }
    phis.sort_by(f64::total_cmp);
    // The ends are unchanged.
    phis.retain(|&phi| phi == start || phi == end || (start + SAME..=end - SAME).contains(&phi));
    phis.dedup_by(|a, b| *a - *b < SAME);
    phis
}

/// Bounds closer to each other than this are merged.
const SAME: f64 = 1e-6;

/// Azimuths closer to each other than this, 4 degrees, do not each begin a panel: over this distance, a cosine is a
/// line to within 6e-4.
const DENSE: f64 = PI / 45.0;

/// The knots between two ends, with the ends, and with more in between if they are far apart.
fn bounds(knots: &[f64], first: f64, last: f64) -> Vec<f64> {
    let mut bounds = vec![first];
    let inner = knots.iter().copied().filter(|&knot| knot > first + SAME && knot < last - SAME);
    for knot in inner.chain([last]) {
        let from = bounds[bounds.len() - 1];
        let parts = ((knot - from) / STEP).ceil().max(1.0) as usize;
        bounds.extend((1..=parts).map(|part| from + (knot - from) * part as f64 / parts as f64));
    }
    bounds
}

/// A rectangle of polar angle and azimuth.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    theta: [f64; 2],
    phi: [f64; 2],
}

impl Rectangle {
    fn quarters(self) -> [Rectangle; 4] {
        let Rectangle { theta: [t0, t1], phi: [p0, p1] } = self;
        let (t, p) = (0.5 * (t0 + t1), 0.5 * (p0 + p1));
        [([t0, t], [p0, p]), ([t, t1], [p0, p]), ([t0, t], [p, p1]), ([t, t1], [p, p1])]
            .map(|(theta, phi)| Rectangle { theta, phi })
    }
}

/// A rectangle, its integral over its quarters, and the difference from its integral as a whole.
struct Leaf {
    quarters: [Rectangle; 4],
    /// `[quarter][channel]`.
    parts: Vec<f64>,
    error: f64,
}

/// Abscissae and weights of the Gauss-Legendre rule with three points on `[0, 1]`, exact for polynomials of degree 5.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// Integrates `f cos(theta_o)` over the hemisphere.
///
/// `f` gets directions with z > 0 and fills in the values, `[direction][channel]`. Rectangles whose quarters give a
/// different integral are divided, those with the largest share of the error first, until the sum of the differences is
/// below the tolerance.
pub fn integrate(
    panels: &Panels,
    channels: usize,
    effort: Effort,
    mut f: impl FnMut(&[[f64; 3]], &mut [f32]),
) -> Integral {
    let mut integrator = Rule { panels, channels, evaluations: 0, f: &mut f };
    let whole: Vec<Rectangle> = panels
        .phis
        .windows(2)
        .flat_map(|phi| {
            panels.thetas.windows(2).map(|theta| Rectangle { theta: [theta[0], theta[1]], phi: [phi[0], phi[1]] })
        })
        .collect();
    let coarse = integrator.integrals(&whole);
    let mut leaves = integrator.leaves(&whole, &coarse);
    loop {
        let error: f64 = leaves.iter().map(|leaf| leaf.error).sum();
        let mut values = vec![0.0; channels];
        for leaf in &leaves {
            leaf.parts.iter().enumerate().for_each(|(at, part)| values[at % channels] += part);
        }
        let tolerance = effort.tolerance * values.iter().fold(1.0, |largest: f64, value| largest.max(value.abs()));
        if error <= tolerance || integrator.evaluations >= effort.evaluations {
            return Integral { values, error, evaluations: integrator.evaluations };
        }
        let share = tolerance / leaves.len() as f64;
        let (rough, mut fine): (Vec<Leaf>, Vec<Leaf>) = leaves.into_iter().partition(|leaf| leaf.error > share);
        let quarters: Vec<Rectangle> = rough.iter().flat_map(|leaf| leaf.quarters).collect();
        let parts: Vec<f64> = rough.into_iter().flat_map(|leaf| leaf.parts).collect();
        fine.extend(integrator.leaves(&quarters, &parts));
        leaves = fine;
    }
}

struct Rule<'a, F> {
    panels: &'a Panels,
    channels: usize,
    evaluations: usize,
    f: &'a mut F,
}

impl<F: FnMut(&[[f64; 3]], &mut [f32])> Rule<'_, F> {
    /// The integrals over rectangles, `[rectangle][channel]`, with nine points each.
    fn integrals(&mut self, rectangles: &[Rectangle]) -> Vec<f64> {
        // In batches, because values of many channels take memory.
        rectangles.chunks(2048).flat_map(|batch| self.batch(batch)).collect()
    }

    fn batch(&mut self, rectangles: &[Rectangle]) -> Vec<f64> {
        let (mut directions, mut weights) = (Vec::new(), Vec::new());
        for (index, Rectangle { theta, phi }) in rectangles.iter().enumerate() {
            for (x, weight_phi) in GAUSS {
                let (width, phi) = (phi[1] - phi[0], phi[0] + x * (phi[1] - phi[0]));
                let end = theta[1].min(self.panels.horizon(phi));
                for (y, weight_theta) in GAUSS.into_iter().filter(|_| end > theta[0]) {
                    let at = theta[0] + y * (end - theta[0]);
                    let direction = self.panels.direction(at, phi);
                    // Rounding may put the last point of a sliver on the horizon.
                    if direction[2] > 0.0 {
                        let area = width * (end - theta[0]) * at.sin();
                        weights.push((index, weight_phi * weight_theta * area * direction[2]));
                        directions.push(direction);
                    }
                }
            }
        }
        self.evaluations += directions.len();
        let mut values = vec![0.0; directions.len() * self.channels];
        (self.f)(&directions, &mut values);
        let mut integrals = vec![0.0; rectangles.len() * self.channels];
        for ((index, weight), texel) in weights.into_iter().zip(values.chunks_exact(self.channels)) {
            let sums = &mut integrals[index * self.channels..][..self.channels];
            sums.iter_mut().zip(texel).for_each(|(sum, &value)| *sum += weight * f64::from(value));
        }
        integrals
    }

    /// The rectangles whose integrals are known.
    fn leaves(&mut self, rectangles: &[Rectangle], known: &[f64]) -> Vec<Leaf> {
        let channels = self.channels;
        let quarters: Vec<[Rectangle; 4]> = rectangles.iter().map(|rectangle| rectangle.quarters()).collect();
        let parts = self.integrals(quarters.as_flattened());
        let leaf = |((quarters, parts), whole): (([Rectangle; 4], &[f64]), &[f64])| {
            let sum = |channel: usize| -> f64 { parts.iter().skip(channel).step_by(channels).sum() };
            let error = (0..channels).map(|channel| (sum(channel) - whole[channel]).abs()).fold(0.0, f64::max);
            Leaf { quarters, parts: parts.to_vec(), error }
        };
        let each = quarters.into_iter().zip(parts.chunks_exact(4 * channels)).zip(known.chunks_exact(channels));
        each.map(leaf).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(panels: &Panels, f: impl Fn([f64; 3]) -> f64) -> Integral {
        integrate(panels, 1, Effort { tolerance: 1e-6, evaluations: 10_000_000 }, |directions, out| {
            out.iter_mut().zip(directions).for_each(|(out, &direction)| *out = f(direction) as f32);
        })
    }

    #[test]
    fn a_constant_gives_pi_about_every_axis() {
        for zenith in [0.0, 0.4, 1.0, 1.5, 1.57] {
            for panels in [Panels::graded(zenith, 0.3), Panels::of_knots(zenith, 2.0, &[0.0, 0.2, 1.0], &[0.0, 1.0])] {
                let found = integral(&panels, |_| 1.0);
                assert!((found.values[0] - PI).abs() < 1e-5, "{found:?} at {zenith}");
            }
        }
    }

    /// The integral of `z^n` times the cosine is `2 pi / (n + 2)`, for any axis.
    #[test]
    fn powers_of_the_cosine_are_found() {
        for n in [1, 5, 40] {
            let found = integral(&Panels::graded(0.7, 0.0), |d| d[2].powi(n));
            assert!((found.values[0] - TAU / f64::from(n + 2)).abs() < 1e-5, "{found:?} for {n}");
        }
    }

    /// Half of the projected hemisphere is at polar angles below 45 degrees: a step that no rule with fixed points
    /// finds.
    #[test]
    fn a_step_is_found_by_subdivision() {
        let found = integral(&Panels::graded(0.9, 1.0), |d| if d[2] > 0.5_f64.sqrt() { 1.0 } else { 0.0 });
        assert!((found.values[0] - PI / 2.0).abs() < 1e-3, "{found:?}");
        assert!(found.evaluations > 10_000);
    }
}
