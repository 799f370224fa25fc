//! The nodes at which a surface is measured.

use lobe_formats::mbsdf::UNIFORM_HALF;
use lobe_model::goniometer::half_diff as bins;
use lobe_model::goniometer::mueller::knots as half_and_difference;
use lobe_model::goniometer::rgl::Resolution;
use lobe_model::goniometer::spherical::uniform_half;
use lobe_model::goniometer::tensor_tree::{self, Refinement};
use lobe_model::goniometer::utia::LIGHTS;
use lobe_table::utia::{PHIS, THETAS};
use lobe_table::window::Block;
use lobe_table::window::klems::{self, AngleBasis};
use lobe_table::window::tensor_tree::Rank;
use lobe_table::{Kind, Scatter, half_diff, mueller, polarised, rgl, specular, spherical, utia};

/// The sides on which a surface has values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// One scatter.
    One(Scatter),
    /// The surface distinguishes the sides.
    Both,
}

impl Sides {
    /// The blocks of a sheet that have values.
    pub fn blocks(self) -> Vec<Block> {
        let is_there = |block: &Block| match self {
            Sides::Both => true,
            Sides::One(scatter) => block.aspect().scatter == scatter,
        };
        Block::ALL.into_iter().filter(is_there).collect()
    }
}

/// The nodes of a representation.
#[derive(Clone, Debug, PartialEq)]
pub enum Nodes {
    /// Knots of sigma, psi, theta and phi, in radians.
    Specular([Vec<f64>; 4]),
    /// The same, for Mueller matrices.
    Polarised([Vec<f64>; 4]),
    /// Knots of `phi_d`, `theta_d` and `theta_h`, in radians, for Mueller matrices.
    Mueller([Vec<f64>; 3]),
    /// The grid of the UTIA database.
    Utia,
    /// Bins of theta_h, theta_d and phi_d.
    HalfDiff([usize; 3]),
    /// Directions of the light and texels.
    Rgl(Resolution),
    /// Patches of both directions.
    Klems(AngleBasis),
    /// Leaves of trees.
    Tree(Refinement),
    /// Knots of `theta_i`, `phi_i`, `theta_o` and `phi_o`, in radians.
    Spherical {
        /// The knots.
        knots: [Vec<f64>; 4],
        /// `true` if the other half, across the plane of incidence, is the mirror image: see
        /// [`spherical::Data::mirrored`].
        is_half: bool,
    },
}

impl Nodes {
    /// Nodes of a representation that suit most materials; `None` if it cannot be measured.
    pub fn of(kind: Kind, is_isotropic: bool) -> Option<Self> {
        match kind {
            specular::KIND => Some(Nodes::Specular(knots(is_isotropic))),
            polarised::KIND => Some(Nodes::Polarised(knots(is_isotropic))),
            mueller::KIND if is_isotropic => Some(Nodes::Mueller(half_and_difference())),
            utia::KIND => Some(Nodes::Utia),
            half_diff::KIND if is_isotropic => Some(Nodes::HalfDiff(bins::MERL)),
            rgl::KIND if is_isotropic => Some(Nodes::Rgl(Resolution::ISOTROPIC)),
            rgl::KIND => Some(Nodes::Rgl(Resolution::ANISOTROPIC)),
            klems::KIND => Some(Nodes::Klems(AngleBasis::full())),
            spherical::KIND => Some(Nodes::Spherical { knots: spherical_knots(is_isotropic), is_half: false }),
            UNIFORM_HALF if is_isotropic => {
                Some(Nodes::Spherical { knots: uniform_half(UNIFORM[0], UNIFORM[1]), is_half: true })
            }
            _ => None,
        }
    }

    /// The number of progress reports.
    pub fn steps(&self, sides: Sides) -> usize {
        match self {
            Nodes::Specular([sigma, psi, ..]) | Nodes::Polarised([sigma, psi, ..]) => sigma.len() * psi.len(),
            Nodes::Mueller([turns, ..]) => turns.len(),
            Nodes::Utia => LIGHTS,
            Nodes::HalfDiff([halves, ..]) => *halves,
            Nodes::Rgl(resolution) => resolution.steps(),
            Nodes::Klems(basis) => sides.blocks().len() * basis.patches(),
            Nodes::Tree(refinement) => sides.blocks().len() * tensor_tree::steps(*refinement),
            Nodes::Spherical { knots: [theta, phi, ..], .. } => theta.len() * phi.len(),
        }
    }

    /// `true` if the values at the nodes are Mueller matrices.
    pub fn are_of_matrices(&self) -> bool {
        matches!(self, Nodes::Polarised(_) | Nodes::Mueller(_))
    }

    /// The number of values per channel, as factors.
    pub fn counts(&self) -> Vec<usize> {
        match self {
            Nodes::Specular(knots) => knots.iter().map(Vec::len).collect(),
            Nodes::Polarised(knots) => knots.iter().map(Vec::len).chain([ELEMENTS]).collect(),
            Nodes::Mueller(knots) => knots.iter().map(Vec::len).chain([ELEMENTS]).collect(),
            Nodes::Utia => vec![THETAS, PHIS, THETAS, PHIS],
            Nodes::HalfDiff(bins) => bins.to_vec(),
            Nodes::Rgl(Resolution { theta_i, phi_i, spectra, .. }) => vec![*theta_i, *phi_i, *spectra, *spectra],
            Nodes::Klems(basis) => vec![Block::ALL.len(), basis.patches(), basis.patches()],
            // Cells of one block at most, so that there is room for the leaves of all. Of the radii half are in use.
            Nodes::Tree(Refinement { rank: Rank::Three, depth, .. }) => vec![(1 << (3 * depth)) / 2],
            Nodes::Tree(Refinement { depth, .. }) => vec![1 << (4 * depth)],
            Nodes::Spherical { knots, .. } => knots.iter().map(Vec::len).collect(),
        }
    }
}

/// The elements of a Mueller matrix.
const ELEMENTS: usize = 16;

const SIGMA: &[f64] =
    &[0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 84.0, 88.0];
const SIGMA_COARSE: &[f64] = &[0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 68.0, 75.0, 82.0, 88.0];
const THETA: &[f64] = &[
    0.0, 0.5, 1.0, 2.0, 3.0, 4.5, 6.0, 8.0, 10.0, 12.5, 15.0, 18.0, 21.0, 25.0, 30.0, 35.0, 40.0, 46.0, 52.0, 60.0,
    68.0, 76.0, 85.0, 95.0, 105.0, 120.0, 135.0, 150.0, 165.0, 180.0,
];

/// Knots of a table in specular coordinates that suit most materials, in radians.
pub fn knots(is_isotropic: bool) -> [Vec<f64>; 4] {
    let every_15: Vec<f64> = (0..=24).map(|step| 15.0 * f64::from(step)).collect();
    let degrees = [
        if is_isotropic { SIGMA } else { SIGMA_COARSE }.to_vec(),
        if is_isotropic { vec![0.0] } else { every_15.clone() },
        THETA.to_vec(),
        every_15,
    ];
    degrees.map(|axis| axis.into_iter().map(f64::to_radians).collect())
}

/// Zenith angles and azimuths of uniform half grids that suit most materials: every degree, and every two.
const UNIFORM: [usize; 2] = [90, 91];

/// Knots of a grid in spherical coordinates that suit most materials, in radians: every 5 degrees of incidence, every
/// 2.5 of exit. Peaks lie across such grids, which need more nodes than specular ones.
pub fn spherical_knots(is_isotropic: bool) -> [Vec<f64>; 4] {
    let steps = |count: u32, step: f64| (0..=count).map(|index| step * f64::from(index)).collect::<Vec<f64>>();
    let degrees = match is_isotropic {
        true => [SIGMA.to_vec(), vec![0.0], steps(36, 2.5), steps(72, 5.0)],
        false => [SIGMA_COARSE.to_vec(), steps(24, 15.0), steps(18, 5.0), steps(24, 15.0)],
    };
    degrees.map(|axis| axis.into_iter().map(f64::to_radians).collect())
}
