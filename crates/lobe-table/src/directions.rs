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
    /// Directions whose components lie in slices of their own.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn columns(x: &'a [f32], y: &'a [f32], z: &'a [f32]) -> Self {
        assert!(x.len() == y.len() && y.len() == z.len(), "components of {}, {}, {}", x.len(), y.len(), z.len());
        Directions::Columns([x, y, z])
    }

    /// How many there are.
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
    /// If there are not so many.
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

    /// The block from direction `at` on. If fewer are left than a block has, they are copied to `padding`, zero vectors
    /// behind them.
    #[inline(always)]
    pub(crate) fn block<'b>(&'b self, at: usize, padding: &'b mut Padding) -> DirectionBlock<'b> {
        match self {
            Directions::Vectors(vectors) => {
                let rest = &vectors[at..];
                match rest.first_chunk() {
                    Some(whole) => DirectionBlock::Vectors(whole),
                    None => {
                        padding[..rest.len()].copy_from_slice(rest);
                        padding[rest.len()..].fill([0.0; 3]);
                        DirectionBlock::Vectors(padding)
                    }
                }
            }
            Directions::Columns([x, y, z]) => {
                let (x, y, z) = (&x[at..], &y[at..], &z[at..]);
                match (x.first_chunk(), y.first_chunk(), z.first_chunk()) {
                    (Some(x), Some(y), Some(z)) => DirectionBlock::Columns([x, y, z]),
                    _ => {
                        let mut query = 0;
                        while query < BLOCK {
                            let is_there = query < x.len();
                            padding[query] = if is_there { [x[query], y[query], z[query]] } else { [0.0; 3] };
                            query += 1;
                        }
                        DirectionBlock::Vectors(padding)
                    }
                }
            }
        }
    }
}

/// Room for a block that is not whole.
pub(crate) type Padding = [[f32; 3]; BLOCK];

pub(crate) const PADDING: Padding = [[0.0; 3]; BLOCK];

/// A whole block of directions, which needs no bounds checks.
#[derive(Clone, Copy)]
pub(crate) enum DirectionBlock<'a> {
    Vectors(&'a [[f32; 3]; BLOCK]),
    Columns([&'a [f32; BLOCK]; 3]),
}

impl DirectionBlock<'_> {
    /// Directions `at .. at + LANES` of the block as x, y and z; `at` is a multiple of the lanes.
    ///
    /// The branch goes the same way for all of a batch.
    #[inline(always)]
    pub(crate) fn load<L: Lanes>(self, lanes: L, at: usize) -> [L::F; 3] {
        let at = at & (BLOCK - L::LANES);
        match self {
            DirectionBlock::Vectors(vectors) => lanes.load_xyz(&vectors[at..][..L::LANES]),
            DirectionBlock::Columns([x, y, z]) => {
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
        let count = 2 * BLOCK + 5;
        let vectors: Vec<[f32; 3]> = (0..count).map(|i| [0.0, 0.25, 0.5].map(|part| i as f32 + part)).collect();
        let [x, y, z] = [0, 1, 2].map(|k| vectors.iter().map(|v| v[k]).collect::<Vec<f32>>());
        let layouts = [Directions::from(&vectors), Directions::columns(&x, &y, &z)];
        let lanes = lobe_scalar::Scalar::<1>;
        for at in [0, BLOCK, 2 * BLOCK] {
            for directions in layouts {
                assert_eq!(directions.count(), count);
                let mut padding = [[f32::NAN; 3]; BLOCK];
                let block = directions.block(at, &mut padding);
                for query in 0..BLOCK {
                    let found = lanes.extract_xyz(block.load(lanes, query), 0);
                    assert_eq!(found, vectors.get(at + query).copied().unwrap_or_default());
                }
                assert_eq!(directions.part(at..count).count(), count - at);
            }
        }
    }

    #[test]
    #[should_panic(expected = "components of 1, 2, 1")]
    fn columns_have_one_length() {
        Directions::Columns([&[0.0], &[0.0, 0.0], &[0.0]]).count();
    }
}
