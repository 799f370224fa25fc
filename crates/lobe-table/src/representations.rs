//! The list of representations.
//!
//! [`Data`] is the only enum of them, and the only match over it is made here, by the macro: programs ask the trait
//! [`Representation`].

use crate::data::Representation;

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

            /// As [`representation`](Data::representation), to change the data.
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
    /// Mueller matrices on a grid of specular coordinates.
    Polarised(crate::polarised::Data),
    /// The grid of the UTIA database.
    Utia(crate::utia::Data),
    /// Cosine series of the azimuth.
    Fourier(crate::fourier::Data),
    /// An expansion in Zernike polynomials.
    Zernike(crate::zernike::Data),
    /// Klems matrices or tensor trees of the two sides of a sheet.
    Window(crate::window::Data),
    /// The mirror reflectance, or the transmittance straight through, of a smooth surface.
    Mirror(crate::mirror::Data),
}

impl Data {
    /// The mirror reflectance, if the data are one: they have no value for a pair of directions.
    pub fn mirror(&self) -> Option<&crate::mirror::Data> {
        if let Data::Mirror(data) = self { Some(data) } else { None }
    }
}
