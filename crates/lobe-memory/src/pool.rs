//! Huge pages that storages share: a storage smaller than a huge page would waste one of its own.
//!
//! Freed memory is kept for the next storage of about that size and is never returned to the system.

use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};
use std::sync::{Mutex, PoisonError};

use crate::{Line, map};

/// Bytes mapped at once. Pages that have not been written to take no memory.
const CHUNK: usize = 32 << 20;

/// Lines of a shared mapping, for one storage.
pub(crate) struct Share(&'static mut [Line]);

struct Pool {
    /// Freed lines, by their number.
    free: BTreeMap<usize, Vec<&'static mut [Line]>>,
    /// What is left of the last mapping.
    rest: &'static mut [Line],
}

static POOL: Mutex<Pool> = Mutex::new(Pool { free: BTreeMap::new(), rest: &mut [] });

impl Share {
    /// At least `lines` zeroed lines, which must be far fewer than a mapping has; `None` if the system has no memory.
    pub fn zeros(lines: usize) -> Option<Self> {
        let len = rounded(lines);
        let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(used) = pool.free.get_mut(&len).and_then(Vec::pop) {
            drop(pool);
            used.fill(Line::ZERO);
            return Some(Share(used));
        }
        if pool.rest.len() < len {
            // Leaked for good: safe code can hand out parts of a mapping only if it is never unmapped.
            pool.rest = bytemuck::cast_slice_mut(&mut Box::leak(Box::new(map(CHUNK)?))[..]);
        }
        let (share, rest) = std::mem::take(&mut pool.rest).split_at_mut_checked(len)?;
        pool.rest = rest;
        Some(Share(share))
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        let lines = std::mem::take(&mut self.0);
        let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
        pool.free.entry(lines.len()).or_default().push(lines);
    }
}

impl Deref for Share {
    type Target = [Line];

    #[inline(always)]
    fn deref(&self) -> &[Line] {
        self.0
    }
}

impl DerefMut for Share {
    fn deref_mut(&mut self) -> &mut [Line] {
        self.0
    }
}

/// Rounded up to one of eight lengths between powers of two, so that there are few different lengths.
pub(crate) fn rounded(lines: usize) -> usize {
    lines.next_multiple_of((lines.next_power_of_two() / 16).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_never_overlap_and_begin_with_zeros() {
        let take = |lines: usize, mark: u8| {
            let mut share = Share::zeros(lines).expect("memory");
            assert!(share.len() >= lines && share.len() <= lines + lines / 8);
            assert!(share.iter().all(|line| *line == Line::ZERO));
            share.fill(Line([mark; 64]));
            share
        };
        let mut held: Vec<(u8, Share)> = Vec::new();
        // More than a mapping in all, about half of it given back again and again.
        for mark in 1..=200 {
            held.push((mark, take(1000 + 977 * (mark as usize % 13), mark)));
            if mark % 2 == 0 {
                held.swap_remove(held.len() / 2);
            }
        }
        for (mark, share) in &held {
            assert!(share.iter().all(|line| *line == Line([*mark; 64])));
        }
    }

    #[test]
    fn what_is_given_back_is_taken_again() {
        // No other test asks for this many.
        let lines = 50_000;
        let first = Share::zeros(lines).expect("memory").as_ptr();
        assert_eq!(Share::zeros(lines - 1).expect("memory").as_ptr(), first);
    }
}
