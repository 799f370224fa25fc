//! What is to be rendered: triangles, what they are made of, and lights.

use std::sync::Arc;

use lobe_trace::{Mesh, MeshError, Scene};

use crate::light::{AreaLight, Light, Lights};
use crate::shader::Shader;
use crate::vec3::{Vec3, add, cross, dot, length, neg, perpendicular, scale, sub, unit};

/// A mesh of one material.
///
/// A tangent is the unit direction of dp/du, perpendicular to the normal, with the handedness of dp/dv (+1 or -1) in its
/// fourth component, as in glTF: (t, w * cross(n, t), n) is the frame that psi of an anisotropic material is measured in.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// Vertices in the world.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one a vertex.
    pub normals: Vec<[f32; 3]>,
    /// Unit tangents, one a vertex.
    pub tangents: Vec<[f32; 4]>,
    /// Three vertex indices a triangle, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// What keeps shapes from being a world.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A coordinate or an index is wrong.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Normals or tangents are not as many as the vertices.
    #[error("{found} {attribute}; expected {expected}, one a vertex")]
    Attribute {
        /// `normals` or `tangents`.
        attribute: &'static str,
        /// How many there are.
        found: usize,
        /// How many vertices.
        expected: usize,
    },
    /// A normal or tangent that is no finite number.
    #[error("{attribute} of vertex {vertex} have {found}; expected finite numbers")]
    NotFinite {
        /// `normals` or `tangents`.
        attribute: &'static str,
        /// Which vertex.
        vertex: usize,
        /// What was found.
        found: f32,
    },
    /// A shape without area is to shine.
    #[error("a light without area; expected triangles that have some")]
    NoArea,
    /// A shape is of a material that is not there.
    #[error("material {found}; expected one below {materials}")]
    Material {
        /// The material asked for.
        found: usize,
        /// How many there are.
        materials: usize,
    },
    /// More vertices or triangles than 32 bits can count.
    #[error("more vertices than 32 bits can count")]
    TooMany,
}

/// Collects what makes a [`World`].
#[derive(Debug, Default)]
pub struct WorldBuilder<const C: usize> {
    shape: Shape,
    parts: Vec<Part>,
    materials: Vec<Arc<dyn Shader<C>>>,
    lights: Vec<Light<C>>,
}

/// Triangles of one material, in the order of the mesh.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// One past its last triangle.
    end: u32,
    material: u32,
    light: Option<u32>,
}

impl<const C: usize> WorldBuilder<C> {
    /// Nothing.
    pub fn new() -> Self {
        WorldBuilder { shape: Shape::default(), parts: Vec::new(), materials: Vec::new(), lights: Vec::new() }
    }

    /// Adds a material and returns its number.
    pub fn material(&mut self, shader: Arc<dyn Shader<C>>) -> usize {
        self.materials.push(shader);
        self.materials.len() - 1
    }

    /// Adds a light that is no shape.
    pub fn light(&mut self, light: Light<C>) {
        self.lights.push(light);
    }

    /// Adds a shape of a material. With `radiance` in W/(m^2 sr) it shines as well, on both sides where `two_sided`.
    ///
    /// # Errors
    /// Where its numbers do not fit together.
    pub fn shape(
        &mut self,
        shape: &Shape,
        material: usize,
        radiance: Option<[f32; C]>,
        two_sided: bool,
    ) -> Result<(), WorldError> {
        let vertices = shape.positions.len();
        for (attribute, found) in [("normals", shape.normals.len()), ("tangents", shape.tangents.len())] {
            if found != vertices {
                return Err(WorldError::Attribute { attribute, found, expected: vertices });
            }
        }
        finite("normals", &shape.normals)?;
        finite("tangents", &shape.tangents)?;
        if material >= self.materials.len() {
            return Err(WorldError::Material { found: material, materials: self.materials.len() });
        }
        let mesh = Mesh::new(shape.positions.clone(), shape.triangles.clone())?;
        let light = match radiance {
            None => None,
            Some(radiance) => {
                let corners = (0..shape.triangles.len()).map(|triangle| mesh.corners(triangle)).collect();
                let light = AreaLight::new(corners, radiance, two_sided).ok_or(WorldError::NoArea)?;
                self.lights.push(Light::Area(light));
                Some(self.lights.len() as u32 - 1)
            }
        };
        let whole = &mut self.shape;
        let first = whole.positions.len();
        let end = whole.triangles.len() + shape.triangles.len();
        if first + vertices > i32::MAX as usize || end > i32::MAX as usize {
            return Err(WorldError::TooMany);
        }
        whole.positions.extend(&shape.positions);
        whole.normals.extend(&shape.normals);
        whole.tangents.extend(&shape.tangents);
        whole.triangles.extend(shape.triangles.iter().map(|corners| corners.map(|index| index + first as u32)));
        self.parts.push(Part { end: end as u32, material: material as u32, light });
        Ok(())
    }

    /// Builds the tree.
    ///
    /// # Errors
    /// Where there are more triangles than can be numbered.
    pub fn build(self) -> Result<World<C>, WorldError> {
        let Shape { positions, normals, tangents, triangles } = self.shape;
        let scene: Scene = Scene::of_mesh(Mesh::new(positions, triangles)?);
        let bounds = scene.bounds();
        let diagonal = sub(bounds.upper, bounds.lower);
        let radius = if diagonal.iter().all(|d| *d >= 0.0) { 0.5 * f64::from(length(diagonal)) } else { 1.0 };
        let lights = Lights::new(self.lights, radius);
        Ok(World { scene, normals, tangents, parts: self.parts, materials: self.materials, lights })
    }
}

fn finite<const N: usize>(attribute: &'static str, values: &[[f32; N]]) -> Result<(), WorldError> {
    let bad = values.as_flattened().iter().position(|x| !x.is_finite());
    bad.map_or(Ok(()), |at| Err(WorldError::NotFinite { attribute, vertex: at / N, found: values.as_flattened()[at] }))
}

/// Triangles, materials and lights, ready to be rendered with `C` channels.
#[derive(Debug)]
pub struct World<const C: usize> {
    pub(crate) scene: Scene,
    normals: Vec<Vec3>,
    tangents: Vec<[f32; 4]>,
    parts: Vec<Part>,
    pub(crate) materials: Vec<Arc<dyn Shader<C>>>,
    pub(crate) lights: Lights<C>,
}

/// A place on a surface that a ray has hit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    pub position: Vec3,
    /// Where shadow rays begin: `position`, moved out of the facets that hide a smooth surface from itself.
    pub lifted: Vec3,
    /// Normal of the triangle, unit length, on the side of the shading normal.
    pub geometric: Vec3,
    /// Whether the ray met the side that the corners are counterclockwise from.
    pub front: bool,
    /// How far off the surface rays begin.
    step: f32,
    /// The frame of the material: x along the tangent, z along the shading normal.
    pub frame: [Vec3; 3],
    /// Back along the ray, in the frame.
    pub wo: Vec3,
    pub material: u32,
    pub light: Option<u32>,
}

impl Hit {
    /// A direction of the world in the frame.
    pub fn local(&self, world: Vec3) -> Vec3 {
        self.frame.map(|axis| dot(axis, world))
    }

    /// A direction of the frame in the world.
    pub fn world(&self, local: Vec3) -> Vec3 {
        let [t, b, n] = self.frame;
        add(add(scale(t, local[0]), scale(b, local[1])), scale(n, local[2]))
    }

    /// Whether the direction is on the same side of the facet as of the smooth surface. Where it is not, light would
    /// leak through the surface.
    pub fn sees(&self, world: Vec3, local: Vec3) -> bool {
        (dot(self.geometric, world) > 0.0) == (local[2] > 0.0)
    }

    /// A ray's origin at this place, off the surface on the side that `direction` leads to.
    pub fn leave(&self, from: Vec3, direction: Vec3) -> Vec3 {
        let step = if dot(self.geometric, direction) < 0.0 { -self.step } else { self.step };
        add(from, scale(self.geometric, step))
    }
}

/// How far `wo` stays above the smooth surface, at least: the sine of the angle.
const GRAZING: f32 = 1e-3;

impl<const C: usize> World<C> {
    /// How many triangles there are.
    pub fn triangles(&self) -> usize {
        self.parts.last().map_or(0, |part| part.end as usize)
    }

    /// The place that a ray along the unit vector `direction` has hit.
    pub(crate) fn hit(&self, primitive: i32, [u, v]: [f32; 2], direction: Vec3) -> Hit {
        let triangle = primitive as u32;
        let part = self.parts[self.parts.partition_point(|part| part.end <= triangle)];
        let mesh = self.scene.mesh_of(0);
        let corners = mesh.triangles()[triangle as usize].map(|index| index as usize);
        let [a, b, c] = mesh.corners(triangle as usize);
        // A hundred units in the last place or so of the largest coordinate of the triangle: what finding the place, and
        // meeting the triangle again, lose.
        let reach = [a, b, c].as_flattened().iter().fold(0.0f32, |reach, x| reach.max(x.abs()));
        let step = (reach / 65_536.0).max(1e-9);
        let (ab, ac) = (sub(b, a), sub(c, a));
        let position = add(a, add(scale(ab, u), scale(ac, v)));
        let toward = neg(direction);
        // A triangle that was hit has an area; still, it may be too small for its square.
        let mut geometric = unit(cross(ab, ac)).unwrap_or(toward);
        let front = dot(geometric, toward) > 0.0;
        let w = 1.0 - u - v;
        let blend = |[a, b, c]: [Vec3; 3]| add(add(scale(a, w), scale(b, u)), scale(c, v));
        let normals = corners.map(|index| self.normals[index]);
        let mut normal = unit(blend(normals)).unwrap_or(geometric);
        let tangents = corners.map(|index| self.tangents[index]);
        let along = blend(tangents.map(|[x, y, z, _]| [x, y, z]));
        let handedness = if tangents[0][3] < 0.0 { -1.0 } else { 1.0 };

        if dot(geometric, normal) < 0.0 {
            geometric = neg(geometric);
        }
        // What reflects only has two equal sides: the frame is turned about the tangent.
        let transmits = self.materials[part.material as usize].transmits();
        let behind = dot(geometric, toward) < 0.0;
        let mut side = 1.0;
        if behind && !transmits {
            (geometric, normal, side) = (neg(geometric), neg(normal), -1.0);
        }
        let above = if behind && transmits { -1.0 } else { 1.0 };
        let rise = above * dot(normal, toward);
        if rise < GRAZING {
            // A smooth normal that turns away from the viewer at the silhouette is turned back.
            let lift = scale(toward, above * (GRAZING - rise));
            normal = unit(add(normal, lift)).unwrap_or(geometric);
        }
        let flat = sub(along, scale(normal, dot(along, normal)));
        let t = unit(flat).unwrap_or_else(|| perpendicular(normal));
        let frame = [t, scale(cross(normal, t), handedness), normal];
        let lifted = lift(position, [a, b, c], normals, [w, u, v], side);
        let wo = frame.map(|axis| dot(axis, toward));
        Hit { position, lifted, geometric, front, step, frame, wo, material: part.material, light: part.light }
    }
}

/// The place moved to the smooth surface that the normals of the corners describe: Hanika 2021, "Hacking the Shadow
/// Terminator" (Ray Tracing Gems II, chapter 4).
fn lift(position: Vec3, corners: [Vec3; 3], normals: [Vec3; 3], weights: [f32; 3], side: f32) -> Vec3 {
    let mut lifted = position;
    for k in 0..3 {
        let normal = scale(normals[k], side);
        let below = (-dot(sub(position, corners[k]), normal)).max(0.0);
        lifted = add(lifted, scale(normal, weights[k] * below));
    }
    lifted
}
