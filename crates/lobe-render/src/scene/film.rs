//! Thin films on materials: `model = "film"`, and the table `film` of a mirror, a glass or a rough conductor.

use std::sync::Arc;

use lobe_model::Film;
use lobe_spectrum::Metal;

use super::Reading;
use super::index::{Index, glass};
use super::node::{Node, SceneError};
use crate::shader::FilmTable;
use crate::transport::Transport;

/// A film by its index and its thickness in nm.
pub(super) struct Coat {
    index: Index,
    thickness: f64,
}

/// The medium behind a film.
pub(super) enum Behind<'a> {
    /// Air: the film is free.
    Air,
    /// Glass of this index.
    Glass(f64),
    /// A metal.
    Metal(&'a Metal),
}

impl Coat {
    /// The keys of a film, in its own table or in that of the material.
    pub fn read(node: &Node<'_, '_>) -> Result<Self, SceneError> {
        let expected = "a thickness in nm from 1 to 5000";
        let thickness = node.number("thickness", expected, |x| (1.0..=5000.0).contains(&x))?;
        let thickness =
            thickness.ok_or_else(|| node.error("thickness", format!("found nothing; expected {expected}")))?;
        Ok(Coat { index: glass(node)?, thickness })
    }

    /// The film of a material that may have one.
    pub fn of(node: &Node<'_, '_>) -> Result<Option<Self>, SceneError> {
        let Some(table) = node.child("film")? else { return Ok(None) };
        let coat = Coat::read(&table)?;
        table.finish()?;
        Ok(Some(coat))
    }

    /// The effect of the film on light of a picture.
    pub fn table<T: Transport>(&self, reading: &Reading<'_, T>, behind: &Behind<'_>) -> Arc<FilmTable<T::Spectrum>> {
        let film = |nm: f64| {
            let film = match &self.index {
                Index::Constant(index) => *index,
                // Formulas are for glasses, and mean nothing far from visible light.
                Index::Formula(glass) => glass.index(nm).clamp(1.0, 5.0),
            };
            let thickness = self.thickness / nm;
            let behind = match behind {
                Behind::Air => [1.0, 0.0],
                Behind::Glass(index) => [*index, 0.0],
                Behind::Metal(metal) => [metal.n.at(nm), metal.k.at(nm)],
            };
            let from_behind = Film { front: behind[0], film, behind: [1.0, 0.0], thickness };
            [Film { front: 1.0, film, behind, thickness }, from_behind]
        };
        Arc::new(FilmTable::new::<T>(reading.world.basis(), film))
    }
}
