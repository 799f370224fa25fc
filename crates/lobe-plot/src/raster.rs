//! SVG to pixels.

use std::sync::{Arc, OnceLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use thiserror::Error;

use crate::image::Image;

/// A figure that could not be turned into pixels.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum RasterError {
    /// Not an SVG.
    #[error("the figure is not an SVG: {0}")]
    Svg(String),
    /// No pixels, or more than fit into memory.
    #[error("a picture of {width} x {height} pixels cannot be made")]
    Size {
        /// Pixels per row.
        width: u32,
        /// Rows.
        height: u32,
    },
}

/// The typeface of all figures, in the two weights that they use. Glyphs that it lacks, such as other scripts in the
/// name of a file, are taken from the machine's fonts.
const FACES: [&[u8]; 2] =
    [include_bytes!("../assets/Roboto-Regular.ttf"), include_bytes!("../assets/Roboto-Medium.ttf")];

fn fonts() -> Arc<fontdb::Database> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    let load = || {
        let mut fonts = fontdb::Database::new();
        fonts.load_system_fonts();
        FACES.into_iter().for_each(|face| fonts.load_font_data(face.to_vec()));
        Arc::new(fonts)
    };
    Arc::clone(FONTS.get_or_init(load))
}

/// A figure as a PNG file `width` pixels wide.
///
/// # Errors
/// [`RasterError`] if `svg` is not an SVG, or `width` is 0 or far too large.
pub fn rasterise(svg: &str, width: u32) -> Result<Vec<u8>, RasterError> {
    let options = Options { font_family: "Roboto".into(), fontdb: fonts(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|error| RasterError::Svg(error.to_string()))?;
    let scale = width as f32 / tree.size().width();
    let height = (scale * tree.size().height()).round() as u32;
    let mut pixmap = Pixmap::new(width, height).ok_or(RasterError::Size { width, height })?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let rgba = pixmap.pixels().iter().flat_map(|pixel| {
        let pixel = pixel.demultiply();
        [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()]
    });
    Ok(Image { width, height, rgba: rgba.collect() }.png())
}
