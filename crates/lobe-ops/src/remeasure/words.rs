//! Nodes in words.

use std::fmt;

use lobe_model::goniometer::rgl::Resolution;
use lobe_model::goniometer::tensor_tree::Refinement;

use super::Nodes;

/// For people, such as `7 sigma x 1 psi x 8 theta x 13 phi`.
impl fmt::Display for Nodes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Nodes::Utia => f.write_str("the grid of the UTIA database, up to 75 degrees"),
            Nodes::Mueller(knots) => {
                let [turns, differences, halves] = knots.each_ref().map(Vec::len);
                write!(f, "{turns} phi_d x {differences} theta_d x {halves} theta_h")
            }
            Nodes::Specular(knots) | Nodes::Polarised(knots) => {
                let [sigma, psi, theta, phi] = knots.each_ref().map(Vec::len);
                write!(f, "{sigma} sigma x {psi} psi x {theta} theta x {phi} phi")
            }
            Nodes::Spherical { knots, .. } => {
                let [theta_i, phi_i, theta_o, phi_o] = knots.each_ref().map(Vec::len);
                write!(f, "{theta_i} theta_i x {phi_i} phi_i x {theta_o} theta_o x {phi_o} phi_o")
            }
            Nodes::HalfDiff([halves, differences, turns]) => {
                write!(f, "{halves} x {differences} x {turns} bins of half and difference angles")
            }
            Nodes::Rgl(Resolution { theta_i, phi_i, spectra, .. }) => {
                write!(f, "{theta_i} theta_i x {phi_i} phi_i, {spectra} x {spectra} texels")
            }
            Nodes::Klems(basis) => write!(f, "means over {n} x {n} patches", n = basis.patches()),
            Nodes::Tree(Refinement { rank, depth, error }) => {
                let dimensions = rank.dimensions();
                write!(f, "a tree of {dimensions} dimensions, halved up to {depth} times, leaves within {error}")
            }
        }
    }
}
