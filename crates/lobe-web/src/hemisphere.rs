//! Maps of the outgoing hemisphere.

use lobe_colour::ToneMap;
use lobe_plot::{Scale, Scaling, Silent, from_disk, incident, slice, to_disk};
use serde::Serialize;

use crate::request::{Showing, word};
use crate::{Opened, Request};

/// What a map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantities {
    /// The quantity of the request, in false colours.
    Values,
    /// The colours of the material, relative to a perfect white.
    Colours,
    /// The degree of linear polarisation of scattered light if the incident light is unpolarised, in false colours.
    Polarisation,
}

impl Quantities {
    /// Parses `values`, `colours` or `dolp`; an empty text is `values`.
    ///
    /// # Errors
    /// If `text` is another word.
    pub fn parse(text: &str) -> Result<Self, String> {
        let words =
            [("values", Quantities::Values), ("colours", Quantities::Colours), ("dolp", Quantities::Polarisation)];
        Ok(word(text, &words)?.unwrap_or(Quantities::Values))
    }
}

/// A map of all outgoing directions for one incidence: a square around the disk of Lambert's equal-area projection,
/// with rows from the top and the light on the left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Map {
    /// Pixels along each side.
    pub size: usize,
    /// The value of each pixel: the quantity of the request in 1/sr (also in maps of colours), a degree of polarisation
    /// from 0 to 1, or a difference. NaN outside the disk.
    pub values: Vec<f32>,
    /// Four bytes per pixel: red, green, blue and opacity.
    pub rgba: Vec<u8>,
    /// The values at the two ends of the false colours.
    pub range: [f64; 2],
    /// 1 for each pixel that lies within the measurement, and 0 elsewhere.
    pub measured: Vec<u8>,
    /// The positions of the light and of the mirror or straight-through direction, in the square `[-1, 1]` with y up.
    pub marks: [[f64; 2]; 2],
}

/// The light and the mirror direction on the disk.
pub(crate) fn marks(Showing { view, .. }: &Showing, sigma: f64) -> [[f64; 2]; 2] {
    [view.psi, view.psi + std::f64::consts::PI].map(|psi| to_disk(view.side, view.psi, incident(view.side, sigma, psi)))
}

/// A direction in a map, and the values of the material there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Probe {
    /// Toward the light.
    pub wi: [f64; 3],
    /// Toward the viewer.
    pub wo: [f64; 3],
    /// The polar angle of the viewer, in radians.
    pub theta: f64,
    /// The azimuth of the viewer, in radians, from 0 to 2 pi.
    pub phi: f64,
    /// The quantity of the request, in 1/sr.
    pub value: f32,
    /// All channels, in 1/sr; the first 64 if there are more.
    pub channels: Vec<f32>,
    /// `true` if the direction lies within the measurement.
    pub is_measured: bool,
}

/// The largest number of channels shown next to a pointer.
const SHOWN: usize = 64;

/// The direction and the values at a point of a map, in the square `[-1, 1]` with y up; `None` outside the disk.
///
/// # Errors
/// If the request does not fit the material.
pub fn probe(opened: &Opened, request: &Request, sigma: f64, [x, y]: [f64; 2]) -> Result<Option<Probe>, String> {
    let Showing { view, scatter, .. } = request.of(opened)?;
    let Some(wo) = from_disk(view.side, scatter, view.psi, x, y) else { return Ok(None) };
    let wi = incident(view.side, sigma, view.psi);
    let mut texel = vec![0.0; opened.subject.material().channel_count()];
    opened.subject.material().eval(wi.map(|c| c as f32), wo.map(|c| c as f32), &mut texel);
    let value = view.quantity.reduce(&texel);
    texel.truncate(SHOWN);
    let (theta, phi) = (wo[2].abs().min(1.0).acos(), wo[1].atan2(wo[0]).rem_euclid(std::f64::consts::TAU));
    let is_measured = opened.subject.coverage(view.side, scatter, sigma, view.psi)(wo);
    Ok(Some(Probe { wi, wo, theta, phi, value, channels: texel, is_measured }))
}

/// How values become the colours of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shades {
    /// The exposure of colours, in stops.
    pub exposure: f32,
    /// The values at the two ends of the false colours, as in the map of another material; `None` lets the values choose.
    pub range: Option<[f64; 2]>,
}

/// The map for light at `sigma`. Pixels outside the measurement are half as opaque.
///
/// # Errors
/// If the request does not fit the material, or `what` is the polarisation and the material is not polarised.
pub fn map(
    opened: &Opened,
    request: &Request,
    sigma: f64,
    size: usize,
    what: Quantities,
    shades: Shades,
) -> Result<Map, String> {
    let showing = request.of(opened)?;
    let Showing { view, scatter, scaling } = &showing;
    let slice = slice(&opened.subject, view, sigma, *scatter, size, &Silent);
    let marks = marks(&showing, sigma);
    let mut values: Vec<f32> = slice.f.iter().map(|f| f.unwrap_or(f32::NAN)).collect();
    let measured: Vec<u8> = slice.is_measured.iter().map(|&is| u8::from(is)).collect();
    let opacity = |at: usize| if measured[at] == 1 { 255 } else { 120 };
    match what {
        Quantities::Values => {}
        Quantities::Colours => {
            let places = places(&showing, size);
            let wi = incident(view.side, sigma, view.psi).map(|c| c as f32);
            let (tone, mut rgba) = (ToneMap { exposure: shades.exposure }, vec![0; 4 * size * size]);
            each(opened, wi, &places, opened.subject.material().channel_count(), |at, texel| {
                let colour = view.colour.apply(texel).map(|f| tone.byte(std::f32::consts::PI * f));
                rgba[4 * at..][..3].copy_from_slice(&colour);
                rgba[4 * at + 3] = opacity(at);
            });
            return Ok(Map { size, values, rgba, range: [0.0, 1.0], measured, marks });
        }
        Quantities::Polarisation => {
            let material = opened.subject.material();
            if !material.is_polarised() {
                return Err(format!(
                    "{}: found no Mueller matrices; expected them for a degree of polarisation",
                    opened.subject.name()
                ));
            }
            let channels = material.channel_count();
            let names = material.channels().names();
            let channel =
                names.iter().position(|name| name.eq_ignore_ascii_case(&request.channel)).unwrap_or(channels / 2);
            let places = places(&showing, size);
            let wi = incident(view.side, sigma, view.psi).map(|c| c as f32);
            for places in places.chunks(AT_ONCE) {
                let wo: Vec<[f32; 3]> = places.iter().map(|place| place.wo).collect();
                let mut matrices = vec![0.0; wo.len() * 16 * channels];
                material.mueller_batch(&vec![wi; wo.len()], &wo, &mut matrices);
                for (place, matrices) in places.iter().zip(matrices.chunks_exact(16 * channels)) {
                    // Matrices are stored row by row. For unpolarised light: scattered S1 and S2 over scattered S0.
                    let [m00, m10, m20] = [0, 4, 8].map(|row| matrices[16 * channel + row]);
                    values[place.at] = if m00 > 0.0 { (m10.hypot(m20) / m00).min(1.0) } else { 0.0 };
                }
            }
            let rgba = false_colours(&values, &Scale { scaling: Scaling::Linear, low: 0.0, high: 1.0 }, opacity);
            return Ok(Map { size, values, rgba, range: [0.0, 1.0], measured, marks });
        }
    }
    let scale = match shades.range {
        Some([low, high]) if low < high && high.is_finite() && (low > 0.0 || *scaling == Scaling::Linear) => {
            Scale { scaling: *scaling, low, high }
        }
        _ => Scale::around(values.iter().map(|f| f64::from(*f)), *scaling),
    };
    let rgba = false_colours(&values, &scale, opacity);
    Ok(Map { size, values, rgba, range: [scale.low, scale.high], measured, marks })
}

/// A pixel of a map and its direction.
pub(crate) struct Place {
    pub at: usize,
    pub wo: [f32; 3],
}

/// The pixels inside the disk.
pub(crate) fn places(Showing { view, scatter, .. }: &Showing, size: usize) -> Vec<Place> {
    let centre = |pixel: usize| 2.0 * (pixel as f64 + 0.5) / size as f64 - 1.0;
    let place = |at: usize| {
        let wo = from_disk(view.side, *scatter, view.psi, centre(at % size), -centre(at / size))?;
        Some(Place { at, wo: wo.map(|c| c as f32) })
    };
    (0..size * size).filter_map(place).collect()
}

/// The cosine of the polar angle, 86 degrees, beyond which values do not decide what the others look like.
pub(crate) const GRAZING: f32 = 0.07;

/// The number of pairs that are evaluated at once.
const AT_ONCE: usize = 2048;

/// Calls `see` with the index and the channels of each pixel.
pub(crate) fn each(
    opened: &Opened,
    wi: [f32; 3],
    places: &[Place],
    channels: usize,
    mut see: impl FnMut(usize, &[f32]),
) {
    let mut texels = vec![0.0; AT_ONCE.min(places.len()) * channels];
    for places in places.chunks(AT_ONCE) {
        let wo: Vec<[f32; 3]> = places.iter().map(|place| place.wo).collect();
        let texels = &mut texels[..places.len() * channels];
        opened.subject.material().eval_batch(&vec![wi; wo.len()], &wo, texels);
        for (place, texel) in places.iter().zip(texels.chunks_exact(channels)) {
            see(place.at, texel);
        }
    }
}

/// The false colours of the figures of `lobe plot`; NaN is transparent.
pub(crate) fn false_colours(values: &[f32], scale: &Scale, opacity: impl Fn(usize) -> u8) -> Vec<u8> {
    let colour = |(at, value): (usize, &f32)| match value.is_nan() {
        true => [0; 4],
        false => {
            let place = scale.place(f64::from(*value)).clamp(0.0, 1.0);
            let colorous::Color { r, g, b } = colorous::VIRIDIS.eval_continuous(place);
            [r, g, b, opacity(at)]
        }
    };
    values.iter().enumerate().flat_map(colour).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Session;

    #[test]
    fn maps_and_probes_agree_and_the_light_is_on_the_left() {
        let mut session = Session::new();
        session.add("cloth.ddr", std::fs::read(lobe_testing::files::fixture("cloth-17x7x17x13.ddr")).unwrap());
        let number = session.open("cloth.ddr").unwrap();
        let opened = session.opened(number).unwrap();
        let request = Request { psi: Some(0.4), ..Request::default() };
        let (sigma, size) = (0.7, 16);
        let found = map(opened, &request, sigma, size, Quantities::Values, Shades::default()).unwrap();
        assert!(found.marks[0][0] < -0.3 && found.marks[1][0] > 0.3 && found.range[0] < found.range[1]);
        let mut inside = 0;
        for at in 0..size * size {
            let [x, y] = [at % size, at / size].map(|pixel| 2.0 * (pixel as f64 + 0.5) / size as f64 - 1.0);
            let probe = probe(opened, &request, sigma, [x, -y]).unwrap();
            assert_eq!(probe.is_none(), found.values[at].is_nan());
            if let Some(probe) = probe {
                inside += 1;
                assert_eq!(probe.value, found.values[at]);
                assert_eq!(found.measured[at] == 1, probe.is_measured);
                assert!(found.rgba[4 * at + 3] > 0);
            }
        }
        assert!(inside > 180, "{inside}");
        let [low, high] = found.range;
        let shades = Shades { range: Some([low, 10.0 * high]), ..Shades::default() };
        let paler = map(opened, &request, sigma, size, Quantities::Values, shades).unwrap();
        assert!(paler.values[8 * size + 8] == found.values[8 * size + 8] && paler.rgba != found.rgba);
        assert_eq!(paler.range, [low, 10.0 * high]);
        let colours = map(opened, &request, sigma, size, Quantities::Colours, Shades::default()).unwrap();
        assert_eq!(colours.values.len(), found.values.len());
        let error = map(opened, &request, sigma, size, Quantities::Polarisation, Shades::default()).unwrap_err();
        assert!(error.contains("Mueller"), "{error}");
        assert!(Quantities::parse("else").is_err());
    }
}
