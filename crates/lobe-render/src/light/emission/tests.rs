use std::f64::consts::PI as PI_64;

use lobe_lane::{Lanes, Mask};
use lobe_scalar::Scalar;

use super::*;
use crate::light::{AreaLight, Environment};
use crate::vec3;

const BOUNDS: SceneBounds = SceneBounds { center: [0.5, -1.0, 2.0], radius: 3.0 };

fn corners() -> Vec<[[f32; 3]; 3]> {
    vec![[[-1.0, 2.0, 0.0], [1.0, 2.0, 0.5], [0.0, 2.0, 1.0]], [[1.0, 2.0, 0.0], [0.0, 3.0, 0.0], [0.0; 3]]]
}

fn lights() -> Vec<(&'static str, Light)> {
    let axis = vec3::unit([0.3, -1.0, 0.2]).unwrap();
    let (position, intensity) = ([0.3, 1.5, 0.2], [1.0, 2.0, 3.0]);
    let area = |two_sided| Light::Area(AreaLight::new(corners(), [5.0, 6.0, 7.0], two_sided).unwrap());
    vec![
        ("point", Light::Point { position, intensity }),
        ("spot", Light::Spot { position, direction: axis, intensity, falloff: [0.9, 0.4] }),
        ("directional", Light::Directional { toward: axis.map(|x| -x), irradiance: [4.0, 5.0, 6.0] }),
        ("area", area(false)),
        ("two-sided area", area(true)),
        ("sky", Light::Environment(Environment::gradient([0.2, 0.3, 0.9], [0.8; 3], [0.1; 3]).unwrap())),
        ("uniform sky", Light::Environment(Environment::constant([0.5; 3]).unwrap())),
    ]
}

/// The points of a lattice in four dimensions.
fn numbers(i: usize) -> [f32; 4] {
    let x = i as f64 + 0.5;
    [0.856_674_883_854_502_9, 0.733_891_856_627_126, 0.628_706_721_008_787, 0.538_596_970_946_928]
        .map(|step| (x * step).fract() as f32)
}

const N: usize = 1 << 16;

#[test]
fn samples_over_their_densities_average_to_the_power() {
    let lanes = Scalar::<4>;
    for (name, light) in lights() {
        let mut sum = 0.0;
        for i in (0..N).step_by(4) {
            let four: [[f32; 4]; 4] = std::array::from_fn(|lane| numbers(i + lane));
            let u = std::array::from_fn(|k| lanes.load(&[0, 1, 2, 3].map(|lane| four[lane][k])));
            let sample = light.sample_le(lanes, &BOUNDS, u);
            for lane in (0..4).filter(|lane| sample.valid.bits() >> lane & 1 != 0) {
                let of = |x| f64::from(lanes.extract(x, lane));
                let emitted = sample.emitted.iter().map(|x| of(*x)).sum::<f64>() / 3.0;
                sum += emitted / (of(sample.pdf.position) * of(sample.pdf.direction));
            }
        }
        let (mean, power) = (sum / N as f64, light.power(BOUNDS.radius));
        assert!((mean / power - 1.0).abs() < 5e-3, "{name}: {mean} sampled, {power} W");
    }
}

#[test]
fn sampled_rays_have_the_densities_that_are_computed_for_them() {
    let lanes = Reference::default();
    for (name, light) in lights() {
        let mut differ = 0;
        for i in 0..4096 {
            let sample = light.sample_le(lanes, &BOUNDS, numbers(i).map(|u| lanes.splat(u)));
            if !sample.valid.any() {
                continue;
            }
            let [origin, direction] = [sample.origin, sample.direction].map(|v| lanes.extract_xyz(v, 0));
            assert!((vec3::length(direction) - 1.0).abs() < 1e-5, "{name}");
            let cos = match &light {
                Light::Area(_) => area_cosine(origin, direction),
                _ => 0.0,
            };
            let pdf = light.pdf_le(&BOUNDS, direction, cos);
            assert_eq!(pdf.position, lanes.extract(sample.pdf.position, 0), "{name}");
            let drawn = lanes.extract(sample.pdf.direction, 0);
            // Rounding moves a few directions at an edge of a texel or of a cone to the other side.
            differ += usize::from((pdf.direction - drawn).abs() > 1e-3 * drawn);
        }
        assert!(differ < 20, "{name}: {differ} densities differ");
    }
}

/// The cosine to the normal of the triangle that a point is on.
fn area_cosine(origin: Vec3, direction: Vec3) -> f32 {
    let planes = corners().into_iter().map(|[a, b, c]| {
        let normal = vec3::unit(vec3::cross(vec3::sub(b, a), vec3::sub(c, a))).unwrap();
        (vec3::dot(vec3::sub(origin, a), normal).abs(), vec3::dot(direction, normal))
    });
    planes.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap().1
}

#[test]
fn densities_of_directions_integrate_to_one() {
    let normal = vec3::unit([0.2, 0.5, -0.7]).unwrap();
    for (name, light) in lights() {
        if matches!(light, Light::Directional { .. }) {
            continue;
        }
        let (rows, columns) = (512, 1024);
        let mut sum = 0.0;
        for row in 0..rows {
            let theta = PI_64 * (row as f64 + 0.5) / f64::from(rows);
            for column in 0..columns {
                let phi = 2.0 * PI_64 * (column as f64 + 0.5) / f64::from(columns);
                let direction = [theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()].map(|x: f64| x as f32);
                let pdf = light.pdf_le(&BOUNDS, direction, vec3::dot(direction, normal));
                sum += f64::from(pdf.direction) * theta.sin();
            }
        }
        let integral = sum * 2.0 * PI_64 * PI_64 / f64::from(rows * columns);
        assert!((integral - 1.0).abs() < 2e-3, "{name}: {integral}");
    }
}

#[test]
fn positions_fill_the_triangles_and_the_disk_evenly() {
    let lanes = Reference::default();
    for (name, light) in lights() {
        let (mut center, mut inner, mut valid) = ([0.0f64; 3], 0, 0);
        for i in 0..N {
            let sample = light.sample_le(lanes, &BOUNDS, numbers(i).map(|u| lanes.splat(u)));
            let [origin, direction] = [sample.origin, sample.direction].map(|v| lanes.extract_xyz(v, 0));
            center = std::array::from_fn(|k| center[k] + f64::from(origin[k]) / N as f64);
            let out = vec3::sub(origin, BOUNDS.center);
            let across = vec3::length(vec3::cross(out, direction));
            valid += 1;
            inner += usize::from(f64::from(across) < BOUNDS.radius * std::f64::consts::FRAC_1_SQRT_2);
        }
        match light {
            Light::Directional { .. } | Light::Environment(_) => {
                assert!((inner as f64 / f64::from(valid) - 0.5).abs() < 5e-3, "{name}: {inner} of {valid}");
            }
            Light::Area(_) => {
                // The mean of the centroids, weighted with the areas.
                let areas = corners().into_iter().map(|[a, b, c]| {
                    let area = f64::from(vec3::length(vec3::cross(vec3::sub(b, a), vec3::sub(c, a)))) / 2.0;
                    (area, [0, 1, 2].map(|k| f64::from(a[k] + b[k] + c[k]) / 3.0))
                });
                let areas: Vec<(f64, [f64; 3])> = areas.collect();
                let total: f64 = areas.iter().map(|(area, _)| area).sum();
                for k in 0..3 {
                    let mean = areas.iter().map(|(area, at)| area * at[k]).sum::<f64>() / total;
                    assert!((center[k] - mean).abs() < 3e-3, "{name}: {center:?}");
                }
            }
            _ => {}
        }
    }
}
