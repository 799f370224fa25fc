//! A pass: one sample of every pixel, and the light paths that belong to it.

use super::Factors;

/// One pass of a picture. It depends on its number alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pass {
    /// The index of the sample that pixels get.
    pub number: u32,
    /// Number of light paths.
    pub paths: u32,
    /// The largest number of surfaces of a whole path.
    pub depth: u32,
    /// Radius within which light that has arrived elsewhere counts; `None` if nothing is merged.
    pub radius: Option<f32>,
    /// Columns and pixels of the whole picture.
    pub columns: u32,
    pub pixels: f32,
    /// Numbers of samples, for weights.
    pub factors: Factors,
}

impl Pass {
    /// The light path whose surfaces the path of a pixel is connected with.
    pub fn partner(&self, [x, y]: [u32; 2]) -> u32 {
        ((u64::from(y) * u64::from(self.columns) + u64::from(x)) % u64::from(self.paths)) as u32
    }
}

/// The radius of a pass: that of the first pass, shrunk so that noise and blur vanish together (Knaus and Zwicker 2011,
/// "Progressive Photon Mapping: A Probabilistic Approach"). It depends on no other pass.
pub(crate) fn radius_of(first: f32, number: u32, shrink: f32) -> f32 {
    let exponent = 0.5 * (f64::from(shrink) - 1.0);
    (f64::from(first) * libm::pow(f64::from(number) + 1.0, exponent)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_shrink_at_the_right_rate_and_need_no_other_pass() {
        assert_eq!(radius_of(0.25, 0, 0.7), 0.25);
        // The area shrinks by (i + shrink) / (i + 1) from pass to pass, in the limit.
        for number in [100, 10_000, 1 << 20] {
            let [a, b] = [number, number + number / 10].map(|number| f64::from(radius_of(1.0, number, 0.7)));
            let shrunk: f64 =
                (number + 1..=number + number / 10).map(|i| (f64::from(i) + 0.7) / (f64::from(i) + 1.0)).product();
            assert!((b * b / (a * a) / shrunk - 1.0).abs() < 1e-2, "{number}");
        }
    }

    #[test]
    fn every_pixel_has_a_light_path() {
        let pass = Pass {
            number: 0,
            paths: 7,
            depth: 8,
            radius: None,
            columns: 65_536,
            pixels: 1.0,
            factors: Factors::new(7, None),
        };
        assert_eq!([pass.partner([6, 0]), pass.partner([7, 0]), pass.partner([0, 1])], [6, 0, 65_536 % 7]);
        assert!(pass.partner([65_535, 65_535]) < 7);
    }
}
