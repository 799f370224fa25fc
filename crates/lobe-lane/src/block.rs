//! A pattern of corner loads that cannot leave its table.

/// A slice of texels with `N` fixed offsets, all of which are inside it for every base up to a known last one.
///
/// An interpolation loads the same pattern of corners from one base index. Checking each of the 2 to 8 loads of a
/// query would put a branch before every load of the hottest loop. A `Block` checks the pattern once: a base clamped
/// to [`last_base`](Block::last_base) keeps every load of `WIDTH` elements at `base + offset` inside the slice.
#[derive(Clone, Copy, Debug)]
pub struct Block<'a, const N: usize, const WIDTH: usize, T = f32> {
    data: &'a [T],
    offsets: [usize; N],
    last_base: usize,
}

impl<'a, const N: usize, const WIDTH: usize, T> Block<'a, N, WIDTH, T> {
    /// A pattern of `N` loads of `WIDTH` elements at `base + offsets[i]` of `data`.
    ///
    /// # Panics
    /// If `data` is too short for the pattern even at base 0.
    pub fn new(data: &'a [T], offsets: [usize; N]) -> Self {
        let reach = offsets.iter().max().map_or(0, |far| far.checked_add(WIDTH).expect("offset overflow"));
        let last_base = data.len().checked_sub(reach).expect("a table shorter than its corner pattern");
        Block { data, offsets, last_base }
    }

    /// All elements of the table.
    #[inline(always)]
    pub fn data(&self) -> &'a [T] {
        self.data
    }

    /// The fixed offsets; `last_base() + offsets()[i] + WIDTH <= data().len()` for each.
    #[inline(always)]
    pub fn offsets(&self) -> &[usize; N] {
        &self.offsets
    }

    /// The largest base from which the whole pattern is inside the table.
    #[inline(always)]
    pub fn last_base(&self) -> usize {
        self.last_base
    }
}
