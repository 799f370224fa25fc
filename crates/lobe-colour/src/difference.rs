//! The perceived difference of two colours.

use std::f64::consts::TAU;

use crate::WHITE;

/// CIELAB of an XYZ relative to a perfect white with Y = 1 (ISO/CIE 11664-4).
fn lab(xyz: [f64; 3]) -> [f64; 3] {
    const KINK: f64 = 6.0 / 29.0;
    let f = |t: f64| if t > KINK.powi(3) { t.cbrt() } else { t / (3.0 * KINK * KINK) + 4.0 / 29.0 };
    let [x, y, z] = [0, 1, 2].map(|k| f(xyz[k] / WHITE[k]));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The colour difference of two XYZ relative to a perfect white with Y = 1: CIE delta E 2000 (ISO/CIE 11664-6) between
/// their CIELAB under D65.
pub fn delta_e(a: [f64; 3], b: [f64; 3]) -> f64 {
    of_labs(lab(a), lab(b))
}

/// In the notation of G. Sharma, W. Wu and E. Dalal, "The CIEDE2000 color-difference formula: implementation notes",
/// Color Research and Application 30(1), 2005: angles are in degrees, and a hue of grey is 0.
fn of_labs([l1, a1, b1]: [f64; 3], [l2, a2, b2]: [f64; 3]) -> f64 {
    let saturation = |c: f64| (c.powi(7) / (c.powi(7) + 25f64.powi(7))).sqrt();
    let stretch = 1.0 + 0.5 * (1.0 - saturation((a1.hypot(b1) + a2.hypot(b2)) / 2.0));
    let polar = |a: f64, b: f64| ((stretch * a).hypot(b), b.atan2(stretch * a).rem_euclid(TAU).to_degrees());
    let ((c1, h1), (c2, h2)) = (polar(a1, b1), polar(a2, b2));
    let is_grey = c1 * c2 == 0.0;

    // The shorter way around the circle, and the hue in the middle of it.
    let turn = match h2 - h1 {
        _ if is_grey => 0.0,
        turn if turn > 180.0 => turn - 360.0,
        turn if turn < -180.0 => turn + 360.0,
        turn => turn,
    };
    let mean_hue = match h1 + h2 {
        sum if is_grey => sum,
        sum if (h1 - h2).abs() <= 180.0 => sum / 2.0,
        sum if sum < 360.0 => (sum + 360.0) / 2.0,
        sum => (sum - 360.0) / 2.0,
    };
    let (mean_l, mean_c) = ((l1 + l2) / 2.0, (c1 + c2) / 2.0);

    let cos = |degrees: f64| degrees.to_radians().cos();
    let hue_weight = 1.0 - 0.17 * cos(mean_hue - 30.0) + 0.24 * cos(2.0 * mean_hue) + 0.32 * cos(3.0 * mean_hue + 6.0)
        - 0.20 * cos(4.0 * mean_hue - 63.0);
    let from_middle = (mean_l - 50.0).powi(2);
    let scale_l = 1.0 + 0.015 * from_middle / (20.0 + from_middle).sqrt();
    let scale_c = 1.0 + 0.045 * mean_c;
    let scale_h = 1.0 + 0.015 * mean_c * hue_weight;
    let blue = 30.0 * (-((mean_hue - 275.0) / 25.0).powi(2)).exp();
    let rotation = -2.0 * saturation(mean_c) * (2.0 * blue).to_radians().sin();

    let lightness = (l2 - l1) / scale_l;
    let chroma = (c2 - c1) / scale_c;
    let hue = 2.0 * (c1 * c2).sqrt() * (turn / 2.0).to_radians().sin() / scale_h;
    (lightness.powi(2) + chroma.powi(2) + hue.powi(2) + rotation * chroma * hue).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Table 1 of the paper; pairs that reach every branch.
    #[test]
    fn differences_agree_with_the_published_pairs() {
        for (a, b, expected) in [
            ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
            ([50.0, 3.1571, -77.2803], [50.0, 0.0, -82.7485], 2.8615),
            ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0000),
            ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
            ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0009], 7.1792),
            ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0010], 7.1792),
            ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0011], 7.2195),
            ([50.0, -0.0010, 2.4900], [50.0, 0.0009, -2.4900], 4.8045),
            ([50.0, -0.0010, 2.4900], [50.0, 0.0011, -2.4900], 4.7461),
            ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
            ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
            ([50.0, 2.5, 0.0], [61.0, -5.0, 29.0], 22.8977),
            ([50.0, 2.5, 0.0], [56.0, -27.0, -3.0], 31.9030),
            ([50.0, 2.5, 0.0], [58.0, 24.0, 15.0], 19.4535),
            ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
            ([22.7233, 20.0904, -46.6940], [23.0331, 14.9730, -42.5619], 2.0373),
            ([90.9257, -0.5406, -0.9208], [88.6381, -0.8985, -0.7239], 1.5381),
            ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514], 0.9082),
        ] {
            for found in [of_labs(a, b), of_labs(b, a)] {
                assert!((found - expected).abs() < 1e-4, "{found} is not {expected} of {a:?} and {b:?}");
            }
        }
    }

    #[test]
    fn white_and_black_are_a_hundred_apart() {
        assert_eq!(lab(WHITE), [100.0, 0.0, 0.0]);
        assert!((delta_e(WHITE, [0.0; 3]) - 100.0).abs() < 1e-9);
        assert_eq!(delta_e(WHITE.map(|c| 0.3 * c), WHITE.map(|c| 0.3 * c)), 0.0);
    }
}
