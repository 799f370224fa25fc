//! The difference of two materials, in numbers and in appearance.

use std::f64::consts::PI;

use lobe_colour::{NoColour, Space, WHITE, delta_e};
use serde::Serialize;

use crate::colour::Coloured;
use crate::directions::pairs;
use crate::pairs::eval_pairs;
use crate::{Aspect, OnBackend};

/// The differences of two materials over a set of directions, all channels together, in 1/sr.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// The names of the channels that were compared.
    pub channels: Vec<String>,
    /// The number of pairs of directions.
    pub pairs: usize,
    /// The largest value of the first material among them.
    pub peak: f64,
    /// The largest difference.
    pub max: f64,
    /// The root of the mean squared difference.
    pub rms: f64,
    /// The mean of the second material minus the first.
    pub bias: f64,
    /// `rms` relative to the root of the mean squared value of the first material.
    pub relative_rms: f64,
    /// The directions of the largest difference: `wi` and `wo`, with z > 0.
    pub worst: [[f64; 3]; 2],
}

/// How different two spheres look, one of each material, under one light: CIE delta E 2000 of their pixels. About 1 is
/// just noticeable side by side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Visible {
    /// The number of lit pixels.
    pub pixels: usize,
    /// The mean over them.
    pub mean: f64,
    /// A twentieth of the pixels differ by more.
    pub percentile_95: f64,
    /// The largest.
    pub max: f64,
}

/// Compares two materials at up to `count` pairs of directions with polar angles up to `limit` in radians: the same
/// pairs at every call, half of them near the mirror direction.
///
/// Materials with the same channels are compared in these, others in XYZ.
///
/// # Errors
/// [`NoColour`] if the channels differ and those of one material have no colour.
pub fn difference<'a>(
    a: impl Into<OnBackend<'a>>,
    b: impl Into<OnBackend<'a>>,
    aspect: Aspect,
    limit: f64,
    count: usize,
) -> Result<Difference, NoColour> {
    let (a, b) = (a.into(), b.into());
    if a.channels() != b.channels() {
        let (a, b) = (Coloured::new(a, Space::Xyz)?, Coloured::new(b, Space::Xyz)?);
        return difference(&a, &b, aspect, limit, count);
    }
    let pairs = pairs(count, limit);
    let placed: Vec<_> = pairs.iter().map(|&(wi, wo)| aspect.place(wi, wo)).collect();
    let (first, second) = (eval_pairs(a, &placed), eval_pairs(b, &placed));
    let channels = a.channels().count();
    let (mut max, mut worst, mut peak) = (0.0, [[0.0, 0.0, 1.0]; 2], 0.0_f64);
    let (mut squares, mut values, mut bias) = (0.0, 0.0, 0.0);
    for (index, (&a, &b)) in first.iter().zip(&second).enumerate() {
        let (a, difference) = (f64::from(a), f64::from(b) - f64::from(a));
        squares += difference * difference;
        values += a * a;
        bias += difference;
        peak = peak.max(a);
        if difference.abs() > max {
            let (wi, wo) = pairs[index / channels];
            (max, worst) = (difference.abs(), [wi, wo]);
        }
    }
    let count = first.len().max(1) as f64;
    Ok(Difference {
        channels: a.channels().names(),
        pairs: pairs.len(),
        peak,
        max,
        rms: (squares / count).sqrt(),
        bias: bias / count,
        relative_rms: if values > 0.0 { (squares / values).sqrt() } else { 0.0 },
        worst,
    })
}

/// The differences of two spheres, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Spheres {
    /// The width and the height of the picture in pixels.
    pub size: usize,
    /// CIE delta E 2000, row by row from the top; `None` where no light is seen.
    pub delta_e: Vec<Option<f64>>,
}

impl Spheres {
    /// Their summary.
    pub fn summary(&self) -> Visible {
        let mut errors: Vec<f64> = self.delta_e.iter().copied().flatten().collect();
        errors.sort_by(f64::total_cmp);
        let at = |share: f64| errors.get((share * errors.len() as f64) as usize).copied().unwrap_or(0.0);
        Visible {
            pixels: errors.len(),
            mean: errors.iter().sum::<f64>() / errors.len().max(1) as f64,
            percentile_95: at(0.95),
            max: errors.last().copied().unwrap_or(0.0),
        }
    }
}

/// Draws a sphere of each material, `size` pixels wide, seen from afar under a distant light at 45 degrees from above
/// left, and compares their pixels.
///
/// The colour of a pixel is relative to a perfect white that faces the light; brighter pixels are clipped to white, as
/// in a picture.
///
/// # Errors
/// [`NoColour`] if the channels of one material have no colour.
pub fn spheres<'a>(
    a: impl Into<OnBackend<'a>>,
    b: impl Into<OnBackend<'a>>,
    aspect: Aspect,
    size: usize,
) -> Result<Spheres, NoColour> {
    let pixels = lit_pixels(size);
    let (first, second) = (colours(a, aspect, &pixels)?, colours(b, aspect, &pixels)?);
    let mut found = vec![None; size * size];
    for (pixel, (a, b)) in pixels.iter().zip(first.into_iter().zip(second)) {
        found[pixel.index] = Some(delta_e(a, b));
    }
    Ok(Spheres { size, delta_e: found })
}

/// The summary of [`spheres`].
///
/// # Errors
/// The same as for [`spheres`].
pub fn visible<'a>(
    a: impl Into<OnBackend<'a>>,
    b: impl Into<OnBackend<'a>>,
    aspect: Aspect,
    size: usize,
) -> Result<Visible, NoColour> {
    Ok(spheres(a, b, aspect, size)?.summary())
}

/// A pixel that sees both the light and the viewer: its index, and the directions to both in its frame.
struct LitPixel {
    index: usize,
    wi: [f64; 3],
    wo: [f64; 3],
}

fn lit_pixels(size: usize) -> Vec<LitPixel> {
    const LIGHT: [f64; 3] = [-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2];
    const VIEWER: [f64; 3] = [0.0, 0.0, 1.0];
    let centre = |index: usize| (2.0 * index as f64 + 1.0) / size as f64 - 1.0;
    let mut pixels = Vec::new();
    for row in 0..size {
        for column in 0..size {
            let (x, y) = (centre(column), -centre(row));
            let square = x * x + y * y;
            if square >= 1.0 {
                continue;
            }
            let normal = [x, y, (1.0 - square).sqrt()];
            // The tangent is around the vertical axis, to which no visible normal is parallel.
            let around = normal[0].hypot(normal[2]);
            let tangent = [normal[2] / around, 0.0, -normal[0] / around];
            let up = cross(normal, tangent);
            let local = |w: [f64; 3]| [dot(w, tangent), dot(w, up), dot(w, normal)];
            let (wi, wo) = (local(LIGHT), local(VIEWER));
            if wi[2] > 0.0 && wo[2] > 0.0 {
                pixels.push(LitPixel { index: row * size + column, wi, wo });
            }
        }
    }
    pixels
}

/// XYZ of the pixels, relative to a perfect white that faces the light, with Y = 1.
fn colours<'a>(
    scattering: impl Into<OnBackend<'a>>,
    aspect: Aspect,
    pixels: &[LitPixel],
) -> Result<Vec<[f64; 3]>, NoColour> {
    let coloured = Coloured::new(scattering, Space::Xyz)?;
    let placed: Vec<_> = pixels.iter().map(|pixel| aspect.place(pixel.wi, pixel.wo)).collect();
    let values = eval_pairs(&coloured, &placed);
    let colour = |(pixel, xyz): (&LitPixel, &[f32])| {
        [0, 1, 2].map(|c| (PI * f64::from(xyz[c]) * pixel.wi[2]).clamp(0.0, WHITE[c]))
    };
    Ok(pixels.iter().zip(values.chunks_exact(3)).map(colour).collect())
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Exact, Mono};
    use lobe_model::Lambert;

    #[test]
    fn a_constant_difference_is_found() {
        let (a, b) = (Mono(|_, _| 0.25), Mono(|_, _| 0.2));
        let found = difference(&a, &b, Aspect::REFLECTION, 1.4, 1000).expect("one channel");
        for (x, expected) in [(found.max, 0.05), (found.rms, 0.05), (found.bias, -0.05), (found.relative_rms, 0.2)] {
            assert!((x - expected).abs() < 1e-6, "{found:?}");
        }
        let same = difference(&a, &a, Aspect::REFLECTION, 1.4, 1000).expect("one channel");
        assert_eq!((same.max, same.rms), (0.0, 0.0));
        assert_eq!(visible(&a, &a, Aspect::REFLECTION, 32).expect("grey").max, 0.0);
    }

    #[test]
    fn the_largest_difference_is_named() {
        let bump = Mono(|_: [f64; 3], wo: [f64; 3]| if wo[0] > 0.9 { 1.0 } else { 0.0 });
        let found = difference(&Mono(|_, _| 0.0), &bump, Aspect::REFLECTION, 1.5, 20_000).expect("one channel");
        assert!(found.max == 1.0 && found.worst[1][0] > 0.9, "{found:?}");
    }

    #[test]
    fn different_channels_are_compared_in_xyz() {
        let found =
            difference(&Mono(|_, _| 0.3 / PI), &Exact(Lambert { albedo: [0.3; 3] }), Aspect::REFLECTION, 1.4, 500)
                .expect("colours");
        assert_eq!(found.channels, ["X", "Y", "Z"]);
        assert!(found.max < 1e-4, "{found:?}");
    }

    /// White and black differ by 100 where the white sphere faces the light, and by less where it is darker.
    #[test]
    fn spheres_differ_in_appearance() {
        let grey = |albedo: f64| Exact(Lambert { albedo: [albedo; 3] });
        let pixels = spheres(&grey(1.0), &grey(0.0), Aspect::REFLECTION, 64).expect("colours");
        let far = pixels.summary();
        // Bright above left, dark below right, and nothing in the corners.
        let at = |row: usize, column: usize| pixels.delta_e[row * 64 + column];
        assert!(at(16, 20) > Some(90.0) && at(50, 40) < at(16, 20) && at(0, 0).is_none(), "{:?}", at(16, 20));
        assert!((far.max - 100.0).abs() < 0.5 && far.mean < far.percentile_95, "{far:?}");
        assert!(far.pixels > 64 * 64 / 2, "{far:?}");
        let near = visible(&grey(0.5), &grey(0.51), Aspect::REFLECTION, 64).expect("colours");
        assert!(near.max < 1.2 && near.mean > 0.2, "{near:?}");
    }
}
