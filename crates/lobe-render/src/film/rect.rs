//! Rectangles of pixels.

use std::ops::Range;

/// A rectangle of pixels; rows count downward from the top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// The leftmost column.
    pub x: u32,
    /// The top row.
    pub y: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
}

impl Rect {
    /// Number of pixels.
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

    /// The pixels that both rectangles contain; `None` if there are none.
    pub fn intersection(&self, other: &Rect) -> Option<Rect> {
        let (x, y) = (self.x.max(other.x), self.y.max(other.y));
        let right = self.columns().end.min(other.columns().end);
        let bottom = self.rows().end.min(other.rows().end);
        (x < right && y < bottom).then(|| Rect { x, y, width: right - x, height: bottom - y })
    }

    /// Part `part` of `parts`, counted from 1: strips of whole rows, as equal as possible. `None` if there is no such
    /// part, or there are fewer rows than parts.
    pub fn strip(&self, part: u32, parts: u32) -> Option<Rect> {
        if !(1..=parts).contains(&part) || parts > self.height {
            return None;
        }
        let row = |strip: u32| (u64::from(self.height) * u64::from(strip) / u64::from(parts)) as u32;
        let (first, end) = (row(part - 1), row(part));
        Some(Rect { y: self.y + first, height: end - first, ..*self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_follow_each_other_and_none_is_empty() {
        let whole = Rect { x: 2, y: 3, width: 5, height: 7 };
        for parts in 1..=7 {
            let mut next = whole.y;
            for part in 1..=parts {
                let strip = whole.strip(part, parts).expect("a part");
                assert_eq!((strip.x, strip.y, strip.width), (2, next, 5), "{part} of {parts}");
                assert!(strip.height >= 7 / parts);
                next += strip.height;
            }
            assert_eq!(next, 10);
            assert_eq!((whole.strip(0, parts), whole.strip(parts + 1, parts)), (None, None));
        }
        assert_eq!(whole.strip(1, 8), None);
    }
}
