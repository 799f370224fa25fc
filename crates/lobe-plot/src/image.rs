//! Raster images.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use colorous::Color;

/// sRGB pixels with straight (not premultiplied) alpha, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue and alpha of each pixel.
    pub rgba: Vec<u8>,
}

impl Image {
    /// Rows of `size` values each as colours; transparent where there is no value.
    pub(crate) fn square<T: Copy + Into<f64>>(
        size: usize,
        values: &[Option<T>],
        colour: impl Fn(f64) -> Color,
    ) -> Self {
        let pixel = |value: &Option<T>| match value {
            None => [0; 4],
            Some(value) => {
                let Color { r, g, b } = colour((*value).into());
                [r, g, b, 255]
            }
        };
        Image { width: size as u32, height: size as u32, rgba: values.iter().flat_map(pixel).collect() }
    }

    /// The picture as a PNG file.
    pub fn png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        let written = encoder.write_header().and_then(|mut writer| {
            writer.write_image_data(&self.rgba)?;
            writer.finish()
        });
        // Writing to memory fails only if the number of pixels is wrong.
        written.expect("four bytes per pixel");
        bytes
    }

    /// The picture as a `data:` URL.
    pub(crate) fn data_url(&self) -> String {
        format!("data:image/png;base64,{}", STANDARD.encode(self.png()))
    }
}
