//! What kind of ray is traced, and by which walk.

/// What a ray is for. It decides how alike neighbouring rays are, and so how they are best traced; the answer is the
/// same bits whichever walk is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayClass {
    /// From the eye through neighbouring pixels.
    Camera,
    /// Mirrored or refracted, with only such bounces before.
    Mirror,
    /// After a bounce that scatters.
    Diffuse,
    /// From surfaces seen by coherent rays to a point or a far light.
    Shadow,
    /// From surfaces seen by coherent rays to places all over an area light or the sky.
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

    /// The class of a shadow ray from where this ray hit: `point` if the light has no extent.
    pub fn shadow(self, point: bool) -> Self {
        match self {
            RayClass::Camera | RayClass::Mirror if point => RayClass::Shadow,
            RayClass::Camera | RayClass::Mirror => RayClass::SoftShadow,
            _ => RayClass::ScatteredShadow,
        }
    }

    /// The form of walk that was the fastest for this class when measured.
    pub fn form(self) -> Form {
        match self {
            RayClass::Camera | RayClass::Mirror | RayClass::Shadow | RayClass::SoftShadow => Form::Large,
            RayClass::Diffuse | RayClass::ScatteredShadow => Form::Single,
        }
    }
}

/// A way to walk the tree. The class of a ray chooses it; it is public so that tests and measurements can compare.
/// Packets whose directions differ in sign are split.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Form {
    /// One lane per ray, with masks (Wald, Slusallek, Benthin, Wagner 2001).
    Packet,
    /// [`Packet`](Form::Packet) until few rays are live, then [`Single`](Form::Single) for each of them.
    Hybrid,
    /// Up to 64 rays at once, those of one octant: all children of a node against bundles of eight rays, the rays
    /// themselves at the leaves. If an octant has few rays they are traced one by one, as are rays that begin before
    /// zero.
    Large,
    /// One lane per child: one ray against all boxes of a node.
    Single,
}

impl Form {
    /// All of them.
    pub const ALL: [Form; 4] = [Form::Packet, Form::Hybrid, Form::Large, Form::Single];
}
