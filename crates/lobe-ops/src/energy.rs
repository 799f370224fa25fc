//! Restoring energy conservation.

use lobe_table::{GridError, specular};
use serde::Serialize;

use crate::albedo::{Albedo, albedo_of_samples};
use crate::hemisphere::Effort;
use crate::samples::with_values;

/// A slice of a table that reflected more light than it received.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Repair {
    /// Its albedo before the repair.
    pub albedo: Albedo,
    /// The factor by which its values were multiplied.
    pub factor: f64,
}

/// Scales every slice, a pair of sigma and psi knots, whose albedo is above 1 in any channel, so that its largest
/// channel is 1. All channels are scaled by the same factor, so that the colour does not change.
///
/// The albedo is computed with the default edge policy, including negative values, within `effort`. Between the knots
/// of sigma, it may still be above 1.
///
/// # Errors
/// Never for a table with finite values, which [`specular::Data`] guarantees.
pub fn conserve_energy(samples: &specular::Data, effort: Effort) -> Result<(specular::Data, Vec<Repair>), GridError> {
    let albedos = albedo_of_samples(samples, effort);
    let slice = samples.values().len() / albedos.len();
    let mut values = samples.values().to_vec();
    let mut repairs = Vec::new();
    for (albedo, values) in albedos.into_iter().zip(values.chunks_exact_mut(slice)) {
        let largest = albedo.largest();
        if largest > 1.0 {
            let factor = 1.0 / largest;
            values.iter_mut().for_each(|value| *value = (f64::from(*value) * factor) as f32);
            repairs.push(Repair { albedo, factor });
        }
    }
    Ok((with_values(samples, values)?, repairs))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::degrees;
    use lobe_model::{Lambert, goniometer};

    #[test]
    fn slices_above_one_are_scaled_and_no_others() {
        let knots =
            [degrees(&[0.0, 40.0, 80.0]), vec![0.0], degrees(&[0.0, 20.0, 180.0]), degrees(&[0.0, 180.0, 360.0])];
        let samples = goniometer::measure(&Lambert { albedo: [0.8, 0.4, 0.2] }, knots, || {}).expect("a table");
        let slice = samples.values().len() / 3;
        let brighter = samples.values().iter().enumerate();
        // 0.8, 1.6 and 0.4 in red.
        let values = brighter.map(|(at, value)| value * [1.0, 2.0, 0.5][at / slice]).collect();
        let samples = with_values(&samples, values).expect("a table");
        let (repaired, repairs) = conserve_energy(&samples, Effort::default()).expect("a table");
        assert_eq!(repairs.len(), 1);
        assert!(
            (repairs[0].factor - 1.0 / 1.6).abs() < 1e-4 && (repairs[0].albedo.theta - 40f64.to_radians()).abs() < 1e-9
        );
        let after = albedo_of_samples(&repaired, Effort::default());
        let expected = [[0.8, 0.4, 0.2], [1.0, 0.5, 0.25], [0.4, 0.2, 0.1]];
        for (found, expected) in after.iter().zip(expected) {
            for (x, expected) in found.values.iter().zip(expected) {
                assert!((x - expected).abs() < 2e-4, "{found:?}");
            }
        }
        assert_eq!(repaired.values()[..slice], samples.values()[..slice]);
    }
}
