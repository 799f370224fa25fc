//! The evaluation of [`Data`] one query at a time in `f64`, with the sums that define the polynomials.

use std::collections::BTreeMap;

use super::data::{Data, MAX_ORDER, Term};

impl Data {
    /// `f` in 1/sr of each channel for light from `wi` to `wo`, unit vectors that point away from the surface. Zero
    /// unless both are above it. If the expansion is negative, so is the value.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f64> {
        self.sum(wi, wo, |factor, products, cosine| factor * (products[0] + products[1]) * cosine)
    }

    /// The largest error of each channel in the lanes of a [`Table`](super::Table), which add terms in `f32` that may
    /// cancel each other.
    pub fn bound(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f64> {
        // Near the rim of the disk, the slope of polynomials is proportional to the square of their order.
        let steepness = (1 + self.order() * self.order()) as f64;
        let term = |factor: f64, products: [f64; 2], _: f64| {
            let [a, b] = products.map(f64::abs);
            factor.abs() * (3e-7 * (a + b) + 6e-8 * steepness)
        };
        self.sum(wi, wo, term)
    }

    /// The values for light at each of the polar angles, a viewer at each of them, and each azimuth between the two, in
    /// radians: `[light][viewer][azimuth][channel]`. Polar angles are below a right angle.
    ///
    /// The terms are summed once per pair of polar angles: a file of many terms is listed as quickly as it is read.
    pub(super) fn on_grid(&self, polar: &[f64], azimuths: &[f64]) -> Vec<f64> {
        let micrometres = self.micrometres();
        // Files may repeat the orders of a term; there are 240 different ones.
        let mut factors: BTreeMap<(u8, [u8; 2]), Vec<f64>> = BTreeMap::new();
        for term in self.terms() {
            let sums = factors.entry((term.azimuthal, term.radial)).or_insert_with(|| vec![0.0; micrometres.len()]);
            for (sum, micrometres) in sums.iter_mut().zip(&micrometres) {
                *sum += term.factor(*micrometres);
            }
        }
        let of_angle = |theta: &f64| polynomials(self.order(), (1.0 - theta.cos()).sqrt());
        let of_polar: Vec<Polynomials> = polar.iter().map(of_angle).collect();
        let of_azimuth = |phi: &f64| std::array::from_fn(|l| (l as f64 * phi).cos());
        let cosines: Vec<Orders> = azimuths.iter().map(of_azimuth).collect();
        let mut out = Vec::with_capacity(polar.len() * polar.len() * azimuths.len() * micrometres.len());
        let mut sums = vec![[0.0; AZIMUTHAL]; micrometres.len()];
        for of_wi in &of_polar {
            for of_wo in &of_polar {
                sums.fill([0.0; AZIMUTHAL]);
                for ((l, [n, m]), factors) in &factors {
                    let [l, n, m] = [*l, *n, *m].map(usize::from);
                    let products = of_wi[n][l] * of_wo[m][l] + of_wi[m][l] * of_wo[n][l];
                    for (sums, factor) in sums.iter_mut().zip(factors) {
                        sums[l] += factor * products;
                    }
                }
                for cosines in &cosines {
                    let at = |sums: &Orders| sums.iter().zip(cosines).map(|(sum, cosine)| sum * cosine).sum::<f64>();
                    out.extend(sums.iter().map(at));
                }
            }
        }
        out
    }

    fn sum(&self, wi: [f64; 3], wo: [f64; 3], of_term: impl Fn(f64, [f64; 2], f64) -> f64) -> Vec<f64> {
        let micrometres = self.micrometres();
        let mut out = vec![0.0; micrometres.len()];
        if !(wi[2] > 0.0 && wo[2] > 0.0) {
            return out;
        }
        let rho = |w: [f64; 3]| (1.0 - w[2].min(1.0)).sqrt();
        let phi = wo[1].atan2(wo[0]) - wi[1].atan2(wi[0]);
        let [of_wi, of_wo] = [polynomials(self.order(), rho(wi)), polynomials(self.order(), rho(wo))];
        for term in self.terms() {
            let Term { radial: [n, m], azimuthal: l, .. } = *term;
            let of = |values: &Polynomials, n: u8| values[usize::from(n)][usize::from(l)];
            let ([ni, no], [mi, mo]) = ([of(&of_wi, n), of(&of_wo, n)], [of(&of_wi, m), of(&of_wo, m)]);
            let cosine = (f64::from(l) * phi).cos();
            for (out, micrometres) in out.iter_mut().zip(&micrometres) {
                *out += of_term(term.factor(*micrometres), [ni * mo, mi * no], cosine);
            }
        }
        out
    }
}

/// The number of azimuthal orders.
const AZIMUTHAL: usize = MAX_ORDER as usize + 1;

/// A number for each azimuthal order.
type Orders = [f64; AZIMUTHAL];

/// The radial polynomials at a radius, `[n][l]`.
type Polynomials = [Orders; AZIMUTHAL];

fn polynomials(order: usize, rho: f64) -> Polynomials {
    let mut out = Polynomials::default();
    for (n, of_order) in out.iter_mut().enumerate().take(order + 1) {
        for l in (n % 2..=n).step_by(2) {
            of_order[l] = radial(n as u8, l as u8, rho);
        }
    }
    out
}

/// The radial polynomial `R_n^l`.
pub(super) fn radial(n: u8, l: u8, rho: f64) -> f64 {
    let factorial = |k: u8| (1..=k).map(f64::from).product::<f64>();
    let [half_sum, half_difference] = [(n + l) / 2, (n - l) / 2];
    let term = |s: u8| {
        let sign = if s.is_multiple_of(2) { 1.0 } else { -1.0 };
        let below = factorial(s) * factorial(half_sum - s) * factorial(half_difference - s);
        sign * factorial(n - s) / below * rho.powi((n - 2 * s).into())
    };
    (0..=half_difference).map(term).sum()
}
