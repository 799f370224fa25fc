//! Huge pages that storages share, because a storage smaller than a huge page would waste a whole one.
//!
//! Returned ranges are joined with free neighbours, so that storages of any size can use them again. An empty mapping
//! is returned to the system, except for one that is kept as long as others are in use. Idle pages of other mappings
//! are returned once there are many, so that one small remaining table does not keep everything around it.

use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};
use std::ptr::NonNull;
use std::slice;
use std::sync::{Mutex, PoisonError};

use memmap2::MmapMut;
#[cfg(unix)]
use memmap2::UncheckedAdvice;

use crate::{Line, map};

/// Bytes mapped at once. Pages that have not been written to take no memory.
const CHUNK: usize = if cfg!(miri) { 1 << 20 } else { 32 << 20 };
const CHUNK_LINES: usize = CHUNK / size_of::<Line>();
/// Shares consist of whole small pages, which leaves few pieces that are too small to be useful.
const PIECE: usize = 4096 / size_of::<Line>();
/// Pages go back to the system in multiples of this, of which the pages of any system are a part.
#[cfg(unix)]
const PAGES: usize = (64 << 10) / size_of::<Line>();
/// The largest number of written but unused lines that are kept before pages go back to the system: those of two
/// mappings. Reusing them is quicker than taking new ones.
const IDLE: usize = 2 * CHUNK_LINES;

/// Lines of a shared mapping, for one storage.
pub(crate) struct Share {
    lines: NonNull<Line>,
    len: usize,
}

// SAFETY: a share is the only owner of its lines, from when they are taken out of the free ranges of their mapping
// until it is dropped, so it may be sent to another thread like a `Box<[Line]>`.
unsafe impl Send for Share {}
// SAFETY: as above; a shared reference to it only reads the lines.
unsafe impl Sync for Share {}

/// The owner of the lines, kept only for its memory: after `first` has been found, nothing accesses it any more.
enum Memory {
    Map(MmapMut),
    /// For Miri, which does not support mappings.
    Heap(Vec<Line>),
}

/// A mapping from which shares are cut.
struct Chunk {
    first: NonNull<Line>,
    /// Free ranges of lines, by their starts. No two are adjacent.
    free: BTreeMap<usize, Free>,
    /// Nothing has been written from this line on, so all of these are zero.
    fresh: usize,
    #[cfg_attr(not(unix), allow(dead_code, reason = "pages go back on Unix only"))]
    memory: Memory,
}

/// A free range.
#[derive(Clone, Copy, PartialEq)]
struct Free {
    len: usize,
    /// An upper bound on the number of its lines that take memory.
    idle: usize,
}

// SAFETY: the lines that `first` points to belong to the chunk and to the shares cut from it, on any thread.
unsafe impl Send for Chunk {}

/// The oldest first.
static POOL: Mutex<Vec<Chunk>> = Mutex::new(Vec::new());

impl Chunk {
    /// `None` if the system has no memory.
    fn new() -> Option<Self> {
        let mut memory =
            if cfg!(miri) { Memory::Heap(bytemuck::zeroed_vec(CHUNK_LINES)) } else { Memory::Map(map(CHUNK)?) };
        let first = match &mut memory {
            Memory::Map(map) => NonNull::from(bytemuck::cast_slice_mut::<u8, Line>(&mut map[..])).cast(),
            Memory::Heap(lines) => NonNull::new(lines.as_mut_ptr())?,
        };
        let whole = Free { len: CHUNK_LINES, idle: 0 };
        Some(Chunk { first, free: BTreeMap::from([(0, whole)]), fresh: 0, memory })
    }

    /// Takes the first free range of this many lines.
    fn take(&mut self, len: usize) -> Option<Share> {
        let (start, room) = self.free.iter().map(|(start, room)| (*start, *room)).find(|(_, room)| room.len >= len)?;
        self.free.remove(&start);
        if room.len > len {
            let rest = room.len - len;
            // Which of its lines are idle is not known.
            self.free.insert(start + len, Free { len: rest, idle: room.idle.min(rest) });
        }
        // SAFETY: free ranges are inside the lines of the chunk, whose memory does not move.
        let lines = unsafe { self.first.add(start) };
        let mut share = Share { lines, len };
        let used = self.fresh.saturating_sub(start).min(len);
        share[..used].fill(Line::ZERO);
        self.fresh = self.fresh.max(start + len);
        Some(share)
    }

    /// The index of a line of the chunk.
    fn line(&self, at: NonNull<Line>) -> Option<usize> {
        let offset = (at.as_ptr() as usize).checked_sub(self.first.as_ptr() as usize)? / size_of::<Line>();
        (offset < CHUNK_LINES).then_some(offset)
    }

    /// Takes a range back, and joins it with its free neighbours.
    fn give_back(&mut self, mut start: usize, len: usize) -> usize {
        let mut range = Free { len, idle: len };
        let mut join = |other: Free| range = Free { len: range.len + other.len, idle: range.idle + other.idle };
        if let Some(after) = self.free.remove(&(start + len)) {
            join(after);
        }
        if let Some((&before, &room)) = self.free.range(..start).next_back()
            && before + room.len == start
        {
            join(room);
            start = before;
        }
        self.free.insert(start, range);
        start
    }

    fn is_empty(&self) -> bool {
        self.free.get(&0).is_some_and(|range| range.len == CHUNK_LINES)
    }

    /// Lines that take memory and that nobody has, at most.
    fn idle(&self) -> usize {
        self.free.values().map(|range| range.idle).sum()
    }

    /// Gives the pages of the free range at `start` back to the system.
    #[cfg(unix)]
    fn release(&mut self, start: usize) {
        let (Some(range), Memory::Map(map)) = (self.free.get_mut(&start), &self.memory) else { return };
        // Only pages that lie in it as a whole.
        let first = start.next_multiple_of(PAGES);
        let lines = ((start + range.len) / PAGES * PAGES).saturating_sub(first);
        let (offset, len) = (first * size_of::<Line>(), lines * size_of::<Line>());
        // SAFETY: the pages are part of the mapping and of a free range, whose lines nobody reads or writes until they
        // are taken again; they are then filled with zeros, whatever the system has made of them, as they are below
        // `fresh`.
        if lines > 0 && unsafe { map.unchecked_advise_range(UncheckedAdvice::DontNeed, offset, len) }.is_ok() {
            range.idle = range.len - lines;
        }
    }

    /// Only other systems can take back parts of a mapping.
    #[cfg(not(unix))]
    fn release(&mut self, _: usize) {}
}

impl Share {
    /// At least `lines` zeroed lines, which must be fewer than a mapping has; `None` if the system has no memory.
    pub fn zeros(lines: usize) -> Option<Self> {
        let len = rounded(lines);
        if len > CHUNK_LINES {
            return None;
        }
        let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(share) = pool.iter_mut().find_map(|chunk| chunk.take(len)) {
            return Some(share);
        }
        pool.push(Chunk::new()?);
        pool.last_mut()?.take(len)
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
        let found = pool.iter().enumerate().find_map(|(at, chunk)| Some((at, chunk.line(self.lines)?)));
        let Some((at, line)) = found else { return };
        let range = pool[at].give_back(line, self.len);
        if !pool[at].is_empty() {
            if pool.iter().map(Chunk::idle).sum::<usize>() > IDLE {
                pool[at].release(range);
            }
        } else {
            let empty = pool.iter().filter(|chunk| chunk.is_empty()).count();
            let gone = if empty == pool.len() {
                std::mem::take(&mut *pool)
            } else if empty > 1 {
                vec![pool.remove(at)]
            } else {
                Vec::new()
            };
            // Pages are returned after the lock is released, so that other threads do not wait.
            drop(pool);
            drop(gone);
        }
    }
}

impl Deref for Share {
    type Target = [Line];

    #[inline(always)]
    fn deref(&self) -> &[Line] {
        // SAFETY: the lines are in a mapping that lives at least as long as the share, are initialised, and are written
        // only through this share.
        unsafe { slice::from_raw_parts(self.lines.as_ptr(), self.len) }
    }
}

impl DerefMut for Share {
    fn deref_mut(&mut self) -> &mut [Line] {
        // SAFETY: as above, and the share is borrowed exclusively.
        unsafe { slice::from_raw_parts_mut(self.lines.as_ptr(), self.len) }
    }
}

/// Rounded up to whole pieces.
pub(crate) fn rounded(lines: usize) -> usize {
    lines.next_multiple_of(PIECE)
}

/// The number of mapped bytes.
#[cfg(test)]
fn mapped() -> usize {
    POOL.lock().unwrap_or_else(PoisonError::into_inner).len() * CHUNK
}

/// Tests of one process share the pool, so those that use it run one at a time.
#[cfg(test)]
pub(crate) fn alone() -> std::sync::MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fraction of the size of a mapping.
    fn part(of: usize) -> usize {
        CHUNK_LINES / 512 * of
    }

    fn take(lines: usize, mark: u8) -> Share {
        let mut share = Share::zeros(lines).expect("memory");
        assert!(share.len() >= lines && share.len() < lines + PIECE);
        assert!(share.iter().all(|line| *line == Line::ZERO));
        share.fill(Line([mark; 64]));
        share
    }

    #[test]
    fn shares_never_overlap_and_start_with_zeros() {
        let _alone = alone();
        let mut held: Vec<(u8, Share)> = Vec::new();
        // More than a mapping in total, about half of it returned again and again.
        for mark in 1..=200 {
            held.push((mark, take(part(1) + 7 + part(1) * (mark as usize % 13), mark)));
            if mark % 2 == 0 {
                held.swap_remove(held.len() / 2);
            }
        }
        for (mark, share) in &held {
            assert!(share.iter().all(|line| *line == Line([*mark; 64])));
        }
    }

    #[test]
    fn returned_lines_are_reused_in_other_sizes() {
        let _alone = alone();
        let kept = take(part(1), 1);
        let before = mapped();
        // Growing sizes, enough to fill forty mappings.
        for size in 1..200 {
            let shares: Vec<Share> = (0..2).map(|_| take(part(size), 2)).collect();
            drop(shares);
        }
        assert!(mapped() <= before + CHUNK, "{} bytes, {before} before", mapped());
        assert!(kept.iter().all(|line| *line == Line([1; 64])));
    }

    #[test]
    fn unused_mappings_are_returned_to_the_system() {
        let _alone = alone();
        let shares: Vec<Share> = (0..40).map(|mark| take(part(100), mark)).collect();
        assert!(mapped() >= 8 * CHUNK);
        drop(shares);
        assert_eq!(mapped(), 0);
    }
}
