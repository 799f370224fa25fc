//! Restoring symmetries that a material has but its measurement does not.

use std::f64::consts::TAU;

use lobe_table::specular::coords::directions_to_angles;
use lobe_table::specular::reference::{eval_angles, zenith};
use lobe_table::{GridError, specular};

use crate::samples::{angles, directions, nodes, signed_edges, with_values};

/// Averages a table with its mirror image across the plane of psi = 0: for an isotropic table, this is the plane of
/// incidence, whose two sides become equal.
///
/// If the image of a node is not a node, it is interpolated.
///
/// # Errors
/// Never for a table whose values are finite, which those of [`specular::Data`] are.
pub fn mirror(samples: &specular::Data) -> Result<specular::Data, GridError> {
    average(samples, |[sigma, psi, theta, phi]| {
        let across = |angle: f64| if angle == 0.0 { 0.0 } else { TAU - angle };
        Some([sigma, if samples.is_isotropic() { psi } else { across(psi) }, theta, across(phi)])
    })
}

/// Averages a table with itself with light and viewer exchanged.
///
/// Nodes at and below the horizon are unchanged, and so are those whose viewer is at a polar angle without measured
/// light: there is no measurement to average with. The exchanged value is interpolated, so the result is closer to
/// reciprocity, but not exactly reciprocal.
///
/// # Errors
/// The same as for [`mirror`].
pub fn reciprocal(samples: &specular::Data) -> Result<specular::Data, GridError> {
    let sigmas = &samples.knots()[0];
    let measured = sigmas[0] - 1e-9..=sigmas[sigmas.len() - 1] + 1e-9;
    let zenith = |sigma| zenith(samples, &signed_edges(), sigma);
    let mut nodes = nodes(samples);
    average(samples, |_| {
        let (wi, wo) = directions(samples, nodes.next()?);
        // The same light on the other side: transmission is stored mirrored about the surface.
        let exchanged = directions_to_angles(wo, wi, zenith);
        (wi[2] > 1e-9 && wo[2] > 1e-9 && measured.contains(&exchanged[0])).then_some(exchanged)
    })
}

/// Averages the value of each node with that at the angles of its partner, if it has one. `partner` is called once
/// per node, in the order of the values.
fn average(
    samples: &specular::Data,
    mut partner: impl FnMut([f64; 4]) -> Option<[f64; 4]>,
) -> Result<specular::Data, GridError> {
    let channels = samples.channels().count();
    let mut values = samples.values().to_vec();
    let mut other = vec![0.0; channels];
    for (node, texel) in nodes(samples).zip(values.chunks_exact_mut(channels)) {
        if let Some(angles) = partner(angles(samples, node)) {
            eval_angles(samples, &signed_edges(), angles, &mut other);
            texel.iter_mut().zip(&other).for_each(|(value, other)| *value = (0.5 * (f64::from(*value) + other)) as f32);
        }
    }
    with_values(samples, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Aspect;
    use crate::reciprocity::reciprocity;
    use crate::resample::measure;
    use crate::testing::{Mono, degrees};
    use lobe::{Material, Options};

    fn knots(psis: &[f64]) -> [Vec<f64>; 4] {
        let steps =
            |last: f64, count: usize| degrees(&(0..=count).map(|i| last * i as f64 / count as f64).collect::<Vec<_>>());
        [steps(80.0, 16), degrees(psis), steps(180.0, 36), steps(360.0, 24)]
    }

    /// Averaging removes the part that is odd across the plane, and keeps the even part.
    #[test]
    fn the_odd_part_vanishes() {
        let skewed = Mono(|_: [f64; 3], wo: [f64; 3]| 1.0 + 0.3 * wo[1] + 0.2 * wo[0]);
        let samples = measure(&skewed, Aspect::REFLECTION, knots(&[0.0]), |_| {}).expect("a table");
        let even = Mono(|_: [f64; 3], wo: [f64; 3]| 1.0 + 0.2 * wo[0]);
        let expected = measure(&even, Aspect::REFLECTION, knots(&[0.0]), |_| {}).expect("a table");
        let found = mirror(&samples).expect("a table");
        for (x, expected) in found.values().iter().zip(expected.values()) {
            assert!((x - expected).abs() < 1e-5, "{x} is not {expected}");
        }
    }

    /// In an anisotropic table the light is mirrored too.
    #[test]
    fn both_directions_are_mirrored() {
        let skewed = Mono(|wi: [f64; 3], wo: [f64; 3]| 2.0 + 0.3 * wo[1] + 0.7 * wi[1] + wi[1] * wo[1]);
        let psis = [0.0, 45.0, 90.0, 180.0, 270.0, 315.0, 360.0];
        let samples = measure(&skewed, Aspect::REFLECTION, knots(&psis), |_| {}).expect("a table");
        let even = Mono(|wi: [f64; 3], wo: [f64; 3]| 2.0 + wi[1] * wo[1]);
        let expected = measure(&even, Aspect::REFLECTION, knots(&psis), |_| {}).expect("a table");
        let found = mirror(&samples).expect("a table");
        for (x, expected) in found.values().iter().zip(expected.values()) {
            assert!((x - expected).abs() < 1e-5, "{x} is not {expected}");
        }
    }

    #[test]
    fn reciprocity_improves() {
        let uneven = Mono(|wi: [f64; 3], wo: [f64; 3]| 1.0 + 0.5 * wi[2] + 0.2 * wi[0] * wo[0]);
        let samples =
            measure(&uneven, Aspect::REFLECTION, knots(&[0.0, 90.0, 180.0, 270.0, 360.0]), |_| {}).expect("a table");
        let error = |samples: &specular::Data| {
            let material = Material::from_samples(samples.clone(), &Options::default()).expect("a table");
            reciprocity(&material, Aspect::REFLECTION, 1.2, 2000).relative_rms
        };
        let averaged = reciprocal(&samples).expect("a table");
        assert!(error(&samples) > 0.05, "{}", error(&samples));
        assert!(error(&averaged) < 0.1 * error(&samples), "{} after {}", error(&averaged), error(&samples));
    }
}
