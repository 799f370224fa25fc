//! Scenes in TOML files. The format is described in `docs/scenes.md`.

mod film;
mod index;
mod light;
mod material;
pub(crate) mod node;
mod object;
mod spectrum;
mod view;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sha2::{Digest, Sha256};

use crate::camera::{Camera, Filter};
use crate::integrator::{self, Integrator};
use crate::shader::Backend;
use crate::transport::{Bands, Energy16, EnergyRgb, Rgb, Stokes16, StokesRgb, Transport};
use crate::world::{World, WorldBuilder};
use node::{Node, Source};

pub use node::SceneError;

/// The content of a scene file.
#[derive(Debug)]
pub struct Scene<T: Transport = Rgb> {
    /// Shapes, materials and lights.
    pub world: World<T>,
    /// The camera.
    pub camera: Camera,
    /// Columns and rows.
    pub size: [u32; 2],
    /// The filter that spreads samples around a pixel.
    pub filter: Filter,
    /// Exposure of tone-mapped pictures, in stops.
    pub exposure: f32,
    /// The integrator.
    pub integrator: Arc<dyn Integrator<T>>,
    /// Samples per pixel.
    pub samples: u32,
    /// A hash of the scene file and of all other files read for it, in hexadecimal.
    pub hash: String,
    /// All of these files, the scene itself first.
    pub files: Vec<PathBuf>,
}

/// State collected while a scene is read.
struct Reading<'p, T: Transport> {
    /// The folder that paths are relative to.
    folder: &'p Path,
    world: WorldBuilder<T>,
    /// The backend that materials run on.
    backend: Backend,
    materials: BTreeMap<String, usize>,
    /// Receives the share of the materials that are ready.
    progress: &'p mut dyn FnMut(f64),
}

impl<T: Transport> Reading<'_, T> {
    /// The path of a file that a key names.
    fn file(&self, node: &Node<'_, '_>, key: &str) -> Result<Option<PathBuf>, SceneError> {
        Ok(node.text(key)?.map(|name| self.folder.join(name)))
    }

    /// Like [`file`](Self::file), for an array of names; empty if there is no such key.
    fn files(&self, node: &Node<'_, '_>, key: &str) -> Result<Vec<PathBuf>, SceneError> {
        Ok(node.texts(key)?.into_iter().map(|name| self.folder.join(name)).collect())
    }
}

impl Scene {
    /// Reads a scene file and everything that it names; paths in it are relative to its folder. Materials run on
    /// `backend`.
    ///
    /// # Errors
    /// [`SceneError`] names the file, the line and the key.
    pub fn open(path: &Path, backend: Backend) -> Result<Self, SceneError> {
        Scene::open_with_progress(path, backend, &mut |_| {})
    }

    /// Like [`open`](Scene::open), but calls `progress` with the share of the materials that are ready, because
    /// preparing them takes time.
    ///
    /// # Errors
    /// The same as for [`open`](Scene::open).
    pub fn open_with_progress(
        path: &Path,
        backend: Backend,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Self, SceneError> {
        let text = text_of(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Scene::read(path, folder, &text, backend, progress)
    }

    /// Reads the text of a scene; paths in it are relative to `folder`, and errors name `file`.
    ///
    /// # Errors
    /// The same as for [`open`](Scene::open).
    pub fn parse(file: &Path, folder: &Path, text: &str, backend: Backend) -> Result<Self, SceneError> {
        Scene::read(file, folder, text, backend, &mut |_| {})
    }

    fn read(
        file: &Path,
        folder: &Path,
        text: &str,
        backend: Backend,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Self, SceneError> {
        let source = Source { file, text };
        let table = source.table()?;
        let root = Node::new(&source, "", 0, table.get_ref());
        let (integrator, samples) = view::integrator(&root)?;
        read_in((), (integrator, samples), &root, &source, (folder, backend), progress)
    }
}

/// The text of a scene file.
fn text_of(path: &Path) -> Result<String, SceneError> {
    let whole = |message: String| SceneError { file: path.into(), line: 1, key: String::new(), message };
    let bytes = lobe_files::bytes(path).map_err(|error| whole(error.to_string()))?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        whole(format!("found byte {} that is not UTF-8; expected text", at))
    })
}

/// An integrator and the samples per pixel.
type Integration<T> = (Arc<dyn Integrator<T>>, u32);

/// Reads a scene in the channels of a picture.
fn read_in<T: Transport>(
    basis: T::Basis,
    (integrator, samples): Integration<T>,
    root: &Node<'_, '_>,
    source: &Source<'_>,
    (folder, backend): (&Path, Backend),
    progress: &mut dyn FnMut(f64),
) -> Result<Scene<T>, SceneError> {
    let world = WorldBuilder::in_basis(basis);
    let mut reading = Reading { folder, world, backend, materials: BTreeMap::new(), progress };
    let camera = view::camera(root)?;
    let (size, filter, exposure) = view::film(root)?;
    // Files may name further files: all of them count.
    let (done, reads) = lobe_files::recorded(|| {
        material::read(root, &mut reading)?;
        object::read(root, &mut reading)?;
        light::read(root, &mut reading)?;
        root.finish()
    });
    done?;

    let world = reading.world.build().map_err(|error| source.error(0, "", error.to_string()))?;
    let mut hash = Sha256::new();
    hash.update(source.text.as_bytes());
    hash.update(reads.hash);
    let digest = hash.finalize();
    let hash = digest.iter().take(16).fold(String::new(), |mut hex, byte| {
        write!(hex, "{byte:02x}").expect("writing to memory");
        hex
    });
    let files = [source.file.to_path_buf()].into_iter().chain(reads.files).collect();
    Ok(Scene { world, camera, size, filter, exposure, integrator, samples, hash, files })
}

/// A scene in the channels that it requests.
#[derive(Debug)]
pub enum AnyScene {
    /// Linear sRGB.
    Rgb(Scene),
    /// Up to 8 wavelengths.
    Bands8(Scene<Bands<8>>),
    /// Up to 16 wavelengths.
    Bands16(Scene<Bands<16>>),
    /// Up to 32 wavelengths.
    Bands32(Scene<Bands<32>>),
    /// Polarised light in linear sRGB.
    StokesRgb(Scene<StokesRgb>),
    /// Polarised light of up to 16 wavelengths.
    Stokes16(Scene<Stokes16>),
    /// The energy of polarised light in linear sRGB.
    EnergyRgb(Scene<EnergyRgb>),
    /// The energy of polarised light of up to 16 wavelengths.
    Energy16(Scene<Energy16>),
}

impl AnyScene {
    /// Like [`Scene::open_with_progress`], in the channels that the table `[spectrum]` requests, and with the
    /// integrator of this name, if one is given, instead of the one in the file.
    ///
    /// # Errors
    /// The same as for [`Scene::open`], and if the integrator does not follow such light.
    pub fn open_with_progress(
        path: &Path,
        backend: Backend,
        integrator: Option<&str>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Self, SceneError> {
        let text = text_of(path)?;
        AnyScene::read(path, path.parent().unwrap_or(Path::new("")), &text, backend, integrator, progress)
    }

    /// Like [`Scene::parse`], in the channels that the table `[spectrum]` requests.
    ///
    /// # Errors
    /// The same as for [`open_with_progress`](Self::open_with_progress).
    pub fn parse(file: &Path, folder: &Path, text: &str, backend: Backend) -> Result<Self, SceneError> {
        AnyScene::read(file, folder, text, backend, None, &mut |_| {})
    }

    fn read(
        file: &Path,
        folder: &Path,
        text: &str,
        backend: Backend,
        named: Option<&str>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Self, SceneError> {
        let source = Source { file, text };
        let table = source.table()?;
        let root = Node::new(&source, "", 0, table.get_ref());
        let on = (folder, backend);
        let Some(wanted) = spectrum::read(&root)? else {
            let (mut integrator, samples) = view::integrator(&root)?;
            if let Some(spec) = named.and_then(integrator::named) {
                integrator = (spec.default)();
            }
            return Ok(AnyScene::Rgb(read_in((), (integrator, samples), &root, &source, on, progress)?));
        };
        let (any, samples) = spectrum::integrator(&root, named)?;
        Ok(match (wanted.bands, wanted.stokes) {
            (None, _) if wanted.counts_energy => {
                let any: Arc<dyn Integrator<EnergyRgb>> = any;
                AnyScene::EnergyRgb(read_in((), (any, samples), &root, &source, on, progress)?)
            }
            (Some(bands), true) if wanted.counts_energy => {
                let any: Arc<dyn Integrator<Energy16>> = any;
                AnyScene::Energy16(read_in(bands, (any, samples), &root, &source, on, progress)?)
            }
            (None, _) => {
                let any: Arc<dyn Integrator<StokesRgb>> = any;
                AnyScene::StokesRgb(read_in((), (any, samples), &root, &source, on, progress)?)
            }
            (Some(bands), true) => {
                let any: Arc<dyn Integrator<Stokes16>> = any;
                AnyScene::Stokes16(read_in(bands, (any, samples), &root, &source, on, progress)?)
            }
            (Some(bands), false) if bands.count() <= 8 => {
                let any: Arc<dyn Integrator<Bands<8>>> = any;
                AnyScene::Bands8(read_in(bands, (any, samples), &root, &source, on, progress)?)
            }
            (Some(bands), false) if bands.count() <= 16 => {
                let any: Arc<dyn Integrator<Bands<16>>> = any;
                AnyScene::Bands16(read_in(bands, (any, samples), &root, &source, on, progress)?)
            }
            (Some(bands), false) => {
                let any: Arc<dyn Integrator<Bands<32>>> = any;
                AnyScene::Bands32(read_in(bands, (any, samples), &root, &source, on, progress)?)
            }
        })
    }
}
