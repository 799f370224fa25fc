//! The paper of a figure: how wide it is in its own units, and where its pictures are kept.

use std::cell::RefCell;

/// How a figure is laid out.
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

    /// The layout whose letters can be read at this width in pixels.
    pub(crate) fn of(pixels: u32) -> Self {
        if pixels < 560 { Layout::NARROW } else { Layout::WIDE }
    }
}

/// What a figure is drawn on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Paper<'a> {
    pub(crate) layout: Layout,
    /// The width in pixels.
    pub(crate) pixels: u32,
    /// Where the pictures are that several figures of a page show; a figure by itself holds its own.
    pub(crate) sprites: Option<&'a Sprites>,
}

impl Paper<'_> {
    /// A figure by itself.
    pub(crate) fn alone(pixels: u32) -> Self {
        Paper { layout: Layout::of(pixels), pixels, sprites: None }
    }
}

/// Pictures that are on a page once and shown several times.
#[derive(Debug, Default)]
pub(crate) struct Sprites(RefCell<Vec<String>>);

impl Sprites {
    /// The id of a picture, which is kept if it is new.
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
