//! Smooth reflectances with a given colour: W. Jakob and J. Hanika, "A Low-Dimensional Function Space for Efficient
//! Spectral Upsampling", Computer Graphics Forum 38(2), 2019.
//!
//! A reflectance is a sigmoid of a quadratic polynomial in the wavelength, so it is smooth and in [0, 1]. Its three
//! coefficients are found by damped Newton iterations along a path from the grey of the same brightness.

/// The reflectance at places in [-1, 1] whose colour, with the `weights` of each place, is nearest to `rgb`.
pub(crate) fn reflectance(places: &[f64], weights: &[[f64; 3]], rgb: [f64; 3]) -> Vec<f64> {
    let rgb = rgb.map(|c| c.clamp(0.0, 1.0));
    // With too few bands, white is not exactly white.
    let grey = (rgb[0] + rgb[1] + rgb[2]) / 3.0;
    if rgb == [0.0; 3] || rgb == [1.0; 3] {
        return vec![rgb[0]; places.len()];
    }
    let level = grey.clamp(1e-3, 1.0 - 1e-3);
    let mut coefficients = [0.0, 0.0, (level - 0.5) / (level * (1.0 - level)).sqrt()];
    for step in 1..=STEPS {
        let share = f64::from(step) / f64::from(STEPS);
        let target = rgb.map(|c| level + share * (c - level));
        coefficients = solve(places, weights, target, coefficients);
    }
    places.iter().map(|x| sigmoid(polynomial(coefficients, *x))).collect()
}

/// The number of steps from grey to the colour.
const STEPS: u32 = 12;
/// The number of iterations per step.
const ITERATIONS: usize = 40;
/// A limit on the slope of polynomials, for colours that cannot be reached.
const MOST: f64 = 400.0;

fn polynomial([a, b, c]: [f64; 3], x: f64) -> f64 {
    (a * x + b) * x + c
}

fn sigmoid(x: f64) -> f64 {
    0.5 + 0.5 * x / (1.0 + x * x).sqrt()
}

fn colour(places: &[f64], weights: &[[f64; 3]], coefficients: [f64; 3]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (x, weight) in places.iter().zip(weights) {
        let value = sigmoid(polynomial(coefficients, *x));
        sum.iter_mut().zip(weight).for_each(|(sum, weight)| *sum += weight * value);
    }
    sum
}

/// Levenberg's method.
fn solve(places: &[f64], weights: &[[f64; 3]], target: [f64; 3], start: [f64; 3]) -> [f64; 3] {
    let error = |c: [f64; 3]| {
        let found = colour(places, weights, c);
        [0, 1, 2].map(|k| found[k] - target[k])
    };
    let size = |e: [f64; 3]| e.iter().map(|x| x * x).sum::<f64>();
    let (mut at, mut damping) = (start, 1e-6);
    let mut residual = error(at);
    for _ in 0..ITERATIONS {
        if size(residual) < 1e-16 {
            break;
        }
        // Rows of the Jacobian: colour by coefficient.
        let mut jacobian = [[0.0; 3]; 3];
        for (x, weight) in places.iter().zip(weights) {
            let p = polynomial(at, *x);
            let slope = 0.5 / ((1.0 + p * p) * (1.0 + p * p).sqrt());
            for (row, weight) in jacobian.iter_mut().zip(weight) {
                for (entry, power) in row.iter_mut().zip([x * x, *x, 1.0]) {
                    *entry += weight * slope * power;
                }
            }
        }
        let mut matrix = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        for i in 0..3 {
            for j in 0..3 {
                matrix[i][j] = (0..3).map(|k| jacobian[k][i] * jacobian[k][j]).sum();
            }
            right[i] = -(0..3).map(|k| jacobian[k][i] * residual[k]).sum::<f64>();
            matrix[i][i] += damping * (1e-9 + matrix[i][i]);
        }
        let Some(step) = linear(matrix, right) else { break };
        let next = [0, 1, 2].map(|k| (at[k] + step[k]).clamp(-MOST, MOST));
        let found = error(next);
        if size(found) < size(residual) {
            (at, residual, damping) = (next, found, (damping * 0.1).max(1e-12));
        } else {
            damping *= 10.0;
            if damping > 1e9 {
                break;
            }
        }
    }
    at
}

/// Cramer's rule.
fn linear(m: [[f64; 3]; 3], right: [f64; 3]) -> Option<[f64; 3]> {
    let determinant = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = determinant(m);
    if whole == 0.0 || !whole.is_finite() {
        return None;
    }
    let mut found = [0.0; 3];
    for (k, found) in found.iter_mut().enumerate() {
        let mut replaced = m;
        for row in 0..3 {
            replaced[row][k] = right[row];
        }
        *found = determinant(replaced) / whole;
    }
    found.iter().all(|x| x.is_finite()).then_some(found)
}
