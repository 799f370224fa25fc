//! Batches of directions in memory: an array of structures, or a structure of arrays.

use lobe_lane::{Lanes, MAX_LANES};

/// Unit vectors, one a query.
pub trait Directions: Copy {
    /// How many there are.
    fn count(&self) -> usize;

    /// Directions `at .. at + LANES` as x, y and z; zero vectors beyond the last.
    fn load<L: Lanes>(&self, lanes: L, at: usize) -> [L::F; 3];
}

impl Directions for &[[f32; 3]] {
    fn count(&self) -> usize {
        self.len()
    }

    #[inline(always)]
    fn load<L: Lanes>(&self, lanes: L, at: usize) -> [L::F; 3] {
        if let Some(whole) = <[_]>::get(self, at..at + L::LANES) {
            return lanes.load_xyz(whole);
        }
        let mut padded = [[0.0; 3]; MAX_LANES];
        for (target, direction) in padded.iter_mut().zip(self.iter().skip(at)) {
            *target = *direction;
        }
        lanes.load_xyz(&padded)
    }
}

/// Directions as separate slices of x, y and z, which are equally long.
#[derive(Clone, Copy, Debug)]
pub struct Soa<'a> {
    xyz: [&'a [f32]; 3],
}

impl<'a> Soa<'a> {
    /// Directions from their components.
    ///
    /// # Panics
    /// Where the slices differ in length.
    pub fn new(x: &'a [f32], y: &'a [f32], z: &'a [f32]) -> Self {
        assert!(x.len() == y.len() && y.len() == z.len(), "components of {}, {}, {}", x.len(), y.len(), z.len());
        Soa { xyz: [x, y, z] }
    }
}

impl Directions for Soa<'_> {
    fn count(&self) -> usize {
        self.xyz[0].len()
    }

    #[inline(always)]
    fn load<L: Lanes>(&self, lanes: L, at: usize) -> [L::F; 3] {
        let [x, y, z] = self.xyz;
        [lanes.load_partial(&x[at..]), lanes.load_partial(&y[at..]), lanes.load_partial(&z[at..])]
    }
}
