//! Meshes, their instances, and the trees over them.

use crate::bvh::{Binary, Child, WideBvh};
use crate::triangles::Tree;
use crate::{Aabb, Affine, LIMIT, Mesh};

/// A scene that cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// An instance names a mesh that does not exist.
    #[error("instance {instance} is of mesh {found}, expected one below {meshes}")]
    Mesh {
        /// The index of the instance.
        instance: usize,
        /// The mesh that it names.
        found: usize,
        /// The number of meshes.
        meshes: usize,
    },
    /// A transform that flattens space, or has numbers that are not finite or not of reasonable size.
    #[error("instance {instance} has a transform without an inverse in numbers of magnitude up to {LIMIT:e}")]
    Transform {
        /// The index of the instance.
        instance: usize,
    },
}

/// Progress of building a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The number of triangles whose trees are finished.
    pub done: usize,
    /// The number of triangles of all meshes.
    pub total: usize,
}

/// Collects the contents of a scene.
#[derive(Clone, Debug, Default)]
pub struct SceneBuilder {
    meshes: Vec<Mesh>,
    instances: Vec<(usize, Affine)>,
}

impl SceneBuilder {
    /// A builder without meshes.
    pub fn new() -> Self {
        SceneBuilder::default()
    }

    /// Adds a mesh, which is invisible until an instance of it is added. Returns its number.
    pub fn mesh(&mut self, mesh: Mesh) -> usize {
        self.meshes.push(mesh);
        self.meshes.len() - 1
    }

    /// Adds an instance of a mesh, placed in the world by `to_world`. Returns its number.
    pub fn instance(&mut self, mesh: usize, to_world: Affine) -> usize {
        self.instances.push((mesh, to_world));
        self.instances.len() - 1
    }

    /// Builds the trees. `progress` is called after each mesh.
    ///
    /// # Errors
    /// If the mesh of an instance does not exist or its transform has no inverse.
    pub fn build<const W: usize>(self, mut progress: impl FnMut(Progress)) -> Result<Scene<W>, SceneError> {
        let meshes = self.meshes.len();
        for (instance, &(found, _)) in self.instances.iter().enumerate() {
            if found >= meshes {
                return Err(SceneError::Mesh { instance, found, meshes });
            }
        }
        let total = self.meshes.iter().map(|mesh| mesh.triangles().len()).sum();
        let mut done = 0;
        let mut trees = Vec::with_capacity(meshes);
        for mesh in &self.meshes {
            trees.push(Tree::build(mesh));
            done += mesh.triangles().len();
            progress(Progress { done, total });
        }
        let mut instances = Vec::with_capacity(self.instances.len());
        for (number, (mesh, to_world)) in self.instances.into_iter().enumerate() {
            let instance = Instance::new(mesh, to_world, trees[mesh].bvh.bounds());
            instances.push(instance.ok_or(SceneError::Transform { instance: number })?);
        }
        // Instances of empty meshes have no box by which to sort them.
        let seen: Vec<usize> = (0..instances.len()).filter(|&i| instances[i].bounds != Aabb::EMPTY).collect();
        let boxes: Vec<Aabb> = seen.iter().map(|&i| instances[i].bounds).collect();
        let binary = Binary::build(&boxes, false);
        let top = WideBvh::collapse(&binary, 1, |places| Child::leaf(seen[binary.order[places.start] as usize], 1));
        Ok(Scene { meshes: self.meshes, trees, instances, top })
    }
}

/// A mesh in the world.
#[derive(Clone, Debug)]
pub(crate) struct Instance {
    pub mesh: usize,
    pub to_world: Affine,
    pub to_local: Affine,
    /// The box around it in the world.
    pub bounds: Aabb,
}

impl Instance {
    fn new(mesh: usize, to_world: Affine, local: Aabb) -> Option<Self> {
        let to_local = to_world.inverse()?;
        let small = |map: &Affine| map.rows.as_flattened().iter().all(|x| x.abs() <= LIMIT);
        if !small(&to_world) || !small(&to_local) {
            return None;
        }
        let bounds = if local == Aabb::EMPTY { Aabb::EMPTY } else { transformed_box(local, &to_world, &to_local) };
        (bounds.reach() <= LIMIT).then_some(Instance { mesh, to_world, to_local, bounds })
    }
}

/// A box around the image of a box, large enough for the rounding of a ray that is transformed back: `2^-21` of each
/// number that goes into it, eight half-units in the last place.
fn transformed_box(local: Aabb, to_world: &Affine, to_local: &Affine) -> Aabb {
    let exact = Aabb::of((0..8).map(|corner: usize| {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { local.lower[axis] } else { local.upper[axis] };
        to_world.point([pick(0), pick(1), pick(2)])
    }));
    let size = |row: &[f32; 4], reach: f32| row[..3].iter().map(|x| x.abs()).sum::<f32>() * reach + row[3].abs();
    let lost = to_local.rows.iter().map(|row| size(row, exact.reach())).fold(local.reach(), f32::max);
    let pad = to_world.rows.map(|row| size(&row, lost) / 2_097_152.0);
    Aabb {
        lower: std::array::from_fn(|axis| exact.lower[axis] - pad[axis]),
        upper: std::array::from_fn(|axis| exact.upper[axis] + pad[axis]),
    }
}

/// Meshes and their instances, ready to be traced. `W` is the number of children of a node, 4 or 8; the hits do not
/// depend on it.
#[derive(Clone, Debug)]
pub struct Scene<const W: usize = 8> {
    meshes: Vec<Mesh>,
    pub(crate) trees: Vec<Tree<W>>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) top: WideBvh<W>,
}

impl<const W: usize> Scene<W> {
    /// A scene of one untransformed mesh.
    pub fn of_mesh(mesh: Mesh) -> Self {
        let mut builder = SceneBuilder::new();
        let mesh = builder.mesh(mesh);
        builder.instance(mesh, Affine::IDENTITY);
        builder.build(|_| ()).expect("a mesh that was checked, untransformed")
    }

    /// The number of instances.
    pub fn instance_count(&self) -> usize {
        self.instances.len()
    }

    /// The mesh of an instance.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn mesh_of(&self, instance: usize) -> &Mesh {
        &self.meshes[self.instances[instance].mesh]
    }

    /// The map from an instance's space to the world.
    ///
    /// # Panics
    /// If there is no such instance.
    pub fn to_world(&self, instance: usize) -> &Affine {
        &self.instances[instance].to_world
    }

    /// The box around everything.
    pub fn bounds(&self) -> Aabb {
        self.top.bounds()
    }

    /// The tree of the only instance, if it is not transformed: then rays need not be transformed either.
    #[inline(always)]
    pub(crate) fn plain(&self) -> Option<&Tree<W>> {
        match self.instances.as_slice() {
            [only] if only.to_world == Affine::IDENTITY => Some(&self.trees[only.mesh]),
            _ => None,
        }
    }
}
