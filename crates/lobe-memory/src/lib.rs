//! Memory for random lookups and for large batches: aligned to cache lines, and on huge pages, which small tables
//! share.
//!
//! `unsafe` occurs only in `pool.rs`: parts of one mapping belong to different storages, which no safe type can
//! express.
#![deny(unsafe_code)]

mod buffer;
#[allow(unsafe_code, reason = "parts of a mapping for different owners")]
mod pool;
mod room;

use std::fmt;
use std::marker::PhantomData;

use bytemuck::{Pod, Zeroable};
use memmap2::MmapMut;

pub use buffer::Buffer;
use pool::Share;
pub use room::{NoRoom, available, require};

/// Memory of at least this many bytes is on huge pages if the system has them: a random lookup beyond the caches would
/// otherwise also miss the address translation. One table alone is small, but scenes have many.
const SHARED: usize = 64 << 10;
/// A storage of at least this many bytes has its own pages.
const ALONE: usize = 4 << 20;

/// A cache line.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
struct Line([u8; 64]);

impl Line {
    const ZERO: Line = Line([0; 64]);
}

enum Place {
    Heap(Vec<Line>),
    Shared(Share),
    Alone(MmapMut),
}

/// A fixed number of values, the first on a cache line, so that a value whose size divides that of a line never
/// straddles two.
pub struct Storage<T> {
    place: Place,
    len: usize,
    values: PhantomData<T>,
}

impl<T: Pod> Storage<T> {
    /// `len` values of zero bits.
    ///
    /// # Panics
    /// If the size in bytes overflows `usize`.
    pub fn zeros(len: usize) -> Self {
        let (bytes, lines) = Self::size(len);
        let place = match bytes {
            ALONE.. => map(bytes).map(Place::Alone),
            SHARED.. => Share::zeros(lines).map(Place::Shared),
            _ => None,
        };
        let place = place.unwrap_or_else(|| Place::Heap(bytemuck::zeroed_vec(lines)));
        Storage { place, len, values: PhantomData }
    }

    /// Bytes of memory that a storage of `len` values holds, at most.
    ///
    /// # Panics
    /// If the size in bytes overflows `usize`.
    pub fn bytes_for(len: usize) -> usize {
        let (bytes, lines) = Self::size(len);
        let lines = if (SHARED..ALONE).contains(&bytes) { pool::rounded(lines) } else { lines };
        lines * size_of::<Line>()
    }

    /// The bytes of `len` values, and the number of lines that they occupy.
    fn size(len: usize) -> (usize, usize) {
        let bytes = len.checked_mul(size_of::<T>()).expect("a size in bytes");
        (bytes, bytes.div_ceil(size_of::<Line>()))
    }

    /// A copy of values.
    pub fn copied(values: &[T]) -> Self {
        let mut copy = Storage::zeros(values.len());
        copy.as_mut_slice().copy_from_slice(values);
        copy
    }

    /// All values.
    #[inline(always)]
    pub fn as_slice(&self) -> &[T] {
        let bytes = match &self.place {
            Place::Heap(lines) => bytemuck::cast_slice(lines),
            Place::Shared(lines) => bytemuck::cast_slice(lines),
            Place::Alone(map) => &map[..],
        };
        bytemuck::cast_slice(&bytes[..self.len * size_of::<T>()])
    }

    /// All values, mutable.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        let bytes = match &mut self.place {
            Place::Heap(lines) => bytemuck::cast_slice_mut(lines),
            Place::Shared(lines) => bytemuck::cast_slice_mut(lines),
            Place::Alone(map) => &mut map[..],
        };
        bytemuck::cast_slice_mut(&mut bytes[..self.len * size_of::<T>()])
    }

    /// Bytes of memory that this holds.
    pub fn bytes(&self) -> usize {
        match &self.place {
            Place::Heap(lines) => size_of_val(lines.as_slice()),
            Place::Shared(lines) => size_of_val(&lines[..]),
            Place::Alone(map) => map.len(),
        }
    }
}

impl<T: Pod> Clone for Storage<T> {
    fn clone(&self) -> Self {
        Storage::copied(self.as_slice())
    }
}

impl<T> fmt::Debug for Storage<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} values", self.len)
    }
}

/// Zeroed memory from the system, on huge pages if it has them.
fn map(bytes: usize) -> Option<MmapMut> {
    // Miri does not support mappings; the heap serves as well.
    if cfg!(miri) {
        return None;
    }
    let map = MmapMut::map_anon(bytes).ok()?;
    // Only a hint: without huge pages everything works, slower.
    #[cfg(target_os = "linux")]
    let _ = map.advise(memmap2::Advice::HugePage);
    Some(map)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_start_on_a_cache_line_for_any_length() {
        let _alone = pool::alone();
        let edges = if cfg!(miri) { [SHARED, 2 * SHARED] } else { [SHARED, ALONE] };
        let edges = edges.into_iter().flat_map(|bytes| [bytes / 4 - 1, bytes / 4, bytes / 4 + 1]);
        for len in [0, 1, 15, 16, 17, 1000].into_iter().chain(edges) {
            let mut storage = Storage::<f32>::zeros(len);
            assert_eq!(storage.as_slice().len(), len);
            assert!(storage.as_slice().iter().all(|&x| x.to_bits() == 0));
            assert_eq!(storage.as_slice().as_ptr() as usize % 64, 0, "{len} values");
            assert!((4 * len..=Storage::<f32>::bytes_for(len)).contains(&storage.bytes()), "{len} values");
            if let Some(last) = storage.as_mut_slice().last_mut() {
                *last = 1.5;
            }
            assert_eq!(storage.clone().as_slice(), storage.as_slice());
        }
    }

    #[test]
    fn values_may_be_larger_than_a_line() {
        let values: Vec<[f32; 80]> = (0..100).map(|i| [i as f32; 80]).collect();
        assert_eq!(Storage::copied(&values).as_slice(), values);
    }
}
