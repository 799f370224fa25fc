//! The representations.

use std::fmt;

/// In which form a material was measured, and is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// A grid of specular coordinates, interpolated linearly in SIMD lanes.
    Specular,
    /// The adaptive parameterisation of the EPFL database.
    Rgl,
    /// A grid of half and difference angles.
    HalfDiff,
    /// The grid of the UTIA database.
    Utia,
    /// Klems matrices: constant on pairs of patches.
    Klems,
    /// Tensor trees: constant on their leaves.
    TensorTree,
    /// Mueller matrices over half and difference angles.
    Mueller,
    /// A grid of spherical coordinates.
    Spherical,
    /// Scattered samples.
    Scattered,
    /// Several measurements of a sheet, among which the sides of the directions choose.
    Sheet,
}

impl Kind {
    /// The name for people.
    pub fn name(&self) -> &'static str {
        match self {
            Kind::Specular => "specular table",
            Kind::Rgl => "RGL",
            Kind::HalfDiff => "half-difference grid",
            Kind::Utia => "UTIA grid",
            Kind::Klems => "Klems matrices",
            Kind::TensorTree => "tensor trees",
            Kind::Mueller => "Mueller matrices",
            Kind::Spherical => "spherical grid",
            Kind::Scattered => "scattered samples",
            Kind::Sheet => "sheet",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
