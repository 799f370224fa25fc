//! [`Representation`] for sheets.

use super::blocks::{Block, Component};
use super::data::{Band, Data};
use super::klems::{self, AngleBasis, Ring};
use super::tensor_tree::{self, Rank};
use crate::bsdf::Bsdf;
use crate::data::{Options, PrepareError, Section};
use crate::{Aspect, Channels, Kind, Representation};

impl Representation for Data {
    /// Klems matrices, or tensor trees if there is any.
    fn kind(&self) -> Kind {
        let has_tree = self.components().any(|component| matches!(component, Component::Tree(_)));
        if has_tree { tensor_tree::KIND } else { klems::KIND }
    }

    fn channels(&self) -> Channels {
        Channels::Named(self.bands.iter().map(|band| band.wavelength.clone()).collect())
    }

    fn aspects(&self) -> Vec<Aspect> {
        let is_there = |block: &Block| self.bands.iter().any(|band| band.window.block(*block).is_some());
        Block::ALL.into_iter().filter(is_there).map(Block::aspect).collect()
    }

    fn is_isotropic(&self) -> bool {
        self.components().all(|component| match component {
            Component::Klems(_) => false,
            Component::Tree(tree) => tree.rank() == Rank::Three,
        })
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let mut sections = Vec::new();
        for band in &self.bands {
            for block in Block::ALL {
                let Some(component) = band.window.block(block) else { continue };
                let (kind, values) = match component {
                    Component::Klems(matrix) => (klems::KIND, matrix.values()),
                    Component::Tree(tree) => (tensor_tree::KIND, tree.values()),
                };
                let channels = Channels::Named(vec![band.wavelength.clone()]);
                let section = Section::new(kind, block.aspect(), channels, values);
                let name = format!("{} {}", band.wavelength, block.aspect());
                // The sides of WINDOW files have other names.
                let section = Section { name, ..section }.with_fact("block", format!("{} in the file", block.name()));
                sections.push(match component {
                    Component::Klems(matrix) => {
                        let [from, to] = [matrix.incident(), matrix.exit()]
                            .map(|basis| format!("{} ({} patches)", basis.name(), basis.patches()));
                        section.with_fact("bases", format!("{from} to {to}"))
                    }
                    Component::Tree(tree) => {
                        let (nodes, dimensions) = (tree.nodes().len(), tree.rank().dimensions());
                        section.with_fact("tree", format!("{nodes} nodes in {dimensions} dimensions"))
                    }
                });
            }
        }
        sections
    }

    #[cfg(feature = "window")]
    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        super::prepared::prepare(self, options)
    }

    /// The middles of the rings of Klems matrices, at azimuth 0.
    fn incidences(&self, aspect: Aspect) -> Vec<[f64; 2]> {
        let block = Block::of_aspect(aspect);
        let found = self.bands.iter().find_map(|band| {
            // A missing transmission block is replaced by the other one with the directions exchanged.
            let stand_in = block.reverse().and_then(|reverse| band.window.block(reverse));
            band.window.block(block).or(stand_in)
        });
        match found {
            Some(Component::Klems(matrix)) => middles(matrix.incident()),
            Some(Component::Tree(_)) | None => Vec::new(),
        }
    }

    /// The sum over the patches of Klems matrices or the cells of trees, unless transmission is known only in the other
    /// direction.
    fn albedo(&self, aspect: Aspect, [theta, phi]: [f64; 2]) -> Option<Vec<f64>> {
        // The patch is found by the direction in which light travels.
        let travels = [-theta.sin() * phi.cos(), -theta.sin() * phi.sin(), theta.cos()];
        let of_band = |band: &Band| match band.window.block(Block::of_aspect(aspect))? {
            Component::Klems(matrix) => matrix.incident().patch(travels).map(|patch| matrix.albedo(patch)),
            Component::Tree(tree) => Some(tree.albedo(travels.map(|c| -c))),
        };
        self.bands.iter().map(of_band).collect()
    }
}

/// The middles of the rings of a basis in radians; the first ring is a cap about the normal.
fn middles(basis: &AngleBasis) -> Vec<[f64; 2]> {
    let middle = |ring: &Ring| match ring.lower {
        lower if lower < 1e-3 => 0.0,
        lower => (0.5 * (lower + ring.upper)).to_radians(),
    };
    basis.rings().iter().map(|ring| [middle(ring), 0.0]).collect()
}
