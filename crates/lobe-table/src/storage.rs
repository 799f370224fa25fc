//! Memory for texels: on cache lines, and on huge pages where there is much of it.

use std::fmt;

use memmap2::MmapMut;

use crate::texel::Stored;

/// Bytes of a cache line.
const LINE: usize = 64;

/// From this many bytes on, texels lie on huge pages where the system has them: a random look-up in a table beyond the
/// caches otherwise misses the address translation too.
const HUGE: usize = 4 << 20;

/// A fixed run of numbers whose first lies on a cache line, so that a texel never straddles two.
pub(crate) enum Storage<T> {
    Heap { buffer: Vec<T>, start: usize, len: usize },
    Pages { map: MmapMut, len: usize },
}

impl<T: Stored> Storage<T> {
    /// `len` zeros.
    pub(crate) fn zeros(len: usize) -> Self {
        let bytes = len.saturating_mul(size_of::<T>());
        if bytes >= HUGE
            && let Ok(map) = MmapMut::map_anon(bytes)
        {
            // Only a hint: without huge pages everything works, slower.
            #[cfg(target_os = "linux")]
            let _ = map.advise(memmap2::Advice::HugePage);
            return Storage::Pages { map, len };
        }
        let buffer = vec![T::default(); len + LINE / size_of::<T>()];
        let start = buffer.as_ptr().align_offset(LINE).min(buffer.len() - len);
        Storage::Heap { buffer, start, len }
    }

    #[inline(always)]
    pub(crate) fn as_slice(&self) -> &[T] {
        match self {
            Storage::Heap { buffer, start, len } => &buffer[*start..][..*len],
            Storage::Pages { map, len } => &bytemuck::cast_slice(&map[..])[..*len],
        }
    }

    pub(crate) fn as_mut_slice(&mut self) -> &mut [T] {
        match self {
            Storage::Heap { buffer, start, len } => &mut buffer[*start..][..*len],
            Storage::Pages { map, len } => &mut bytemuck::cast_slice_mut(&mut map[..])[..*len],
        }
    }

    /// Bytes of memory that this holds.
    pub(crate) fn bytes(&self) -> usize {
        match self {
            Storage::Heap { buffer, .. } => buffer.capacity() * size_of::<T>(),
            Storage::Pages { map, .. } => map.len(),
        }
    }
}

impl<T: Stored> Clone for Storage<T> {
    fn clone(&self) -> Self {
        let texels = self.as_slice();
        let mut copy = Storage::zeros(texels.len());
        copy.as_mut_slice().copy_from_slice(texels);
        copy
    }
}

impl<T: Stored> fmt::Debug for Storage<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} texels", self.as_slice().len())
    }
}
