use super::*;

#[test]
fn glass_divides_light_and_obeys_snell() {
    let glass = Delta::Glass { eta: 1.5, tint: [1.0] };
    let wo = [0.6, 0.0, 0.8];
    let DeltaSamples { reflection: mirror, transmission } = glass.samples(TransportMode::Radiance, wo);
    let through = transmission.unwrap();
    assert_eq!(mirror.wi, [-0.6, 0.0, 0.8]);
    assert!((through.wi[0] + 0.6 / 1.5).abs() < 1e-6 && through.wi[2] < 0.0);
    // Without the factor of the cones, all light that is not mirrored passes through.
    assert!((mirror.weight[0] + through.weight[0] * 1.5 * 1.5 - 1.0).abs() < 1e-6);
    // The reverse path takes the same directions.
    let back = glass.samples(TransportMode::Radiance, through.wi).transmission.unwrap().wi;
    assert!(wo.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-6), "{back:?}");
    // From inside at a grazing angle, all light is mirrored.
    assert!(glass.samples(TransportMode::Radiance, [0.9, 0.0, -0.43589]).transmission.is_none());
    // At the normal: ((n - 1) / (n + 1))^2.
    assert!((glass.samples(TransportMode::Radiance, [0.0, 0.0, 1.0]).reflection.weight[0] - 0.04).abs() < 1e-6);
}

/// Radiance along a path and importance along its reverse are scaled alike except for eta^2, which cancels when a
/// path enters a medium and leaves it again.
#[test]
fn glass_scales_radiance_but_not_importance_by_the_index() {
    let glass = Delta::Glass { eta: 1.5, tint: [1.0, 0.5] };
    for wo in [[0.6, 0.0, 0.8], [0.3, 0.2, -0.933]] {
        let of = |mode| glass.samples(mode, wo);
        let [radiance, importance] = [TransportMode::Radiance, TransportMode::Importance].map(of);
        assert_eq!(radiance.reflection, importance.reflection);
        let [radiance, importance] = [radiance, importance].map(|samples| samples.transmission.unwrap());
        assert_eq!(radiance.wi, importance.wi);
        let ratio: f32 = if wo[2] > 0.0 { 1.0 / 1.5 } else { 1.5 };
        for k in 0..2 {
            assert!((radiance.weight[k] / importance.weight[k] - ratio * ratio).abs() < 1e-6);
        }
        // Importance one way and radiance the other way are scaled alike, on both sides of the surface.
        let back = glass.samples(TransportMode::Importance, importance.wi).transmission.unwrap();
        assert!((back.weight[0] - importance.weight[0]).abs() < 1e-5);
    }
}

#[test]
fn measured_shares_are_linear_between_angles() {
    let mirror = Delta::Measured(vec![(0.0, [0.2]), (1.0, [0.6])]);
    let at = |theta: f32| mirror.samples(TransportMode::Radiance, [theta.sin(), 0.0, theta.cos()]).reflection.weight[0];
    assert!((at(0.5) - 0.4).abs() < 1e-5 && (at(1.3) - 0.6).abs() < 1e-6, "{} {}", at(0.5), at(1.3));
}

/// Without polarisation, a shorter formula gives what Fresnel's equations with phases give.
#[test]
fn metal_mirrors_the_same_share_whether_light_is_polarised_or_not() {
    let metal = Delta::Metal { eta: [0.2, 0.9, 1.5, 0.0], k: [3.9, 2.4, 0.0, 0.0] };
    for wo in [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, 0.8, -0.6], [0.999_950, 0.0, 0.01]] {
        let short = metal.samples(TransportMode::Radiance, wo).reflection;
        let choice = Choice { is_polarised: true, lone: None };
        let full = metal.samples_of(TransportMode::Radiance, wo, choice).reflection;
        assert_eq!(short.wi, full.wi);
        for (a, b) in short.weight.iter().zip(full.weight) {
            assert!((a - b).abs() <= 1e-6 * b, "{a} and {b} at {wo:?}");
        }
        assert!(short.weight[0] > 0.9 && short.weight[3] == 0.0, "{short:?}");
    }
}
