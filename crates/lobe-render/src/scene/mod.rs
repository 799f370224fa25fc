//! Scenes in TOML files. The format is described in `docs/scenes.md`.

mod light;
mod material;
mod node;
mod object;
mod view;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sha2::{Digest, Sha256};

use crate::camera::{Camera, Filter};
use crate::integrator::Integrator;
use crate::shader::Backend;
use crate::world::{World, WorldBuilder};
use node::Source;

pub(crate) use node::Node;
pub use node::SceneError;

/// What a scene file says.
#[derive(Debug)]
pub struct Scene {
    /// Shapes, materials and lights.
    pub world: World,
    /// What the picture is taken with.
    pub camera: Camera,
    /// Columns and rows.
    pub size: [u32; 2],
    /// How samples are spread around a pixel.
    pub filter: Filter,
    /// For pictures that are tone-mapped, in stops.
    pub exposure: f32,
    /// How radiance is found.
    pub integrator: Arc<dyn Integrator>,
    /// Samples per pixel.
    pub samples: u32,
    /// A hash of the scene file and of all files that it names, in hexadecimal.
    pub hash: String,
}

/// What is collected while a scene is read.
struct Reading<'p> {
    /// The folder that relative paths begin at.
    folder: &'p Path,
    world: WorldBuilder,
    /// What materials run on.
    backend: Backend,
    materials: BTreeMap<String, usize>,
    hash: Sha256,
}

impl Reading<'_> {
    /// The path of a file that a key names. Its content goes into the hash of the scene.
    fn file(&mut self, node: &Node<'_, '_>, key: &str) -> Result<Option<PathBuf>, SceneError> {
        node.text(key)?.map(|name| self.named_file(node, key, name)).transpose()
    }

    /// As [`file`](Self::file), of an array of names; empty if there is no such key.
    fn files(&mut self, node: &Node<'_, '_>, key: &str) -> Result<Vec<PathBuf>, SceneError> {
        node.texts(key)?.into_iter().map(|name| self.named_file(node, key, name)).collect()
    }

    fn named_file(&mut self, node: &Node<'_, '_>, key: &str, name: &str) -> Result<PathBuf, SceneError> {
        let path = self.folder.join(name);
        let unreadable = |error: std::io::Error| node.error(key, format!("{}: {error}", path.display()));
        let mut files = vec![path.clone()];
        if path.is_dir() {
            let entries = std::fs::read_dir(&path).and_then(|dir| dir.collect::<Result<Vec<_>, _>>());
            files = entries.map_err(unreadable)?.into_iter().map(|entry| entry.path()).collect();
            files.retain(|file| file.is_file());
            files.sort();
        }
        for file in files {
            let bytes = std::fs::read(file).map_err(unreadable)?;
            self.hash.update(bytes.len().to_le_bytes());
            self.hash.update(bytes);
        }
        Ok(path)
    }
}

impl Scene {
    /// Reads a scene file and everything that it names; paths in it begin at its folder. Materials run on `backend`.
    ///
    /// # Errors
    /// [`SceneError`] names the file, the line and the key.
    pub fn open(path: &Path, backend: Backend) -> Result<Self, SceneError> {
        let whole = |message: String| SceneError { file: path.into(), line: 1, key: String::new(), message };
        let bytes = std::fs::read(path).map_err(|error| whole(error.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            whole(format!("found byte {} that is not UTF-8; expected text", at))
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Scene::parse(path, folder, &text, backend)
    }

    /// Reads the text of a scene; paths in it begin at `folder`, and `file` is what errors name.
    ///
    /// # Errors
    /// As [`open`](Scene::open).
    pub fn parse(file: &Path, folder: &Path, text: &str, backend: Backend) -> Result<Self, SceneError> {
        let source = Source { file, text };
        let table = source.table()?;
        let root = Node::new(&source, "", 0, table.get_ref());
        let mut hash = Sha256::new();
        hash.update(text.as_bytes());
        let mut reading = Reading { folder, world: WorldBuilder::new(), backend, materials: BTreeMap::new(), hash };

        let camera = view::camera(&root)?;
        let (size, filter, exposure) = view::film(&root)?;
        let (integrator, samples) = view::integrator(&root)?;
        material::read(&root, &mut reading)?;
        object::read(&root, &mut reading)?;
        light::read(&root, &mut reading)?;
        root.finish()?;

        let world = reading.world.build().map_err(|error| source.error(0, "", error.to_string()))?;
        let digest = reading.hash.finalize();
        let hash = digest.iter().take(16).fold(String::new(), |mut hex, byte| {
            write!(hex, "{byte:02x}").expect("writing to memory");
            hex
        });
        Ok(Scene { world, camera, size, filter, exposure, integrator, samples, hash })
    }
}
