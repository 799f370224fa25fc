//! The world to be rendered: triangles, their materials, and lights.

use std::sync::Arc;

use lobe_memory::Storage;
use lobe_trace::{Mesh, MeshError, Scene};

use crate::light::{AreaLight, Light, LightPolarisation, Lights, SceneBounds};
use crate::shader::Shader;
use crate::transport::{Rgb, Transport};
use crate::vec3::{add, length, scale, sub};

/// A mesh of one material.
///
/// A tangent is the unit direction of dp/du, perpendicular to the normal, with the handedness of dp/dv (+1 or -1) in
/// its fourth component, as in glTF: (t, w * cross(n, t), n) is the frame in which psi of an anisotropic material is
/// measured.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// Vertices in the world.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one per vertex.
    pub normals: Vec<[f32; 3]>,
    /// Unit tangents, one per vertex.
    pub tangents: Vec<[f32; 4]>,
    /// Three vertex indices per triangle, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// The reason why shapes do not make a world.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// A coordinate or an index is wrong.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The number of normals or tangents differs from the number of vertices.
    #[error("{found} {attribute}; expected {expected}, one per vertex")]
    Attribute {
        /// `normals` or `tangents`.
        attribute: &'static str,
        /// Number found.
        found: usize,
        /// Number of vertices.
        expected: usize,
    },
    /// A normal or tangent is not finite.
    #[error("{attribute} of vertex {vertex} have {found}; expected finite numbers")]
    NotFinite {
        /// `normals` or `tangents`.
        attribute: &'static str,
        /// Index of the vertex.
        vertex: usize,
        /// What was found.
        found: f32,
    },
    /// A shape without area should emit light.
    #[error("a light without area; expected triangles with an area")]
    NoArea,
    /// A shape has a material that does not exist.
    #[error("material {found}; expected one below {materials}")]
    Material {
        /// The requested material.
        found: usize,
        /// Number found.
        materials: usize,
    },
    /// There are more vertices or triangles than lanes can address.
    #[error("found {vertices} vertices and {triangles} triangles; expected at most {MOST} and {}", i32::MAX)]
    TooMany {
        /// Number of vertices.
        vertices: usize,
        /// Number of triangles.
        triangles: usize,
    },
}

/// Collects the parts of a [`World`].
#[derive(Debug)]
pub struct WorldBuilder<T: Transport = Rgb> {
    basis: T::Basis,
    shape: Shape,
    groups: Vec<MaterialGroup>,
    materials: Vec<Arc<dyn Shader<T>>>,
    lights: Vec<Light<T::Spectrum>>,
    polarised: Vec<(usize, LightPolarisation)>,
}

/// Triangles of one material, in the order of the mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MaterialGroup {
    /// One past its last triangle.
    end: u32,
    pub material: u32,
    pub light: Option<u32>,
    /// 1 if light may pass through, otherwise 0.
    pub transmits: f32,
}

/// A vertex: its position, normal and tangent, padded with zeros to whole quads.
pub(crate) type Corner = [f32; 12];

/// The largest number of vertices of a world: lanes address their floats with 31 bits.
const MOST: usize = i32::MAX as usize / size_of::<Corner>() * size_of::<f32>();

impl<T: Transport<Basis = ()>> Default for WorldBuilder<T> {
    fn default() -> Self {
        WorldBuilder::new()
    }
}

impl<T: Transport<Basis = ()>> WorldBuilder<T> {
    /// An empty world.
    pub fn new() -> Self {
        WorldBuilder::in_basis(())
    }
}

impl<T: Transport> WorldBuilder<T> {
    /// An empty world in these channels.
    pub fn in_basis(basis: T::Basis) -> Self {
        WorldBuilder {
            basis,
            shape: Shape::default(),
            groups: Vec::new(),
            materials: Vec::new(),
            lights: Vec::new(),
            polarised: Vec::new(),
        }
    }

    /// Description of the channels.
    pub fn basis(&self) -> &T::Basis {
        &self.basis
    }

    /// Adds a material and returns its index.
    pub fn material(&mut self, shader: Arc<dyn Shader<T>>) -> usize {
        self.materials.push(shader);
        self.materials.len() - 1
    }

    /// Adds a light that is not a shape.
    pub fn light(&mut self, light: Light<T::Spectrum>) {
        self.lights.push(light);
    }

    /// The number of lights so far, including shapes that emit.
    pub fn light_count(&self) -> usize {
        self.lights.len()
    }

    /// Polarises the lights from this number on. Only transports of polarised light see the difference.
    pub fn polarise(&mut self, from: usize, polarisation: LightPolarisation) {
        self.polarised.extend((from..self.lights.len()).map(|light| (light, polarisation)));
    }

    /// Adds a shape with a material. With `radiance` in W/(m^2 sr) it also emits light, on both sides if `two_sided`.
    ///
    /// # Errors
    /// If its numbers do not fit together.
    pub fn shape(
        &mut self,
        shape: &Shape,
        material: usize,
        radiance: Option<T::Spectrum>,
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
        if first + vertices > MOST || end > i32::MAX as usize {
            return Err(WorldError::TooMany { vertices: first + vertices, triangles: end });
        }
        whole.positions.extend(&shape.positions);
        whole.normals.extend(&shape.normals);
        whole.tangents.extend(&shape.tangents);
        whole.triangles.extend(shape.triangles.iter().map(|corners| corners.map(|index| index + first as u32)));
        let transmits = f32::from(u8::from(self.materials[material].lobes().transmits));
        self.groups.push(MaterialGroup { end: end as u32, material: material as u32, light, transmits });
        Ok(())
    }

    /// Builds the tree.
    ///
    /// # Errors
    /// If there are more triangles than can be numbered.
    pub fn build(self) -> Result<World<T>, WorldError> {
        let Shape { positions, normals, tangents, triangles } = self.shape;
        let vertices = positions.iter().zip(&normals).zip(&tangents);
        let corners = vertices.map(|(([x, y, z], [a, b, c]), [t, u, v, w])| {
            let corner: Corner = [*x, *y, *z, *a, *b, *c, *t, *u, *v, *w, 0.0, 0.0];
            corner
        });
        let corners = Storage::copied(&corners.collect::<Vec<Corner>>());
        let mut group = 0;
        let with_group = triangles.iter().enumerate().map(|(number, [a, b, c])| {
            while self.groups[group].end as usize <= number {
                group += 1;
            }
            [*a, *b, *c, group as u32]
        });
        let with_groups = Storage::copied(&with_group.collect::<Vec<_>>());
        let scene: Scene = Scene::of_mesh(Mesh::new(positions, triangles)?);
        let bounds = scene.bounds();
        let diagonal = sub(bounds.upper, bounds.lower);
        // A world without triangles has no extent.
        let sphere = if diagonal.iter().all(|d| *d >= 0.0) {
            let center = scale(add(bounds.lower, bounds.upper), 0.5);
            SceneBounds { center, radius: 0.5 * f64::from(length(diagonal)) }
        } else {
            SceneBounds { center: [0.0; 3], radius: 1.0 }
        };
        let lights = Lights::new(self.lights, sphere).polarised(&self.polarised);
        let (groups, materials, basis) = (self.groups, self.materials, self.basis);
        Ok(World { basis, scene, corners, triangles: with_groups, groups, materials, lights })
    }
}

fn finite<const N: usize>(attribute: &'static str, values: &[[f32; N]]) -> Result<(), WorldError> {
    let bad = values.as_flattened().iter().position(|x| !x.is_finite());
    bad.map_or(Ok(()), |at| Err(WorldError::NotFinite { attribute, vertex: at / N, found: values.as_flattened()[at] }))
}

/// Triangles, materials and lights, ready to be rendered with the transport `T`.
#[derive(Debug)]
pub struct World<T: Transport = Rgb> {
    pub(crate) basis: T::Basis,
    pub(crate) scene: Scene,
    /// The numbers of each vertex side by side, so that they are cached together.
    pub(crate) corners: Storage<Corner>,
    /// For each triangle, its corners and its group.
    pub(crate) triangles: Storage<[u32; 4]>,
    pub(crate) groups: Vec<MaterialGroup>,
    pub(crate) materials: Vec<Arc<dyn Shader<T>>>,
    pub(crate) lights: Lights<T::Spectrum>,
}

impl<T: Transport> World<T> {
    /// Description of the channels.
    pub fn basis(&self) -> &T::Basis {
        &self.basis
    }

    /// The lights.
    pub fn lights(&self) -> &[Light<T::Spectrum>] {
        &self.lights.all
    }

    /// The same shapes under other lights, without building their tree again.
    ///
    /// # Panics
    /// If a shape emits light.
    pub fn lit_by(self, lights: Vec<Light<T::Spectrum>>) -> Self {
        assert!(self.groups.iter().all(|group| group.light.is_none()), "a shape emits light");
        World { lights: Lights::new(lights, self.lights.bounds), ..self }
    }

    /// A sphere around the triangles, through which light from infinitely far away enters the scene.
    pub fn bounds(&self) -> SceneBounds {
        self.lights.bounds
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.groups.last().map_or(0, |group| group.end as usize)
    }
}
