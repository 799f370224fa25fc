//! What a file leaves open.

use crate::half_diff::Lookup;
use crate::utia::Decode;
use crate::{Edges, Given};

/// What a file leaves open. Each representation looks at what concerns it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// What holds outside the measured angles of specular tables. The other representations have their own rule, which
    /// is that of the programs that defined them.
    pub edges: Edges,
    /// How half-difference grids are looked up.
    pub lookup: Lookup,
    /// What to make of the numbers of the UTIA database, whose unit is not documented.
    pub decode: Decode,
    /// Which direction finds the slice of a material of the EPFL database: the light, as it was measured, or the viewer,
    /// as renderers that trace from the camera do (Mitsuba, pbrt). They differ as far as the data are not reciprocal. The
    /// direction given is the one that is best sampled by.
    pub indexed_by: Given,
}

/// Which of the [`Options`] a representation looks at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uses {
    /// Whether [`Options::edges`] makes a difference.
    pub edges: bool,
    /// Whether [`Options::lookup`] does.
    pub lookup: bool,
    /// Whether [`Options::decode`] does.
    pub decode: bool,
    /// Whether [`Options::indexed_by`] does.
    pub indexed_by: bool,
}

impl Uses {
    /// What makes a difference to one or the other.
    pub fn or(self, other: Self) -> Self {
        Uses {
            edges: self.edges || other.edges,
            lookup: self.lookup || other.lookup,
            decode: self.decode || other.decode,
            indexed_by: self.indexed_by || other.indexed_by,
        }
    }
}
