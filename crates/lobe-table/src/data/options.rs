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
