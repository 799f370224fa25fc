//! Rectangles of pixels.

use std::ops::Range;

/// A rectangle of pixels; rows count downward from the top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// The leftmost column.
    pub x: u32,
    /// The top row.
    pub y: u32,
    /// How many columns.
    pub width: u32,
    /// How many rows.
    pub height: u32,
}

impl Rect {
    /// How many pixels.
    pub fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The columns.
    pub fn columns(&self) -> Range<u32> {
        self.x..self.x + self.width
    }

    /// The rows.
    pub fn rows(&self) -> Range<u32> {
        self.y..self.y + self.height
    }

    /// The pixels that both have; `None` if there are none.
    pub fn intersection(&self, other: &Rect) -> Option<Rect> {
        let (x, y) = (self.x.max(other.x), self.y.max(other.y));
        let right = self.columns().end.min(other.columns().end);
        let bottom = self.rows().end.min(other.rows().end);
        (x < right && y < bottom).then(|| Rect { x, y, width: right - x, height: bottom - y })
    }
}
