//! Two materials side by side.

use std::f64::consts::PI;

use lobe_colour::{Reduction, Space, delta_e};
use lobe_ops::compare::{Difference, Visible, difference, visible};
use lobe_plot::{Scale, Scaling, incident};
use serde::Serialize;

use crate::hemisphere::{each, false_colours, marks, places};
use crate::{Map, Opened, Request};

/// The difference between two materials, as `lobe compare` reports it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// The difference between values, at pairs of directions up to 80 degrees from the normal.
    pub difference: Difference,
    /// The visible difference, between two spheres under one light.
    pub visible: Visible,
}

/// The number of pairs of directions, and of pixels along each side of the picture of a sphere.
const PAIRS: usize = 20_000;
const SPHERE: usize = 128;
/// The largest polar angle of a pair, in radians.
const LIMIT: f64 = 80.0 * PI / 180.0;

/// Compares two materials.
///
/// # Errors
/// If the request does not fit both materials, or one of them has no colour.
pub fn compare(a: &Opened, b: &Opened, request: &Request) -> Result<Compared, String> {
    let aspect = request.of(a)?.aspect();
    request.of(b)?;
    let (a, b) = (a.subject.material(), b.subject.material());
    Ok(Compared {
        difference: difference(a, b, aspect, LIMIT, PAIRS).map_err(|error| error.to_string())?,
        visible: visible(a, b, aspect, SPHERE).map_err(|error| error.to_string())?,
    })
}

/// The largest difference that false colours distinguish.
const MOST: f64 = 10.0;

/// The visible difference between two materials for light at `sigma` and every outgoing direction: CIE delta E 2000 of
/// their colours relative to a perfect white. Brighter colours are dimmed to its luminance.
///
/// # Errors
/// The same as for [`compare`].
pub fn difference_map(a: &Opened, b: &Opened, request: &Request, sigma: f64, size: usize) -> Result<Map, String> {
    let showing = request.of(a)?;
    request.of(b)?;
    let wi = incident(showing.view.side, sigma, showing.view.psi).map(|c| c as f32);
    let places = places(&showing, size);
    let colours = |opened: &Opened| {
        let channels = opened.subject.material().channels();
        let reduction = Reduction::new(channels, Space::Xyz).map_err(|error| error.to_string())?;
        let mut colours = vec![[0.0; 3]; size * size];
        each(opened, wi, &places, channels.count(), |at, texel| {
            let xyz = reduction.exact(texel).map(|c| PI * c);
            colours[at] = if xyz[1] > 1.0 { xyz.map(|c| c / xyz[1]) } else { xyz };
        });
        Ok::<_, String>(colours)
    };
    let (first, second) = (colours(a)?, colours(b)?);
    let mut values = vec![f32::NAN; size * size];
    for place in &places {
        values[place.at] = delta_e(first[place.at], second[place.at]) as f32;
    }
    let measured = |opened: &Opened| {
        let showing = request.of(opened)?;
        let is_covered = opened.subject.coverage(showing.view.side, showing.scatter, sigma, showing.view.psi);
        Ok::<_, String>(places.iter().map(|place| is_covered(place.wo.map(f64::from))).collect::<Vec<bool>>())
    };
    let (in_a, in_b) = (measured(a)?, measured(b)?);
    let mut is_measured = vec![0; size * size];
    for ((place, a), b) in places.iter().zip(in_a).zip(in_b) {
        is_measured[place.at] = u8::from(a && b);
    }
    let scale = Scale { scaling: Scaling::Linear, low: 0.0, high: MOST };
    let rgba = false_colours(&values, &scale, |at| if is_measured[at] == 1 { 255 } else { 120 });
    Ok(Map { size, values, rgba, range: [0.0, MOST], measured: is_measured, marks: marks(&showing, sigma) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Session;

    #[test]
    fn a_material_equals_itself_and_differs_from_another() {
        let mut session = Session::new();
        for name in ["paint-12x21x13.ddr", "cloth-17x7x17x13.ddr"] {
            session.add(name, std::fs::read(lobe_testing::files::fixture(name)).unwrap());
        }
        let paint = session.open("paint-12x21x13.ddr").unwrap();
        let cloth = session.open("cloth-17x7x17x13.ddr").unwrap();
        let (paint, cloth) = (session.opened(paint).unwrap(), session.opened(cloth).unwrap());
        let request = Request { psi: Some(0.3), ..Request::default() };
        let same = compare(paint, paint, &request).unwrap();
        assert_eq!((same.difference.max, same.visible.max), (0.0, 0.0));
        let map = difference_map(paint, paint, &request, 0.5, 24).unwrap();
        assert!(map.values.iter().all(|value| value.is_nan() || *value == 0.0));
        let other = compare(paint, cloth, &request).unwrap();
        assert!(other.visible.mean > 1.0, "{other:?}");
        let map = difference_map(paint, cloth, &request, 0.5, 24).unwrap();
        assert!(map.values.iter().copied().fold(0.0, f32::max) > 1.0);
    }
}
