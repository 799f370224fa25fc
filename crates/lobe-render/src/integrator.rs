//! The ways to make a picture.

/// How radiance is found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Integrator {
    /// Paths that light takes over many surfaces, without bias: lights and materials are drawn together (multiple
    /// importance sampling), paths that carry little end by chance.
    Path {
        /// How many surfaces a path may meet.
        depth: u32,
        /// What one sample may add after the first surface, per channel; infinite for no limit. A limit takes away
        /// bright dots, and a little light with them.
        limit: f32,
    },
    /// Light that comes straight from lights, with shadows, and mirrored and refracted rays, all of them: Whitted 1980,
    /// "An Improved Illumination Model for Shaded Display".
    Whitted {
        /// How many surfaces a ray may meet.
        depth: u32,
    },
    /// The share of directions, weighted with the cosine, in which there is no surface within a distance.
    Ambient {
        /// The distance; may be infinite.
        distance: f32,
    },
    /// The shading normals as colours, `(n + 1) / 2`.
    Normals,
}

impl Integrator {
    /// How many surfaces a ray may meet.
    pub(crate) fn depth(self) -> u32 {
        match self {
            Integrator::Path { depth, .. } | Integrator::Whitted { depth } => depth,
            Integrator::Ambient { .. } | Integrator::Normals => 0,
        }
    }

    /// What may be added by light that meets the viewer at that many surfaces.
    pub(crate) fn limit(self, surfaces: u32) -> f32 {
        match self {
            Integrator::Path { limit, .. } if surfaces > 1 => limit,
            _ => f32::INFINITY,
        }
    }

    /// Whether it shows shapes and no light.
    pub(crate) fn is_debugging(self) -> bool {
        matches!(self, Integrator::Ambient { .. } | Integrator::Normals)
    }
}
