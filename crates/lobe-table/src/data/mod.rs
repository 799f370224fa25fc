//! What was measured, whatever its representation.
//!
//! [`Data`] is the only enum of representations, and the only match over it is [`Data::representation`]: programs ask the
//! trait [`Representation`], which each representation implements next to its data.

mod aspect;
mod kind;
mod near;
mod options;
mod prepare;
mod representation;
mod section;

pub use aspect::{Aspect, Side};
pub use kind::Kind;
pub(crate) use near::{Near, SAME, direction, reach, spans};
pub use options::Options;
pub use prepare::PrepareError;
pub use representation::{Coverage, Representation, ValueMap};
pub(crate) use section::pairs;
pub use section::{ANGLE_ROUNDING, Fact, Gaps, Grid, Kinks, Section, SectionAxis, closes_circle};

/// The list of representations: a line makes a variant of [`Data`], its conversion, and its arm of the one match.
macro_rules! representations {
    ($($(#[$doc:meta])* $variant:ident($data:ty)),* $(,)?) => {
        /// What was measured, in the form in which it was measured.
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        pub enum Data {
            $($(#[$doc])* $variant($data)),*
        }

        impl Data {
            /// What every representation can report.
            pub fn representation(&self) -> &dyn Representation {
                match self {
                    $(Data::$variant(data) => data),*
                }
            }
        }

        $(impl From<$data> for Data {
            fn from(data: $data) -> Self {
                Data::$variant(data)
            }
        })*
    };
}

representations! {
    /// A BRDF or BTDF on a grid of specular coordinates.
    Specular(crate::specular::Data),
    /// A BRDF or BTDF on a grid of spherical coordinates.
    Spherical(crate::spherical::Data),
    /// A BRDF or BTDF on no grid.
    Scattered(crate::scattered::Data),
    /// The adaptive parameterisation of the EPFL database.
    Rgl(crate::rgl::Data),
    /// A grid of half and difference angles.
    HalfDiff(crate::half_diff::Data),
    /// Mueller matrices over half and difference angles.
    Mueller(crate::mueller::Data),
    /// The grid of the UTIA database.
    Utia(crate::utia::Data),
    /// Klems matrices or tensor trees of the two sides of a sheet.
    Window(crate::window::Data),
    /// The mirror reflectance, or the transmittance straight through, of a smooth surface.
    Mirror(crate::mirror::Data),
}
