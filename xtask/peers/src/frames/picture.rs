//! Shows pictures side by side with their difference.

use lobe_render::Film;
use lobe_render::picture::{ToneMap, encode_rgb};

/// Mean radiance of the pixels, three values each, row by row from the top.
pub fn linear(film: &Film) -> Vec<f32> {
    film.colours().flatten().collect()
}

/// Two pictures of the same size and the difference of each pixel in standard deviations, from left to right, as PNG.
pub fn beside(size: [u32; 2], pictures: [&[f64]; 2], deviations: &[f64]) -> Vec<u8> {
    let [width, height] = size.map(|side| side as usize);
    let tone = ToneMap { exposure: -0.9 };
    let mut bytes = Vec::with_capacity(9 * width * height);
    for row in 0..height {
        for picture in pictures {
            let row = &picture[3 * width * row..][..3 * width];
            bytes.extend(row.iter().map(|radiance| tone.byte(*radiance as f32)));
        }
        bytes.extend(deviations[width * row..][..width].iter().flat_map(|deviation| colour(*deviation)));
    }
    encode_rgb(3 * size[0], size[1], &bytes)
}

/// White where pictures agree, red where the first is brighter by four deviations or more, blue where it is darker.
fn colour(deviation: f64) -> [u8; 3] {
    let share = (deviation / 4.0).clamp(-1.0, 1.0);
    let rest = (255.0 * (1.0 - share.abs())) as u8;
    if share > 0.0 { [255, rest, rest] } else { [rest, rest, 255] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_is_white_and_the_sign_is_a_colour() {
        assert_eq!([0.0, 2.0, -9.0].map(colour), [[255; 3], [255, 127, 127], [0, 0, 255]]);
    }
}
