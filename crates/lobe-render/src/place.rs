//! A point on one surface: the scalar form of a [`SurfaceInteraction`](crate::interaction::SurfaceInteraction).

use crate::vec3::{self, Vec3};

/// A point on one surface, kept for later.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub position: Vec3,
    /// The origin of shadow rays, moved out of the facets that hide a smooth surface from itself.
    pub lifted: Vec3,
    /// Unit normal of the triangle, on the side of the shading normal.
    pub geometric: Vec3,
    /// The frame of the material: x along the tangent, z along the shading normal.
    pub frame: [Vec3; 3],
    /// Distance from the surface at which rays begin.
    pub step: f32,
}

impl Place {
    pub const ZERO: Self =
        Place { position: [0.0; 3], lifted: [0.0; 3], geometric: [0.0; 3], frame: [[0.0; 3]; 3], step: 0.0 };

    /// Transforms a direction from the world to the frame.
    pub fn local(&self, world: Vec3) -> Vec3 {
        self.frame.map(|axis| vec3::dot(axis, world))
    }

    /// Transforms a direction from the frame to the world.
    pub fn world(&self, local: Vec3) -> Vec3 {
        let [x, y, z] = self.frame;
        vec3::add(vec3::add(vec3::scale(x, local[0]), vec3::scale(y, local[1])), vec3::scale(z, local[2]))
    }

    /// `true` if the direction is on the same side of the facet and of the smooth surface.
    pub fn same_side(&self, world: Vec3, local: Vec3) -> bool {
        (vec3::dot(self.geometric, world) > 0.0) == (local[2] > 0.0)
    }

    /// The origin of a shadow ray, moved off the surface to the side of `direction`.
    pub fn shadow_origin(&self, direction: Vec3) -> Vec3 {
        let below = vec3::dot(self.geometric, direction) < 0.0;
        vec3::add(self.lifted, vec3::scale(self.geometric, if below { -self.step } else { self.step }))
    }

    /// The cosine of a direction to the normal of the triangle.
    pub fn cos(&self, world: Vec3) -> f32 {
        vec3::dot(self.geometric, world).abs()
    }

    /// The factor that corrects importance for the difference between the shading normal and the normal of the triangle
    /// (Veach 1997, section 5.3.2), for a path from `wo` to `wi`, in the frame and in the world.
    pub fn adjoint_correction(&self, [wo, wi]: [Vec3; 2], [from, to]: [Vec3; 2]) -> f32 {
        let divisor = self.cos(from) * wi[2].abs();
        if divisor > 0.0 { wo[2].abs() * self.cos(to) / divisor } else { 0.0 }
    }
}
