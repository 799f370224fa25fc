//! Spheres under lights.

use std::f64::consts::PI;

use lobe::Scatter;
use lobe::Side;
use lobe_colour::{LUMINANCE, ToneMap};

use crate::evaluate::{Progress, evaluate};
use crate::geometry::{cross, dot, normalise, sign};
use crate::image::Image;
use crate::subject::Subject;
use crate::view::View;

/// A light far away.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Light {
    /// The direction to its middle; the viewer is at +z, up is +y.
    toward: [f64; 3],
    /// The angle from its middle to its rim, in radians.
    radius: f64,
    /// Its power relative to a standard light, whose irradiance on a surface that faces it is pi.
    power: f64,
}

/// The lighting of a sphere. The viewer is far away, so all sight lines are parallel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Studio {
    /// A round light of 12 degrees from the upper left, and one of an eighth of its power from the right, which show
    /// most of a material.
    Key,
    /// A light of 2 degrees, 3 degrees away from the viewer, like the view of a driver.
    Viewer,
    /// A light 75 degrees to the side, beyond the left rim, which shows grazing angles.
    Rim,
    /// The key light with the sample on the sphere turned by a quarter turn.
    Turned,
    /// A light behind the sphere, which is a thin shell, to show transmission.
    Behind,
}

impl Studio {
    fn lights(self) -> Vec<Light> {
        let light =
            |toward, degrees: f64, power| Light { toward: normalise(toward), radius: degrees.to_radians(), power };
        match self {
            Studio::Key | Studio::Turned => {
                vec![light([-0.55, 0.6, 0.75], 6.0, 1.0), light([0.85, 0.1, 0.5], 6.0, 0.125)]
            }
            Studio::Viewer => vec![light([-0.04, 0.034, 1.0], 1.0, 1.0)],
            Studio::Rim => vec![light([-0.9, 0.35, 0.26], 6.0, 1.0)],
            Studio::Behind => vec![light([-0.35, 0.4, -0.85], 6.0, 1.0)],
        }
    }

    fn scatter(self) -> Scatter {
        match self {
            Studio::Behind => Scatter::Transmission,
            _ => Scatter::Reflection,
        }
    }
}

/// A sphere of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    /// Pixels along each side of the picture, which the sphere just fills.
    pub size: usize,
    /// The radiance of each pixel, linear sRGB: a white Lambertian surface that faces a standard light has 1.
    pub linear: Vec<[f32; 3]>,
    /// The share of each pixel that the sphere covers.
    pub cover: Vec<f32>,
}

/// The number of pairs of directions per pixel and light, normally and if evaluation is slow.
const SAMPLES: usize = 8;
const FEW_SAMPLES: usize = 4;

/// A sphere of the material of a view. The sample lies on it with its x axis along the circles of latitude.
///
/// Every pixel is the mean of eight points in it, each lit by a different point of the light; of four, if the material
/// has no grid and is evaluated pair by pair.
pub fn shade(subject: &Subject, view: &View, studio: Studio, size: usize, progress: &dyn Progress) -> Sphere {
    let lights = studio.lights();
    let samples = if subject.is_slow() { FEW_SAMPLES } else { SAMPLES };
    let places = places(size, samples);
    progress.begin("sphere", (places.len() * lights.len()) as u64);
    let flip = sign(view.side);
    let turn = if studio == Studio::Turned { 0.5 * PI } else { 0.0 } + view.psi;
    let pair = |at: usize| {
        let (place, light) = (&places[at / lights.len()], &lights[at % lights.len()]);
        let frame = Frame::on_sphere(place.normal, turn);
        // The lit side of the sample faces outward.
        let local = |w: [f64; 3]| {
            let [x, y, z] = frame.local(w);
            [x, flip * y, flip * z]
        };
        (local(light.point(place.uniform)), local([0.0, 0.0, 1.0]))
    };
    let colour = &view.colour;
    let values = evaluate(subject.material(), places.len() * lights.len(), pair, |texel| colour.apply(texel), progress);

    let mut sphere = Sphere { size, linear: vec![[0.0; 3]; size * size], cover: vec![0.0; size * size] };
    for (place, values) in places.iter().zip(values.chunks_exact(lights.len())) {
        sphere.cover[place.pixel] += 1.0 / samples as f32;
        for (light, rgb) in lights.iter().zip(values) {
            let cos = dot(place.normal, light.point(place.uniform));
            let is_lit = match studio.scatter() {
                Scatter::Reflection => cos > 0.0,
                Scatter::Transmission => cos < 0.0,
            };
            if is_lit {
                let irradiance = (PI * light.power * cos.abs()) as f32;
                for (sum, f) in sphere.linear[place.pixel].iter_mut().zip(rgb) {
                    *sum += irradiance * f;
                }
            }
        }
    }
    for (linear, cover) in sphere.linear.iter_mut().zip(&sphere.cover) {
        let count = cover * samples as f32;
        linear.iter_mut().for_each(|c| *c /= count.max(1.0));
    }
    sphere
}

impl Sphere {
    /// The exposure in stops at which nine tenths of the sphere are darker than six tenths of white, which leaves room
    /// for a peak; a whole number of halves.
    pub fn exposure(&self) -> f64 {
        let covered = self.linear.iter().zip(&self.cover).filter(|(_, cover)| **cover > 0.5);
        let mut bright: Vec<f32> =
            covered.map(|(rgb, _)| LUMINANCE.iter().zip(rgb).map(|(weight, c)| weight * c).sum()).collect();
        bright.sort_by(f32::total_cmp);
        let at = bright.len() * 9 / 10;
        match bright.get(at) {
            Some(&value) if value > 1e-7 && value.is_finite() => (2.0 * (0.6 / f64::from(value)).log2()).floor() / 2.0,
            _ => 0.0,
        }
    }

    /// The picture at an exposure in stops; transparent around the sphere.
    pub fn picture(&self, exposure: f64) -> Image {
        let tone = ToneMap { exposure: exposure as f32 };
        let pixel = |(linear, cover): (&[f32; 3], &f32)| {
            let [r, g, b] = linear.map(|c| tone.byte(c));
            [r, g, b, (255.0 * cover).round() as u8]
        };
        let rgba = self.linear.iter().zip(&self.cover).flat_map(pixel).collect();
        Image { width: self.size as u32, height: self.size as u32, rgba }
    }
}

/// A visible point on the sphere.
struct Place {
    pixel: usize,
    normal: [f64; 3],
    /// The point of the light that shines on it.
    uniform: [f64; 2],
}

/// The points of all pixels, without those off the sphere. The points in each pixel are those of the R2 sequence (M.
/// Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018); for the light, the sequence continues
/// from pixel to pixel, so that neighbours differ and no pattern is visible.
fn places(size: usize, samples: usize) -> Vec<Place> {
    // The plastic number, the root of x^3 = x + 1.
    const PLASTIC: f64 = 1.324_717_957_244_746;
    let (a, b) = (1.0 / PLASTIC, 1.0 / (PLASTIC * PLASTIC));
    let mut places = Vec::new();
    for pixel in 0..size * size {
        for sample in 0..samples {
            let within = [a, b].map(|step| (0.5 + step * sample as f64).fract());
            let ndc = |pixel: usize, within: f64| 2.0 * (pixel as f64 + within) / size as f64 - 1.0;
            let (x, y) = (ndc(pixel % size, within[0]), -ndc(pixel / size, within[1]));
            let square = x * x + y * y;
            if square < 1.0 {
                let index = (places.len() % (1 << 20)) as f64;
                let uniform = [a, b].map(|step| (0.5 + step * index).fract());
                places.push(Place { pixel, normal: [x, y, (1.0 - square).sqrt()], uniform });
            }
        }
    }
    places
}

impl Light {
    /// The direction to a point of the light, chosen by two numbers in `[0, 1)`.
    fn point(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        let helper = if self.toward[1].abs() < 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
        let x = normalise(cross(helper, self.toward));
        let y = cross(self.toward, x);
        let (radius, (sin, cos)) = (self.radius.tan() * u.sqrt(), (2.0 * PI * v).sin_cos());
        normalise(std::array::from_fn(|k| self.toward[k] + radius * (cos * x[k] + sin * y[k])))
    }
}

/// The axes of the sample at a point on the sphere.
struct Frame {
    x: [f64; 3],
    y: [f64; 3],
    z: [f64; 3],
}

impl Frame {
    /// x along the circle of latitude, to the viewer's right, then rotated by `turn` about the normal.
    fn on_sphere(normal: [f64; 3], turn: f64) -> Self {
        let across = [normal[2], 0.0, -normal[0]];
        let along = if across[0].hypot(across[2]) > 1e-9 { normalise(across) } else { [1.0, 0.0, 0.0] };
        let up = cross(normal, along);
        let (sin, cos) = turn.sin_cos();
        let x: [f64; 3] = std::array::from_fn(|k| cos * along[k] + sin * up[k]);
        Frame { x, y: cross(normal, x), z: normal }
    }

    fn local(&self, w: [f64; 3]) -> [f64; 3] {
        [dot(w, self.x), dot(w, self.y), dot(w, self.z)]
    }
}

/// The useful spheres of a material: those that show something that the others do not.
pub(crate) fn studios(subject: &Subject, side: Side) -> Vec<Studio> {
    let scatters = subject.scatters(side);
    let mut studios = Vec::new();
    if scatters.contains(&Scatter::Reflection) {
        studios.extend([Studio::Key, Studio::Viewer, Studio::Rim]);
        if subject.is_anisotropic(side) {
            studios.push(Studio::Turned);
        }
    }
    if scatters.contains(&Scatter::Transmission) {
        studios.push(Studio::Behind);
    }
    studios
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_right_handed_everywhere() {
        for normal in [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.6, -0.64, 0.48]] {
            let frame = Frame::on_sphere(normal, 0.7);
            let z = cross(frame.x, frame.y);
            assert!((0..3).all(|k| (z[k] - normal[k]).abs() < 1e-12), "{normal:?}");
        }
        assert_eq!(Frame::on_sphere([0.0, 0.0, 1.0], 0.0).x, [1.0, 0.0, 0.0]);
    }

    #[test]
    fn points_of_a_light_stay_within_it() {
        for light in Studio::Key.lights() {
            for (u, v) in [(0.0, 0.0), (0.5, 0.3), (0.999, 0.8)] {
                let cos = dot(light.point([u, v]), light.toward);
                assert!(cos >= light.radius.cos() - 1e-12);
            }
        }
    }
}
