//! The error bound of lanes, relative to the evaluation in `f64`.

use super::Data;
use crate::passes::unit::SPHERICAL;

/// The largest error of the place of a direction in lanes, in radians.
const PLACE: f64 = 2.0 * SPHERICAL;
/// The rounding error of a sum of up to nine weighted samples, relative to the largest of them.
const SUM: f64 = 1.5e-6;

impl Data {
    /// The largest difference between a value of a `Table` and that of [`eval`](Self::eval), in 1/sr, for unit vectors,
    /// found from the effect of a small change of both directions.
    pub fn bound(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        let middle = self.eval(wi, wo);
        let apart =
            |values: Vec<f32>| values.iter().zip(&middle).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
        let mut change = 0.0;
        for axis in across(wi) {
            let found = [1.0, -1.0].map(|sign| apart(self.eval(moved(wi, axis, sign * PLACE), wo)));
            change += found[0].max(found[1]);
        }
        for axis in across(wo) {
            let found = [1.0, -1.0].map(|sign| apart(self.eval(wi, moved(wo, axis, sign * PLACE))));
            change += found[0].max(found[1]);
        }
        let largest =
            self.samples().flat_map(|(_, values)| values).fold(0.0_f64, |most, value| most.max(f64::from(value.abs())));
        2.0 * change + SUM * largest
    }
}

/// Two directions perpendicular to another one and to each other: along the meridian and along the horizon.
fn across([x, y, z]: [f64; 3]) -> [[f64; 3]; 2] {
    let flat = x.hypot(y);
    let (cos, sin) = if flat > 0.0 { (x / flat, y / flat) } else { (1.0, 0.0) };
    [[-sin, cos, 0.0], [cos * z, sin * z, -flat]]
}

fn moved(direction: [f64; 3], by: [f64; 3], angle: f64) -> [f64; 3] {
    let [x, y, z] = std::array::from_fn(|k| direction[k] + angle * by[k]);
    let length = (x * x + y * y + z * z).sqrt();
    // The side of the surface is known exactly.
    let z = if z * direction[2] > 0.0 { z } else { 1e-12_f64.copysign(direction[2]) };
    [x / length, y / length, z / length]
}
