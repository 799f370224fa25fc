//! The list of representations.
//!
//! [`Data`] is the only enum of them, and the only match over it is generated here, by the macro: programs use the
//! trait [`Representation`].

use crate::data::Representation;

/// The list of representations: each line generates a variant of [`Data`], its conversion, and its arm of the one
/// match.
macro_rules! representations {
    ($($(#[$doc:meta])* $variant:ident($data:ty)),* $(,)?) => {
        /// Measured values in the representation in which they were measured.
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        pub enum Data {
            $($(#[$doc])* $variant($data)),*
        }

        impl Data {
            /// The data as a [`Representation`].
            pub fn representation(&self) -> &dyn Representation {
                match self {
                    $(Data::$variant(data) => data),*
                }
            }

            /// Like [`representation`](Data::representation), but mutable.
            pub fn representation_mut(&mut self) -> &mut dyn Representation {
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
    /// A BRDF or BTDF on a grid in specular coordinates.
    Specular(crate::specular::Data),
    /// A BRDF or BTDF on a grid in spherical coordinates.
    Spherical(crate::spherical::Data),
    /// A BRDF or BTDF without a grid.
    Scattered(crate::scattered::Data),
    /// The adaptive parameterisation of the EPFL database.
    Rgl(crate::rgl::Data),
    /// A grid of half and difference angles.
    HalfDiff(crate::half_diff::Data),
    /// Mueller matrices over half and difference angles.
    Mueller(crate::mueller::Data),
    /// Mueller matrices on a grid in specular coordinates.
    Polarised(crate::polarised::Data),
    /// The grid of the UTIA database.
    Utia(crate::utia::Data),
    /// Cosine series in the azimuth.
    Fourier(crate::fourier::Data),
    /// An expansion in Zernike polynomials.
    Zernike(crate::zernike::Data),
    /// Klems matrices or tensor trees of the two sides of a sheet.
    Window(crate::window::Data),
    /// The mirror reflectance, or the straight-through transmittance, of a smooth surface.
    Mirror(crate::mirror::Data),
}

impl Data {
    /// The mirror reflectance, if the data are one; they then have no values for pairs of directions.
    pub fn mirror(&self) -> Option<&crate::mirror::Data> {
        if let Data::Mirror(data) = self { Some(data) } else { None }
    }
}
