//! Memory for the directions and values of large batches.

use std::fmt;
use std::ops::{Deref, DerefMut};

use bytemuck::Pod;

use crate::Storage;

/// A fixed number of values for long sequential reads and writes, on huge pages if the system has them.
///
/// A batch that exceeds the caches is read and written in several streams at once. On pages of 4 KB, each of them
/// stalls every 1024 floats: the processor prefetches only up to the end of a page, and then has to find the next one.
/// On huge pages, a batch of a million pairs takes hardly longer per pair than one of a few thousand. Without huge
/// pages, this is like a `Vec`.
///
/// ```
/// use lobe_memory::Buffer;
///
/// let mut values = Buffer::<f32>::zeros(1 << 20);
/// values[3] = 1.5;
/// assert_eq!(values.iter().sum::<f32>(), 1.5);
/// let directions: Buffer<[f32; 3]> = (0..1000).map(|i| [0.0, 0.001 * i as f32, 1.0]).collect();
/// assert_eq!(directions.len(), 1000);
/// ```
pub struct Buffer<T>(Storage<T>);

impl<T: Pod> Buffer<T> {
    /// `len` values of zero bits.
    ///
    /// # Panics
    /// If the size in bytes overflows `usize`.
    pub fn zeros(len: usize) -> Self {
        Buffer(Storage::zeros(len))
    }

    /// A copy of values.
    pub fn copied(values: &[T]) -> Self {
        Buffer(Storage::copied(values))
    }
}

impl<T: Pod> Deref for Buffer<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        self.0.as_slice()
    }
}

impl<T: Pod> DerefMut for Buffer<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        self.0.as_mut_slice()
    }
}

impl<T: Pod> Clone for Buffer<T> {
    fn clone(&self) -> Self {
        Buffer(self.0.clone())
    }
}

impl<T: Pod> FromIterator<T> for Buffer<T> {
    /// Values are collected first, because only then is their number known.
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Buffer::copied(&values.into_iter().collect::<Vec<T>>())
    }
}

impl<T> fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pool;

    #[test]
    fn a_buffer_is_a_slice_of_any_length() {
        let _alone = pool::alone();
        let large = if cfg!(miri) { 1000 } else { 3 << 20 };
        for len in [0, 1, 1000, large] {
            let mut buffer = Buffer::<f32>::zeros(len);
            assert!(buffer.iter().all(|&x| x == 0.0) && buffer.len() == len);
            if let Some(last) = buffer.last_mut() {
                *last = 2.0;
            }
            let collected: Buffer<f32> = buffer.iter().copied().collect();
            assert_eq!((&*buffer.clone(), &*collected), (&*buffer, &*buffer));
        }
    }
}
