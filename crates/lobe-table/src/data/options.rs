//! Options for choices that a file leaves open.

use crate::half_diff::Lookup;
use crate::utia::Decode;
use crate::{Edges, Given};

/// Options for choices that a file leaves open. Each representation uses those that concern it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The values outside the measured angles of specular tables. The other representations follow the rule of the
    /// programs that defined them.
    pub edges: Edges,
    /// The lookup in half-difference grids.
    pub lookup: Lookup,
    /// The conversion of the numbers of the UTIA database, whose unit is not documented.
    pub decode: Decode,
    /// The direction that indexes the slices of a material of the EPFL database: the light, as in the measurement, or
    /// the viewer, as in renderers that trace from the camera (Mitsuba, pbrt). The values differ if the data are not
    /// reciprocal. Sampling works best if this direction is the known one.
    pub indexed_by: Given,
}

/// The [`Options`] that affect a representation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uses {
    /// `true` if [`Options::edges`] makes a difference.
    pub edges: bool,
    /// `true` if [`Options::lookup`] makes a difference.
    pub lookup: bool,
    /// `true` if [`Options::decode`] makes a difference.
    pub decode: bool,
    /// `true` if [`Options::indexed_by`] makes a difference.
    pub indexed_by: bool,
}

impl Uses {
    /// The options that affect either of two representations.
    pub fn or(self, other: Self) -> Self {
        Uses {
            edges: self.edges || other.edges,
            lookup: self.lookup || other.lookup,
            decode: self.decode || other.decode,
            indexed_by: self.indexed_by || other.indexed_by,
        }
    }
}
