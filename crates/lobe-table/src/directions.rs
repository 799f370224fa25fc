//! Batches of directions in memory: vectors one after the other, or columns of components.

use std::ops::Range;

use lobe_lane::Lanes;

use crate::passes::block::BLOCK;

/// Unit vectors, one per query, in either layout.
///
/// It is made [`From`] slices, arrays and vectors of `[f32; 3]`, or by [`columns`](Directions::columns).
#[derive(Clone, Copy, Debug)]
pub enum Directions<'a> {
    /// x, y and z of one direction next to each other.
    Vectors(&'a [[f32; 3]]),
    /// All x, all y and all z, which are equally many.
    Columns([&'a [f32]; 3]),
}

impl<'a> From<&'a [[f32; 3]]> for Directions<'a> {
    fn from(vectors: &'a [[f32; 3]]) -> Self {
        Directions::Vectors(vectors)
    }
}

impl<'a> From<&'a mut [[f32; 3]]> for Directions<'a> {
    fn from(vectors: &'a mut [[f32; 3]]) -> Self {
        Directions::Vectors(vectors)
    }
}

impl<'a> From<&'a Vec<[f32; 3]>> for Directions<'a> {
    fn from(vectors: &'a Vec<[f32; 3]>) -> Self {
        Directions::Vectors(vectors)
    }
}

impl<'a, const N: usize> From<&'a [[f32; 3]; N]> for Directions<'a> {
    fn from(vectors: &'a [[f32; 3]; N]) -> Self {
        Directions::Vectors(vectors)
    }
}

impl<'a> Directions<'a> {
    /// Directions whose components are in separate slices.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn columns(x: &'a [f32], y: &'a [f32], z: &'a [f32]) -> Self {
        assert!(x.len() == y.len() && y.len() == z.len(), "components of {}, {}, {}", x.len(), y.len(), z.len());
        Directions::Columns([x, y, z])
    }

    /// The number of directions.
    ///
    /// # Panics
    /// If they are columns that differ in length.
    pub fn count(&self) -> usize {
        match self {
            Directions::Vectors(vectors) => vectors.len(),
            Directions::Columns([x, y, z]) => {
                assert!(
                    x.len() == y.len() && y.len() == z.len(),
                    "components of {}, {}, {}",
                    x.len(),
                    y.len(),
                    z.len()
                );
                x.len()
            }
        }
    }

    /// One direction.
    ///
    /// # Panics
    /// If there are fewer directions.
    #[inline]
    pub fn get(&self, index: usize) -> [f32; 3] {
        match self {
            Directions::Vectors(vectors) => vectors[index],
            Directions::Columns(columns) => columns.map(|column| column[index]),
        }
    }

    /// Directions `range`, for splitting a batch.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn part(&self, range: Range<usize>) -> Self {
        match self {
            Directions::Vectors(vectors) => Directions::Vectors(&vectors[range]),
            Directions::Columns([x, y, z]) => Directions::Columns([&x[range.clone()], &y[range.clone()], &z[range]]),
        }
    }

    /// The block from direction `at` on. If fewer are left than a block has, zero vectors follow.
    ///
    /// A block that is not full is copied to `padding`, and so are vectors for a single lane, which reads only columns.
    #[inline(always)]
    pub(crate) fn block<'b, L: Lanes>(&'b self, _lanes: L, at: usize, padding: &'b mut Padding) -> DirectionBlock<'b> {
        match self {
            Directions::Vectors(vectors) => {
                let rest = &vectors[at..];
                match rest.first_chunk() {
                    Some(whole) if L::LANES > 1 => return DirectionBlock::of_vectors(whole),
                    Some(whole) => padding.fill(whole),
                    None => padding.fill_partly(rest.len(), |query| rest[query]),
                }
            }
            Directions::Columns([x, y, z]) => {
                let (x, y, z) = (&x[at..], &y[at..], &z[at..]);
                if let (Some(x), Some(y), Some(z)) = (x.first_chunk(), y.first_chunk(), z.first_chunk()) {
                    return DirectionBlock::of_columns([x, y, z]);
                }
                padding.fill_partly(x.len(), |query| [x[query], y[query], z[query]]);
            }
        }
        let [x, y, z] = &padding.0;
        DirectionBlock::of_columns([x, y, z])
    }
}

/// Space for a block that is copied.
pub(crate) struct Padding([[f32; BLOCK]; 3]);

pub(crate) const PADDING: Padding = Padding([[0.0; BLOCK]; 3]);

impl Padding {
    #[inline(always)]
    fn fill(&mut self, whole: &[[f32; 3]; BLOCK]) {
        let mut query = 0;
        while query < BLOCK {
            let mut axis = 0;
            while axis < 3 {
                self.0[axis][query] = whole[query][axis];
                axis += 1;
            }
            query += 1;
        }
    }

    /// Copies the last block of a batch: this happens once per batch, and so is kept out of the kernels.
    #[inline(never)]
    fn fill_partly(&mut self, count: usize, vector: impl Fn(usize) -> [f32; 3]) {
        for query in 0..BLOCK {
            let [x, y, z] = if query < count { vector(query) } else { [0.0; 3] };
            self.0[0][query] = x;
            self.0[1][query] = y;
            self.0[2][query] = z;
        }
    }
}

/// A full block of directions, which needs no bounds checks.
#[derive(Clone, Copy)]
pub(crate) struct DirectionBlock<'a, const B: usize = BLOCK> {
    /// The directions, unless they are in `columns`.
    vectors: Option<&'a [[f32; 3]; B]>,
    columns: [&'a [f32; B]; 3],
}

impl<'a, const B: usize> DirectionBlock<'a, B> {
    #[inline(always)]
    pub(crate) fn of_columns(columns: [&'a [f32; B]; 3]) -> Self {
        DirectionBlock { vectors: None, columns }
    }

    /// For more than one lane.
    #[inline(always)]
    fn of_vectors(vectors: &'a [[f32; 3]; B]) -> Self {
        DirectionBlock { vectors: Some(vectors), columns: [&[0.0; B]; 3] }
    }

    /// Directions `at .. at + LANES` of the block as x, y and z; `at` is a multiple of the lanes.
    ///
    /// The branch goes the same way for a whole batch. A single lane has no branch: it would be executed once per
    /// query, and would keep the compiler from computing several queries at once.
    #[inline(always)]
    pub(crate) fn load<L: Lanes>(self, lanes: L, at: usize) -> [L::F; 3] {
        let at = at & (B - L::LANES);
        match self.vectors {
            Some(vectors) if L::LANES > 1 => lanes.load_xyz(&vectors[at..][..L::LANES]),
            _ => {
                let [x, y, z] = self.columns;
                [lanes.load(&x[at..][..L::LANES]), lanes.load(&y[at..][..L::LANES]), lanes.load(&z[at..][..L::LANES])]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_layouts_give_the_same_blocks() {
        check_blocks(lobe_scalar::Scalar::<1>);
        check_blocks(lobe_scalar::Scalar::<4>);
    }

    fn check_blocks<L: Lanes>(lanes: L) {
        let count = 2 * BLOCK + 5;
        let vectors: Vec<[f32; 3]> = (0..count).map(|i| [0.0, 0.25, 0.5].map(|part| i as f32 + part)).collect();
        let [x, y, z] = [0, 1, 2].map(|k| vectors.iter().map(|v| v[k]).collect::<Vec<f32>>());
        let layouts = [Directions::from(&vectors), Directions::columns(&x, &y, &z)];
        for at in [0, BLOCK, 2 * BLOCK] {
            for directions in layouts {
                assert_eq!(directions.count(), count);
                let mut padding = Padding([[f32::NAN; BLOCK]; 3]);
                let block = directions.block(lanes, at, &mut padding);
                for query in 0..BLOCK {
                    let found = lanes.extract_xyz(block.load(lanes, query), query % L::LANES);
                    assert_eq!(found, vectors.get(at + query).copied().unwrap_or_default());
                }
                assert_eq!(directions.part(at..count).count(), count - at);
            }
        }
    }

    #[test]
    #[should_panic(expected = "components of 1, 2, 1")]
    fn columns_must_have_equal_lengths() {
        Directions::Columns([&[0.0], &[0.0, 0.0], &[0.0]]).count();
    }
}
