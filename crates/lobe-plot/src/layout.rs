//! The layout of a figure: its width in its own units, and the store of its pictures.

use std::cell::RefCell;

/// The layout of a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layout {
    /// The width in units of the figure. The letters of labels are 14 to 17 units high.
    pub(crate) width: f64,
    /// Legends below the plots instead of next to them, and fewer columns.
    pub(crate) is_narrow: bool,
}

impl Layout {
    /// For printed columns and wide screens.
    pub(crate) const WIDE: Layout = Layout { width: 720.0, is_narrow: false };
    /// For phones: at 400 pixels, a unit is a pixel.
    pub(crate) const NARROW: Layout = Layout { width: 400.0, is_narrow: true };

    /// The layout whose letters are legible at this width in pixels.
    pub(crate) fn of(pixels: u32) -> Self {
        if pixels < 560 { Layout::NARROW } else { Layout::WIDE }
    }
}

/// The paper on which a figure is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Paper<'a> {
    pub(crate) layout: Layout,
    /// The width in pixels.
    pub(crate) pixels: u32,
    /// The store of pictures that several figures of a page show; a single figure contains its own pictures.
    pub(crate) sprites: Option<&'a Sprites>,
}

impl Paper<'_> {
    /// A single figure.
    pub(crate) fn alone(pixels: u32) -> Self {
        Paper { layout: Layout::of(pixels), pixels, sprites: None }
    }
}

/// Pictures that are stored once on a page and shown several times.
#[derive(Debug, Default)]
pub(crate) struct Sprites(RefCell<Vec<String>>);

impl Sprites {
    /// The id of a picture, which is stored if it is new.
    pub(crate) fn id(&self, url: String) -> String {
        let mut urls = self.0.borrow_mut();
        let at = urls.iter().position(|known| *known == url).unwrap_or(urls.len());
        if at == urls.len() {
            urls.push(url);
        }
        format!("picture-{at}")
    }

    /// The pictures, each one unit wide and high, as an SVG that shows nothing.
    pub(crate) fn svg(&self) -> String {
        let image = |(at, url): (usize, &String)| {
            format!(
                "<image id=\"picture-{at}\" width=\"1\" height=\"1\" preserveAspectRatio=\"none\" href=\"{url}\"/>\n"
            )
        };
        let images: String = self.0.borrow().iter().enumerate().map(image).collect();
        match images.is_empty() {
            true => images,
            false => format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"sprites\" width=\"0\" height=\"0\" aria-hidden=\"true\">\n\
                 <defs>\n{images}</defs>\n</svg>\n"
            ),
        }
    }
}
