//! Measures any material or model at the nodes of a format with another representation, for writing it if its values
//! cannot be kept.

mod nodes;
mod refine;
mod sheet;
mod surface;
mod words;

use lobe_formats::Document;
use lobe_model::Surface;
use lobe_model::goniometer::{half_diff, klems, measure_surface, mueller, rgl, spherical, tensor_tree, utia};
use lobe_table::window::Component;
use lobe_table::window::klems::KlemsError;
use lobe_table::window::tensor_tree::TreeError;
use lobe_table::{Data, GridError, Invalid, Scatter};
use thiserror::Error;

use crate::matrices::{depolarising, to_half_difference, to_specular};

pub use nodes::{Nodes, Sides, knots, spherical_knots};
pub use refine::{Refined, refine};
pub use surface::{Lifted, Mapped, MaterialSurface};

/// A surface that could not be measured.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RemeasureError {
    /// The knots do not form a table.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The channels or the values are not those of the representation.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// A mean over patches that is not finite.
    #[error(transparent)]
    Klems(#[from] KlemsError),
    /// A value of a leaf that is not finite.
    #[error(transparent)]
    Tree(#[from] TreeError),
}

/// Measures a surface at nodes, and returns a document that a format with such nodes can hold. `progress` is called
/// [`Nodes::steps`] times.
///
/// At nodes for Mueller matrices, surfaces are ideal depolarisers, as their polarisation is not known;
/// [`resampled_matrices`] keeps it.
///
/// Within a degree of the horizon, a material from a file (`is_from_file`) may have any value, because many formats
/// store values that have to be divided by the cosine; so it is never evaluated there. Models are exact.
///
/// # Errors
/// [`RemeasureError`] if the surface has no values for such nodes.
pub fn remeasure(
    surface: &dyn Surface,
    is_from_file: bool,
    sides: Sides,
    nodes: &Nodes,
    progress: impl Fn() + Sync,
) -> Result<Document, RemeasureError> {
    // The images of RGL hold f cos.
    let lifted = Lifted(surface);
    let near: &dyn Surface = if is_from_file { &lifted } else { surface };
    let scatter = match sides {
        Sides::One(scatter) => scatter,
        Sides::Both => Scatter::Reflection,
    };
    Ok(match nodes {
        Nodes::Specular(knots) => Document::new(measure_surface(near, scatter, knots.clone(), progress)?),
        Nodes::Polarised(knots) => {
            Document::new(depolarising(&measure_surface(near, scatter, knots.clone(), progress)?)?)
        }
        Nodes::Mueller(knots) => Document::new(mueller::measure(near, knots, progress)?),
        Nodes::Utia => Document::new(utia::measure(near, progress)?),
        Nodes::HalfDiff(bins) => Document::new(half_diff::measure(near, *bins, progress)?),
        Nodes::Rgl(resolution) => Document::new(rgl::measure(surface, *resolution, progress)?),
        Nodes::Klems(basis) => {
            let matrices = |block, progress: &(dyn Fn() + Sync)| {
                let matrices = klems::measure(near, [basis, basis], block, progress)?;
                Ok::<_, RemeasureError>(matrices.into_iter().map(Component::Klems).collect())
            };
            Document::new(sheet::measure(near.channels(), sides, &progress, matrices)?)
        }
        Nodes::Tree(refinement) => {
            let trees = |block, progress: &(dyn Fn() + Sync)| {
                let trees = tensor_tree::measure(near, *refinement, block, progress)?;
                Ok::<_, RemeasureError>(trees.into_iter().map(Component::Tree).collect())
            };
            Document::new(sheet::measure(near.channels(), sides, &progress, trees)?)
        }
        Nodes::Spherical { knots, is_half } => {
            Document::new(spherical::measure(near, scatter, knots.clone(), *is_half, progress)?)
        }
    })
}

/// The matrices of a document at other nodes for matrices; `None` if it has none, or the nodes are for values.
///
/// # Errors
/// [`RemeasureError`] if the knots do not form a grid.
pub fn resampled_matrices(document: &Document, nodes: &Nodes) -> Result<Option<Document>, RemeasureError> {
    Ok(match (document.only(), nodes) {
        (Some(Data::Mueller(data)), Nodes::Polarised(knots)) => Some(Document::new(to_specular(data, knots.clone())?)),
        (Some(Data::Polarised(data)), Nodes::Mueller(knots)) => Some(Document::new(to_half_difference(data, knots)?)),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use lobe::{Material, Options};
    use lobe_formats::mbsdf::UNIFORM_HALF;
    use lobe_model::goniometer::tensor_tree::Refinement;
    use lobe_model::{Lambert, Rgb};
    use lobe_table::window::klems::{self, AngleBasis};
    use lobe_table::window::tensor_tree::{self, Rank};
    use lobe_table::{half_diff, rgl, specular, spherical, utia};

    use super::*;

    #[test]
    fn a_lambertian_surface_is_one_at_all_nodes() {
        let surface = Rgb(Lambert { albedo: [0.2, 0.4, 0.6] });
        let tree = Nodes::Tree(Refinement { rank: Rank::Three, depth: 4, error: 0.05 });
        let kinds =
            [specular::KIND, half_diff::KIND, rgl::KIND, klems::KIND, spherical::KIND, UNIFORM_HALF, utia::KIND];
        let nodes = kinds.map(|kind| (kind, Nodes::of(kind, true).expect("a kind with nodes")));
        for (kind, nodes) in nodes.into_iter().chain([(tensor_tree::KIND, tree)]) {
            let nodes = match nodes {
                Nodes::Rgl(resolution) => Nodes::Rgl(lobe_model::goniometer::rgl::Resolution {
                    theta_i: 5,
                    ndf: 32,
                    microfacets: 16,
                    spectra: 12,
                    ..resolution
                }),
                Nodes::Klems(_) => Nodes::Klems(AngleBasis::quarter()),
                Nodes::HalfDiff(_) => Nodes::HalfDiff([9, 9, 18]),
                nodes => nodes,
            };
            // With so few nodes, the error between those of an EPFL file, which blends the quotient of values and a
            // density, is 3 %.
            let bound = if kind == rgl::KIND { 0.04 } else { 2e-3 };
            let steps = AtomicUsize::new(0);
            let sides = Sides::One(Scatter::Reflection);
            let document = remeasure(&surface, false, sides, &nodes, || {
                steps.fetch_add(1, Ordering::Relaxed);
            });
            assert_eq!(steps.into_inner(), nodes.steps(sides), "{kind}");
            let material = Material::from_document(&document.expect("finite values"), &Options::default());
            let material = material.unwrap_or_else(|error| panic!("{kind}: {error}"));
            let mut f = [0.0; 3];
            material.eval([0.6, 0.0, 0.8], [0.0, 0.6, 0.8], &mut f);
            for (found, albedo) in f.into_iter().zip([0.2, 0.4, 0.6]) {
                let expected = albedo / std::f32::consts::PI;
                assert!((found / expected - 1.0).abs() < bound, "{kind}: {found}, not {expected}");
            }
        }
    }
}
