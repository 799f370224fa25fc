//! From linear sRGB to display values, in portable arithmetic, so the bytes are the same on every machine.

/// A tone map: exposure, a shoulder, and the curve of sRGB.
///
/// Radiance is multiplied by `2^exposure`. Values up to 0.7 are then left as they are, so that colours of materials do
/// not change; brighter ones approach 1 along `1 - 0.3 exp((0.7 - x) / 0.3)`, which continues with the same slope, so
/// that highlights do not end in flat patches. The transfer function of IEC 61966-2-1 is applied last.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToneMap {
    /// In stops.
    pub exposure: f32,
}

/// The value at which the shoulder begins.
const SHOULDER: f32 = 0.7;

impl ToneMap {
    /// The byte for a radiance. Negative radiance and NaN are black.
    pub fn byte(&self, radiance: f32) -> u8 {
        let x = radiance * libm::exp2f(self.exposure);
        let x = if x > SHOULDER { 1.0 - (1.0 - SHOULDER) * libm::expf((SHOULDER - x) / (1.0 - SHOULDER)) } else { x };
        encode(x)
    }
}

/// The byte for a linear value from 0 to 1, by the sRGB transfer function; values outside are clipped, NaN is 0.
pub fn encode(linear: f32) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let curved = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * libm::powf(x, 1.0 / 2.4) - 0.055 };
    (255.0 * curved + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_are_those_of_srgb_and_highlights_do_not_clip() {
        let tone = ToneMap::default();
        assert_eq!([0.0, 0.18, 0.5].map(|x| tone.byte(x)), [0, 118, 188]);
        assert!(tone.byte(1.0) < tone.byte(1.5) && tone.byte(1.5) < tone.byte(3.0));
        assert_eq!((tone.byte(-1.0), tone.byte(f32::INFINITY), tone.byte(f32::NAN)), (0, 255, 0));
        assert_eq!(ToneMap { exposure: 1.0 }.byte(0.09), tone.byte(0.18));
        assert_eq!([0.0, 0.5, 1.0, 2.0].map(encode), [0, 188, 255, 255]);
    }

    #[test]
    fn the_shoulder_continues_with_the_same_slope() {
        let tone = ToneMap::default();
        let bytes: Vec<u8> = (0..400).map(|k| tone.byte(0.5 + 0.001 * k as f32)).collect();
        assert!(bytes.windows(2).all(|pair| pair[1] >= pair[0] && pair[1] - pair[0] <= 1), "{bytes:?}");
    }
}
