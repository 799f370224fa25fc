//! A measured BRDF or BTDF prepared for evaluation.

use super::data::{AXIS_NAMES, Data};
use crate::grid::interpolation::{Interpolator, Source};
use crate::{Axis, Channels, Edge, Edges, Function, Precision, Scatter, TableError};

/// A measured BRDF or BTDF in specular coordinates, laid out for evaluation in SIMD lanes.
///
/// There are three ways to evaluate it. All give the same bits on one backend and, in strict form, on all backends:
/// - [`eval`](Table::eval): one pair of directions;
/// - [`eval_batch`](Table::eval_batch): many pairs, as arrays of vectors or as separate components;
/// - [`eval_lanes`](Table::eval_lanes): one pair per lane, under a mask, inside a caller's own kernel.
///
/// `wi` points to the light and `wo` to the viewer, unit vectors that point away from the surface, normal on +z.
/// Results are `f` in 1/sr without the cosine. A reflection table gives 0 unless both directions have `z > 0`; a
/// transmission table uses `|z|` of both, because its values are stored mirrored to the upper hemisphere, and gives 0
/// if one is 0. Directions with a component that is not finite give 0. If `wi` is the normal, psi is 0 and phi counts
/// from +x; if `wo` is the zenith, phi is 0.
#[derive(Clone, Debug)]
pub struct Table {
    scatter: Scatter,
    channels: Channels,
    edges: Edges,
    pub(super) grid: Interpolator,
    pub(super) refraction: Option<Function>,
}

impl Table {
    /// Lays out samples for evaluation, with a policy for queries outside the knots.
    ///
    /// # Errors
    /// If the table is too large to be indexed, or a periodic axis cannot be closed.
    pub fn new(samples: &Data, edges: &Edges) -> Result<Self, TableError> {
        Table::with_precision(samples, edges, Precision::Single)
    }

    /// Like [`new`](Table::new), with a choice of the storage format of the values.
    ///
    /// # Errors
    /// The same as for [`new`](Table::new).
    pub fn with_precision(samples: &Data, edges: &Edges, precision: Precision) -> Result<Self, TableError> {
        let source = Source {
            names: &AXIS_NAMES,
            knots: samples.knots(),
            channels: samples.channels().count(),
            values: samples.values(),
        };
        let grid = Interpolator::new(&source, edges, precision)?;
        let edge = if edges.axes[0] == Edge::Zero { Edge::Clamp } else { edges.axes[0] };
        let refraction = samples
            .refraction()
            .map(|offsets| Function::new(&samples.knots()[0], offsets, edge))
            .transpose()
            .map_err(|source| TableError::Axis { axis: AXIS_NAMES[0], source })?;
        Ok(Table { scatter: samples.scatter(), channels: samples.channels().clone(), edges: *edges, grid, refraction })
    }

    /// Reflection or transmission.
    pub fn scatter(&self) -> Scatter {
        self.scatter
    }

    /// The meaning of the channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// The number of channels.
    #[inline]
    pub fn channel_count(&self) -> usize {
        self.grid.channels()
    }

    /// The policy outside the knots.
    pub fn edges(&self) -> &Edges {
        &self.edges
    }

    /// The offset of the zenith from sigma, if there is one.
    pub(crate) fn refraction(&self) -> Option<&Function> {
        self.refraction.as_ref()
    }

    /// The axes of sigma, psi, theta and phi.
    pub fn axes(&self) -> &[Axis; 4] {
        self.grid.axes()
    }

    /// `true` if the value depends on the rotation of the sample.
    pub fn is_anisotropic(&self) -> bool {
        self.grid.is_anisotropic()
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        self.grid.bytes()
    }
}
