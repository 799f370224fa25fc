//! A map of the half and difference angles, as BRDFs are often looked at: the peak is a column on the left, grazing
//! angles are at the top.

use std::f64::consts::FRAC_PI_2;

use lobe::{Scatter, Side};
use lobe_plot::Scale;
use serde::Serialize;

use crate::hemisphere::{GRAZING, false_colours};
use crate::request::Showing;
use crate::{Map, Opened, Request};

/// Directions whose difference vector is perpendicular to the plane of the normal and the half vector, so that both are
/// above the surface at all angles. Angles are in radians; `psi` is the azimuth of the half vector.
fn pair(side: Side, theta_h: f64, theta_d: f64, psi: f64) -> [[f64; 3]; 2] {
    let up = if side == Side::Front { 1.0 } else { -1.0 };
    let along = theta_d.cos() * theta_h.sin();
    let z = up * theta_d.cos() * theta_h.cos();
    let turned = |across: f64| [along * psi.cos() - across * psi.sin(), along * psi.sin() + across * psi.cos(), z];
    [turned(theta_d.sin()), turned(-theta_d.sin())]
}

/// A point of the map, and the values of the material there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HalfProbe {
    /// The angle between the half vector and the normal, in radians.
    pub theta_h: f64,
    /// The angle between the half vector and either direction, in radians.
    pub theta_d: f64,
    /// The quantity of the request, in 1/sr.
    pub value: f32,
}

/// The material as it scatters back from the side of the light.
fn reflected(opened: &Opened, request: &Request) -> Result<Showing, String> {
    let showing = request.of(opened)?;
    match showing.scatter {
        Scatter::Reflection => Ok(showing),
        Scatter::Transmission => Err("found transmission; expected reflection for half and difference angles".into()),
    }
}

/// How far apart the pixels are that are asked whether they were measured: that takes longer than their values do.
const STEP: usize = 4;

/// The values over the half angle, which grows to the right, and the difference angle, which grows upward, both from 0
/// to 90 degrees, with rows from the top. It has no marks.
///
/// # Errors
/// If the request does not fit the material, or asks for transmission.
pub fn half_difference(opened: &Opened, request: &Request, size: usize) -> Result<Map, String> {
    let showing = reflected(opened, request)?;
    let Showing { view, scaling, .. } = &showing;
    let material = opened.subject.material();
    let angle = |pixel: usize| FRAC_PI_2 * (pixel as f64 + 0.5) / size as f64;
    let directions = |at: usize| pair(view.side, angle(at % size), angle(size - 1 - at / size), view.psi);
    let channels = material.channel_count();
    let mut values = vec![0.0; size * size];
    let mut texels = vec![0.0; size * channels];
    for (row, values) in values.chunks_exact_mut(size.max(1)).enumerate() {
        let narrow = |which: usize| {
            let of = |column: usize| directions(row * size + column)[which].map(|c| c as f32);
            (0..size).map(of).collect::<Vec<[f32; 3]>>()
        };
        material.eval_batch(&narrow(0), &narrow(1), &mut texels);
        for (value, texel) in values.iter_mut().zip(texels.chunks_exact(channels)) {
            *value = view.quantity.reduce(texel);
        }
    }
    let coarse = size.div_ceil(STEP);
    let is_measured = |at: usize| {
        let [column, row] = [at % coarse, at / coarse].map(|block| (STEP * block + STEP / 2).min(size - 1));
        let [wi, wo] = directions(row * size + column);
        let (sigma, psi) = (wi[2].abs().min(1.0).acos(), wi[1].atan2(wi[0]));
        opened.subject.coverage(view.side, Scatter::Reflection, sigma, psi)(wo)
    };
    let blocks: Vec<bool> = (0..coarse * coarse).map(is_measured).collect();
    let of_block = |at: usize| u8::from(blocks[at / size / STEP * coarse + at % size / STEP]);
    let measured: Vec<u8> = (0..size * size).map(of_block).collect();
    // Values at grazing angles, or that were not measured, may be larger than all others.
    let any = measured.contains(&1);
    let decides = |at: &usize| (measured[*at] == 1 || !any) && directions(*at)[0][2].abs() > f64::from(GRAZING);
    let scale = Scale::around((0..size * size).filter(decides).map(|at| f64::from(values[at])), *scaling);
    let rgba = false_colours(&values, &scale, |at| if measured[at] == 1 { 255 } else { 120 });
    Ok(Map { size, values, rgba, range: [scale.low, scale.high], measured, marks: [[0.0; 2]; 2] })
}

/// The angles and the value at a point of the map, in the square `[0, 1]` from the lower left; `None` outside.
///
/// # Errors
/// As for [`half_difference`].
pub fn half_probe(opened: &Opened, request: &Request, [x, y]: [f64; 2]) -> Result<Option<HalfProbe>, String> {
    let Showing { view, .. } = reflected(opened, request)?;
    if !(0.0..=1.0).contains(&x) || !(0.0..=1.0).contains(&y) {
        return Ok(None);
    }
    let [theta_h, theta_d] = [x, y].map(|share| share * FRAC_PI_2);
    let [wi, wo] = pair(view.side, theta_h, theta_d, view.psi).map(|direction| direction.map(|c| c as f32));
    let mut texel = vec![0.0; opened.subject.material().channel_count()];
    opened.subject.material().eval(wi, wo, &mut texel);
    Ok(Some(HalfProbe { theta_h, theta_d, value: view.quantity.reduce(&texel) }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Session;

    #[test]
    fn directions_have_these_half_and_difference_angles() {
        for side in [Side::Front, Side::Back] {
            for (theta_h, theta_d) in [(0.0, 0.4), (0.7, 0.0), (1.2, 0.9), (0.3, 1.5)] {
                let [wi, wo] = pair(side, theta_h, theta_d, 2.1);
                let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
                let sum = [wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]];
                let half = sum.map(|c| c / dot(sum, sum).sqrt());
                assert!((dot(wi, wi) - 1.0).abs() < 1e-12 && (dot(wo, wo) - 1.0).abs() < 1e-12);
                assert!((half[2].abs().acos() - theta_h).abs() < 1e-9, "{half:?}");
                assert!((dot(wi, half).acos() - theta_d).abs() < 1e-7);
                assert_eq!(wi[2] > 0.0, side == Side::Front);
            }
        }
    }

    #[test]
    fn the_peak_is_on_the_left_and_probes_agree_with_pixels() {
        let mut session = Session::new();
        session.add("paint.ddr", std::fs::read(lobe_testing::files::fixture("paint-12x21x13.ddr")).unwrap());
        let number = session.open("paint.ddr").unwrap();
        let opened = session.opened(number).unwrap();
        let (request, size) = (Request::default(), 18);
        let found = half_difference(opened, &request, size).unwrap();
        let at = |column: usize, row: usize| found.values[row * size + column];
        assert!(at(0, 9) > at(9, 9) && at(0, 9) > at(17, 9), "{} {}", at(0, 9), at(9, 9));
        for (column, row) in [(0, 0), (3, 11), (17, 17)] {
            let place = [(column as f64 + 0.5) / 18.0, 1.0 - (row as f64 + 0.5) / 18.0];
            let probe = half_probe(opened, &request, place).unwrap().unwrap();
            assert!((probe.value / at(column, row) - 1.0).abs() < 1e-3, "{probe:?} {}", at(column, row));
        }
        assert_eq!(half_probe(opened, &request, [1.1, 0.5]).unwrap(), None);
        assert!(found.measured.contains(&1));
    }
}
