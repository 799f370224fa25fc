//! The evaluation of [`Data`] one query at a time in `f64`: the reference for the lanes.

use super::data::Data;
use crate::Edges;
use crate::grid::neighbours::{Neighbours, corners};
use crate::mueller::{ELEMENTS, Matrix, in_frames};
use crate::specular::coords::directions_to_angles;

impl Data {
    /// The Mueller matrix in 1/sr, without the cosine, for light that comes from `wi` and leaves along `wo`, with the
    /// policy of each axis outside its knots.
    ///
    /// It maps Stokes vectors with the x axis [`stokes_basis`](crate::mueller::stokes_basis)`(-wi)` to Stokes vectors
    /// with the x axis `stokes_basis(wo)`. Zero if a direction is not above the surface.
    pub fn eval(&self, edges: &Edges, wi: [f64; 3], wo: [f64; 3], nm: f64) -> Matrix {
        self.in_plane(edges, wi, wo, nm).map_or([[0.0; 4]; 4], |matrix| in_frames(matrix, wi, wo))
    }

    /// The stored matrix, linear in all five axes, for Stokes vectors with the x axis
    /// [`plane_normal`](crate::mueller::plane_normal). `None` if a direction is not above the surface.
    pub fn in_plane(&self, edges: &Edges, wi: [f64; 3], wo: [f64; 3], nm: f64) -> Option<Matrix> {
        let finite = wi.iter().chain(&wo).all(|c| c.is_finite());
        if !(finite && wi[2] > 0.0 && wo[2] > 0.0) {
            return None;
        }
        let angles = directions_to_angles(wi, wo, |sigma| sigma);
        let mut matrix = [[0.0; 4]; 4];
        let mut cell = [Neighbours::ONLY; 5];
        for (axis, found) in cell.iter_mut().enumerate().take(4) {
            match Neighbours::find(&self.knots()[axis], edges.axes[axis], angles[axis]) {
                Some(neighbours) => *found = neighbours,
                None => return Some(matrix),
            }
        }
        cell[4] = Neighbours::held(self.wavelengths(), nm);
        let lengths = [0, 1, 2, 3, 4].map(|axis| self.knots().get(axis).map_or(self.wavelengths().len(), Vec::len));
        corners(&cell, |node, weight| {
            let at = node.iter().zip(lengths).fold(0, |at, (node, length)| at * length + node);
            for (sum, value) in matrix.as_flattened_mut().iter_mut().zip(&self.values[at * ELEMENTS..][..ELEMENTS]) {
                *sum += weight * f64::from(*value);
            }
        });
        matrix[0][0] = matrix[0][0].max(0.0);
        Some(matrix)
    }
}
