//! Numbers of 64 rays side by side: what lanes work on between scalar code that gathers and scalar code that scatters.
//! There are enough of them that what scalar code wrote has reached the cache when lanes read it.

use lobe_lane::Lanes;

use crate::vec3::Vec3;

/// How many rays are side by side; every number of lanes divides it.
pub(crate) const RAYS: usize = 64;

/// A number of each of them.
pub(crate) type Column = [f32; RAYS];

pub(crate) const ZEROS: Column = [0.0; RAYS];

/// Makes room for `n` entries; those that exist already keep their values.
pub(crate) fn ensure_len<T: Clone>(entries: &mut Vec<T>, n: usize, nothing: T) {
    if entries.len() < n {
        entries.resize(n, nothing);
    }
}

/// Vectors from ray `at` on.
#[inline(always)]
pub(crate) fn load<L: Lanes>(lanes: L, columns: &[Column], at: usize) -> [L::F; 3] {
    [lanes.load(&columns[0][at..]), lanes.load(&columns[1][at..]), lanes.load(&columns[2][at..])]
}

/// Writes vectors from ray `at` on.
#[inline(always)]
pub(crate) fn store<L: Lanes>(lanes: L, columns: &mut [Column; 3], at: usize, vector: [L::F; 3]) {
    lanes.store(&mut columns[0][at..], vector[0]);
    lanes.store(&mut columns[1][at..], vector[1]);
    lanes.store(&mut columns[2][at..], vector[2]);
}

/// The vector of one ray.
#[inline(always)]
pub(crate) fn vector(columns: &[Column; 3], at: usize) -> Vec3 {
    [columns[0][at], columns[1][at], columns[2][at]]
}
