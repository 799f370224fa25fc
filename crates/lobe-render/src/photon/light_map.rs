//! Collects all light paths of a pass.

use super::map::Photons;
use crate::connect::{LightPart, LightVertex};
use crate::transport::Transport;

/// The light paths of a pass, and the places where their light has arrived.
#[derive(Clone, Debug)]
pub(crate) struct LightMap<T: Transport> {
    /// Parts with the same number of paths in each, except for the last.
    pub parts: Vec<LightPart<T>>,
    /// Number of paths in a part.
    pub paths: usize,
    pub photons: Photons<T>,
}

impl<T: Transport> LightMap<T> {
    /// The surfaces that a path has met.
    pub fn path(&self, path: u32) -> &[LightVertex<T>] {
        let path = path as usize;
        self.parts.get(path / self.paths).map_or(&[], |part| part.path(path % self.paths))
    }
}
