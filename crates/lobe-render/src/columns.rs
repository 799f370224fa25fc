//! Numbers of 64 rays side by side, on which lanes work between gathering and scattering by scalar code. Columns are
//! long enough that the numbers written by scalar code have reached the cache when lanes read them.

use lobe_lane::Lanes;

use crate::vec3::Vec3;

/// Number of rays side by side; every number of lanes divides it.
pub(crate) const RAYS: usize = 64;

/// One number for each of the rays.
pub(crate) type Column = [f32; RAYS];

pub(crate) const ZEROS: Column = [0.0; RAYS];

/// Makes room for `n` entries; existing entries keep their values.
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
