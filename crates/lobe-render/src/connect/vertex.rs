//! The surfaces of light paths that are kept.

use super::Mis;
use crate::place::Place;
use crate::transport::Transport;
use crate::vec3::Vec3;

/// A surface that a light path has met, and the light that it brings there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightVertex<T: Transport> {
    pub place: Place,
    /// The direction back along the path, in the frame of the material.
    pub wo: Vec3,
    /// The power that arrives, per path, in W.
    pub flux: T::Spectrum,
    pub mis: Mis,
    pub material: u32,
    /// Number of surfaces that the path has met, including this one.
    pub surfaces: u32,
}

/// The contribution of a light path to the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SplatAt<T: Transport> {
    /// Its position, in pixels.
    pub raster: [f32; 2],
    pub radiance: T::Radiance,
}

/// The light paths that one job has followed.
#[derive(Clone, Debug)]
pub(crate) struct LightPart<T: Transport> {
    /// The surfaces of one path after another, each in the order in which it met them.
    pub vertices: Vec<LightVertex<T>>,
    /// Where the surfaces of each path begin, and the end.
    pub starts: Vec<u32>,
    pub splats: Vec<SplatAt<T>>,
}

impl<T: Transport> Default for LightPart<T> {
    fn default() -> Self {
        LightPart { vertices: Vec::new(), starts: vec![0], splats: Vec::new() }
    }
}

impl<T: Transport> LightPart<T> {
    /// Sorts the surfaces of `paths` paths, which have been found one depth after another; `slots` says to which path
    /// each belongs.
    pub fn sorted(paths: usize, slots: &[u32], found: &[LightVertex<T>]) -> Self {
        let mut starts = vec![0u32; paths + 1];
        for &slot in slots {
            starts[slot as usize + 1] += 1;
        }
        for path in 0..paths {
            starts[path + 1] += starts[path];
        }
        let mut next = starts.clone();
        let mut order = vec![0u32; found.len()];
        for (at, &slot) in slots.iter().enumerate() {
            order[next[slot as usize] as usize] = at as u32;
            next[slot as usize] += 1;
        }
        let vertices = order.iter().map(|&at| found[at as usize]).collect();
        LightPart { vertices, starts, splats: Vec::new() }
    }

    /// The surfaces of a path.
    pub fn path(&self, path: usize) -> &[LightVertex<T>] {
        match self.starts.get(path..path + 2) {
            Some(&[begin, end]) => &self.vertices[begin as usize..end as usize],
            _ => &[],
        }
    }
}
