//! The classes of rays, and the walks that trace them.

/// The purpose of a ray. It determines how similar neighbouring rays are, and so how they are best traced; the answer
/// has the same bits for every walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayClass {
    /// From the camera through neighbouring pixels.
    Camera,
    /// Mirrored or refracted, with only such bounces before.
    Mirror,
    /// After a diffuse or glossy bounce.
    Diffuse,
    /// From surfaces seen by coherent rays to a point or a far light.
    Shadow,
    /// From surfaces seen by coherent rays to points all over an area light or the sky.
    SoftShadow,
    /// From surfaces that scattered rays found.
    ScatteredShadow,
}

impl RayClass {
    /// The class of the next ray of a path: `specular` if neighbouring rays stay neighbours.
    pub fn bounce(self, specular: bool) -> Self {
        match self {
            RayClass::Camera | RayClass::Mirror if specular => RayClass::Mirror,
            _ => RayClass::Diffuse,
        }
    }

    /// The class of a shadow ray from the hit of this ray: `point` if the light has no extent.
    pub fn shadow(self, point: bool) -> Self {
        match self {
            RayClass::Camera | RayClass::Mirror if point => RayClass::Shadow,
            RayClass::Camera | RayClass::Mirror => RayClass::SoftShadow,
            _ => RayClass::ScatteredShadow,
        }
    }

    /// The form of walk that measurements showed to be fastest for this class.
    pub fn form(self) -> Form {
        match self {
            RayClass::Camera | RayClass::Mirror | RayClass::Shadow | RayClass::SoftShadow => Form::Large,
            RayClass::Diffuse | RayClass::ScatteredShadow => Form::Single,
        }
    }
}

/// A way to walk the tree, chosen by the class of a ray; it is public for comparisons in tests and measurements.
/// Packets whose directions differ in sign are split.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Form {
    /// One lane per ray, with masks (Wald, Slusallek, Benthin, Wagner 2001).
    Packet,
    /// [`Packet`](Form::Packet) until few rays are live, then [`Single`](Form::Single) for each of them.
    Hybrid,
    /// Up to 64 rays of one octant at once: all children of a node against bundles of eight rays, and the rays
    /// themselves at the leaves. If an octant has few rays, they are traced one by one, as are rays that begin before
    /// zero.
    Large,
    /// One lane per child: one ray against all boxes of a node.
    Single,
}

impl Form {
    /// All forms.
    pub const ALL: [Form; 4] = [Form::Packet, Form::Hybrid, Form::Large, Form::Single];
}
