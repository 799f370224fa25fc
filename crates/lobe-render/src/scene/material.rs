//! `[material.NAME]`: a file of a measured material, or a model by name.

use std::fmt::Debug;
use std::sync::Arc;

use lobe::formats::{Document, FormatError};
use lobe::table::Uses;
use lobe::{Edges, Given, Lookup, Options};
use lobe_model::{Blinn, Coated, Ggx, Model, OrenNayar, Phong, RoughMirrors, Ward, is_isotropic};
use lobe_spectrum::{Glass, Metal, Spectrum};

use super::Reading;
use super::film::{Behind as Under, Coat};
use super::index::{Index, glass};
use super::node::{Node, SceneError};
use crate::channels::Channels;
use crate::shader::{
    Behind, BsdfShader, Delta, DeltaShader, Lambert, RoughConductor, RoughFilm, RoughMetal, Shader, Together,
};
use crate::shader::{MaterialError, from_document_in, open_sheet_in};
use crate::shader::{RoughPlastic, Surface};
use crate::transport::Transport;

const MODELS: &str =
    "lambert, mirror, glass, film, polariser, retarder, oren-nayar, phong, blinn, ward, conductor or plastic";

pub(super) fn read<T: Transport>(root: &Node<'_, '_>, reading: &mut Reading<'_, T>) -> Result<(), SceneError> {
    let Some(all) = root.child("material")? else { return Ok(()) };
    let names = all.keys();
    let count = names.len() as f64;
    for (index, name) in names.into_iter().enumerate() {
        // Building the distributions of directions takes most of the time.
        let done = |progress: &mut dyn FnMut(f64), done: usize, all: usize| {
            progress((index as f64 + done as f64 / all.max(1) as f64) / count);
        };
        let node = all.child(&name)?.expect("a key of the table");
        let (file, model) = (reading.file(&node, "file")?, node.text("model")?);
        let (front, back) = (reading.files(&node, "front")?, reading.files(&node, "back")?);
        let shader = match (file, model, front.len() + back.len()) {
            (Some(path), None, 0) => {
                let refused = |error: MaterialError| node.error("file", error.to_string());
                let (_, document) = lobe::formats::open(&path).map_err(|error| refused(error.into()))?;
                check_options(&node, &[&document])?;
                let mut watch = |part: usize, all: usize| done(reading.progress, part, all);
                let (basis, options) = (reading.world.basis(), options(&node)?);
                from_document_in(basis, &document, &path, &options, reading.backend, None, &mut watch)
                    .map_err(refused)?
                    .shader
            }
            (None, None, 1..) => {
                let key = if front.is_empty() { "back" } else { "front" };
                if OPTIONS.iter().any(|option| node.has(option.key)) {
                    let documents = front.iter().chain(&back).map(|path| Ok(lobe::formats::open(path)?.1));
                    let documents = documents.collect::<Result<Vec<Document>, FormatError>>();
                    let documents = documents.map_err(|error| node.error(key, error.to_string()))?;
                    check_options(&node, &documents.iter().collect::<Vec<_>>())?;
                }
                let mut watch = |part: usize, all: usize| done(reading.progress, part, all);
                open_sheet_in(reading.world.basis(), &front, &back, &options(&node)?, reading.backend, &mut watch)
                    .map_err(|error| node.error(key, error.to_string()))?
            }
            (None, Some(name), 0) => model_named(&node, name, reading)?,
            _ => {
                let message = "found no or too many keys; expected either `file`, `model`, or `front` and `back`";
                return Err(node.error("", message));
            }
        };
        node.finish()?;
        let number = reading.world.material(shader);
        reading.materials.insert(name, number);
    }
    Ok(())
}

/// A key that only some representations use.
struct MaterialOption {
    key: &'static str,
    applies: fn(Uses) -> bool,
    expected: &'static str,
}

const OPTIONS: [MaterialOption; 3] = [
    MaterialOption { key: "edge", applies: |uses| uses.edges, expected: "a table in specular coordinates" },
    MaterialOption { key: "lookup", applies: |uses| uses.lookup, expected: "a grid of half and difference angles" },
    MaterialOption { key: "indexed_by", applies: |uses| uses.indexed_by, expected: "a material of the EPFL database" },
];

/// Refuses keys that would make no difference, because their author expects one.
fn check_options(node: &Node<'_, '_>, documents: &[&Document]) -> Result<(), SceneError> {
    let uses = documents.iter().fold(Uses::default(), |uses, document| uses.or(document.uses()));
    let Some(option) = OPTIONS.iter().find(|option| node.has(option.key) && !(option.applies)(uses)) else {
        return Ok(());
    };
    let kinds: Vec<String> = documents.iter().map(|document| document.kinds()).collect();
    Err(node.error(option.key, format!("found {}; expected {}", kinds.join(", "), option.expected)))
}

/// Choices that a file leaves open.
fn options(node: &Node<'_, '_>) -> Result<Options, SceneError> {
    let edges = match node.text("edge")? {
        None | Some("clamp") => Edges::default(),
        Some("extrapolate") => Edges::extrapolate(),
        Some("zero") => Edges::zero(),
        Some(found) => {
            return Err(node.error("edge", format!("found `{found}`; expected clamp, extrapolate or zero")));
        }
    };
    let lookup = match node.text("lookup")? {
        None | Some("linear") => Lookup::Linear,
        Some("nearest") => Lookup::Nearest,
        Some(found) => return Err(node.error("lookup", format!("found `{found}`; expected linear or nearest"))),
    };
    let indexed_by = match node.text("indexed_by")? {
        None | Some("viewer") => Given::Viewer,
        Some("light") => Given::Light,
        Some(found) => return Err(node.error("indexed_by", format!("found `{found}`; expected viewer or light"))),
    };
    Ok(Options { edges, lookup, indexed_by, ..Options::default() })
}

fn model_named<T: Transport>(
    node: &Node<'_, '_>,
    name: &str,
    reading: &Reading<'_, T>,
) -> Result<Arc<dyn Shader<T>>, SceneError> {
    let (basis, backend) = (reading.world.basis(), reading.backend);
    let white = T::reflectance(basis, [1.0; 3]);
    let share = |key: &str| reading.required_share(node, key);
    let exponent = || {
        let found = node.number("exponent", "a number from 0 to 1e5", |x| (0.0..=1e5).contains(&x))?;
        found.ok_or_else(|| node.error("exponent", "found nothing; expected a number"))
    };
    let axis = || Ok::<f32, SceneError>(node.number("angle", "degrees", |x| x.abs() <= 3600.0)?.unwrap_or(0.0) as f32);
    match name {
        "lambert" => {
            let albedo = share("albedo")?;
            Ok(Arc::new(Lambert::new(albedo, backend).with_colour(T::colour_of(basis, albedo))))
        }
        "mirror" => {
            if let Some(metal) = metal(node)? {
                if let Some(coat) = Coat::of(node)? {
                    let table = coat.table(reading, &Under::Metal(&metal));
                    return Ok(Arc::new(DeltaShader(Delta::Film {
                        table,
                        behind: Behind::Metal,
                        tint: T::Spectrum::ONE,
                    })));
                }
                let [eta, k] = [&metal.n, &metal.k].map(|index| T::sampled(basis, index));
                return Ok(Arc::new(DeltaShader(Delta::Metal { eta, k })));
            }
            Ok(Arc::new(DeltaShader(Delta::Mirror(reading.share(node, "reflectance")?.unwrap_or(white)))))
        }
        "glass" => {
            let tint = reading.share(node, "tint")?.unwrap_or(white);
            if let Some(coat) = Coat::of(node)? {
                let Index::Constant(eta) = glass(node)? else {
                    let found = "found a film on glass that disperses";
                    return Err(node.error("film", format!("{found}; expected glass with `eta`")));
                };
                let (table, behind) = (coat.table(reading, &Under::Glass(eta)), Behind::Glass(eta as f32));
                return Ok(Arc::new(DeltaShader(Delta::Film { table, behind, tint })));
            }
            Ok(Arc::new(DeltaShader(match glass(node)? {
                Index::Constant(eta) => Delta::Glass { eta: eta as f32, tint },
                Index::Formula(glass) => match T::wavelengths(basis) {
                    None => Delta::Glass { eta: index_at(node, &glass, YELLOW)? as f32, tint },
                    Some(wavelengths) => {
                        let mut eta = T::Spectrum::ZERO;
                        for (eta, nm) in eta.as_mut().iter_mut().zip(wavelengths) {
                            *eta = index_at(node, &glass, *nm)? as f32;
                        }
                        Delta::Dispersive { eta, tint }
                    }
                },
            })))
        }
        "film" => {
            let tint = reading.share(node, "tint")?.unwrap_or(white);
            let table = Coat::read(node)?.table(reading, &Under::Air);
            Ok(Arc::new(DeltaShader(Delta::Film { table, behind: Behind::Nothing, tint })))
        }
        "polariser" => {
            let tint = reading.share(node, "tint")?.unwrap_or(white);
            Ok(Arc::new(DeltaShader(Delta::Polariser { angle: axis()?.to_radians(), tint })))
        }
        "retarder" => {
            let retardance = node.number("retardance", "degrees from 0 to 360", |x| (0.0..=360.0).contains(&x))?;
            let retardance = retardance.unwrap_or(90.0).to_radians() as f32;
            Ok(Arc::new(DeltaShader(Delta::Retarder { angle: axis()?.to_radians(), retardance })))
        }
        "oren-nayar" => {
            let radians = |x: f64| (0.0..=1.5).contains(&x);
            let roughness = node.number("roughness", "radians from 0 to 1.5", radians)?.unwrap_or(0.3);
            let albedo = share("albedo")?;
            modelled(node, reading, |three| OrenNayar { albedo: of(&albedo, three), roughness })
        }
        "phong" => {
            let (specular, exponent) = (share("specular")?, exponent()?);
            modelled(node, reading, |three| Phong { specular: of(&specular, three), exponent })
        }
        "blinn" => {
            let (specular, exponent) = (share("specular")?, exponent()?);
            modelled(node, reading, |three| Blinn { specular: of(&specular, three), exponent })
        }
        "ward" => {
            let (specular, alpha) = (share("specular")?, alpha(node)?);
            modelled(node, reading, |three| Ward { specular: of(&specular, three), alpha })
        }
        "conductor" => {
            let ggx = Ggx { alpha: alpha(node)? };
            let metal = match metal(node)? {
                Some(metal) => metal,
                None => Metal { n: indices(node, "eta")?, k: indices(node, "k")? },
            };
            if let Some(coat) = Coat::of(node)? {
                let (table, channels) = (coat.table(reading, &Under::Metal(&metal)), channels(reading));
                let film = RoughFilm { ggx, table, channels };
                let isotropic = ggx.alpha[0] == ggx.alpha[1];
                let shader = BsdfShader::<T>::model_in(basis, film, isotropic, backend);
                return Ok(Arc::new(shader.map_err(|error| node.error("model", error.to_string()))?));
            }
            let [eta, k] = [&metal.n, &metal.k].map(|index| T::sampled(basis, index));
            rough_metal(node, reading, ggx, [eta, k])
        }
        "plastic" => {
            let index = node.number("eta", "a refractive index from 1 to 5", |x| (1.0..=5.0).contains(&x))?;
            let (albedo, ggx) = (share("albedo")?, Ggx { alpha: alpha(node)? });
            let eta = index.unwrap_or(1.5);
            let coat = Coat::of(node)?;
            if T::POLARISED || coat.is_some() {
                let surface = match coat {
                    Some(coat) => Surface::Film(coat.table(reading, &Under::Glass(eta))),
                    None => Surface::Bare(eta),
                };
                let plastic = RoughPlastic { ggx, surface, albedo, channels: channels(reading) };
                let isotropic = ggx.alpha[0] == ggx.alpha[1];
                let shader = BsdfShader::<T>::model_in(basis, plastic, isotropic, backend);
                return Ok(Arc::new(shader.map_err(|error| node.error("model", error.to_string()))?));
            }
            let base = |three| lobe_model::Lambert { albedo: of(&albedo, three) };
            modelled(node, reading, |three| Coated { base: base(three), ggx, eta })
        }
        found => Err(node.error("model", format!("found `{found}`; expected {MODELS}"))),
    }
}

/// Three channels of a spectrum.
fn of<S: Channels>(spectrum: &S, three: [usize; 3]) -> [f64; 3] {
    three.map(|channel| f64::from(spectrum.as_ref()[channel]))
}

/// The helium line d, at which catalogues give refractive indices, in nm.
const YELLOW: f64 = 587.561_8;

fn index_at(node: &Node<'_, '_>, glass: &Glass, nm: f64) -> Result<f64, SceneError> {
    let index = glass.index(nm);
    if (1.0..=5.0).contains(&index) {
        return Ok(index);
    }
    Err(node.error("", format!("found the refractive index {index} at {nm} nm; expected one from 1 to 5")))
}

/// A metal by name.
fn metal(node: &Node<'_, '_>) -> Result<Option<Metal>, SceneError> {
    let Some(name) = node.text("metal")? else { return Ok(None) };
    Metal::named(name).map(Some).ok_or_else(|| {
        let known: Vec<&str> = Metal::names().collect();
        node.error("metal", format!("found `{name}`; expected one of {}", known.join(", ")))
    })
}

/// Refractive indices of red, green and blue, at 610, 550 and 465 nm, or one for all.
fn indices(node: &Node<'_, '_>, key: &str) -> Result<Spectrum, SceneError> {
    let [red, green, blue] = node.required_colour(key, f64::MAX)?.map(f64::from);
    Spectrum::new(vec![465.0, 550.0, 610.0], vec![blue, green, red]).map_err(|error| node.error(key, error.to_string()))
}

/// The names of the channels of a picture, for models.
fn channels<T: Transport>(reading: &Reading<'_, T>) -> lobe::Channels {
    match T::wavelengths(reading.world.basis()) {
        Some(wavelengths) => lobe::Channels::Spectral(wavelengths.to_vec()),
        None => lobe::Channels::Rgb,
    }
}

/// Roughness along x and y: `alpha`, and `alpha_y` if it differs.
fn alpha(node: &Node<'_, '_>) -> Result<[f64; 2], SceneError> {
    let read = |key: &str| node.number(key, "a number from 0.001 to 1", |x| (0.001..=1.0).contains(&x));
    let x = read("alpha")?.ok_or_else(|| node.error("alpha", "found nothing; expected a number"))?;
    Ok([x, read("alpha_y")?.unwrap_or(x)])
}

/// A model; `make` gets its parameters for three channels at a time.
fn modelled<T: Transport, M: Model + Debug + Send + Sync + 'static>(
    node: &Node<'_, '_>,
    reading: &Reading<'_, T>,
    make: impl Fn([usize; 3]) -> M,
) -> Result<Arc<dyn Shader<T>>, SceneError> {
    let (basis, backend) = (reading.world.basis(), reading.backend);
    let first = lobe_model::Rgb(make([0, 1, 2].map(|channel: usize| channel.min(T::Spectrum::COUNT - 1))));
    let isotropic = is_isotropic(&first);
    let shader = match channels(reading) {
        lobe::Channels::Rgb => BsdfShader::<T>::model_in(basis, first, isotropic, backend),
        channels => BsdfShader::<T>::model_in(basis, Together::new(channels, make), isotropic, backend),
    };
    Ok(Arc::new(shader.map_err(|error| node.error("model", error.to_string()))?))
}

/// A rough metal, which polarises light if the transport has polarisation.
fn rough_metal<T: Transport>(
    node: &Node<'_, '_>,
    reading: &Reading<'_, T>,
    ggx: Ggx,
    index: [T::Spectrum; 2],
) -> Result<Arc<dyn Shader<T>>, SceneError> {
    let (basis, backend, channels) = (reading.world.basis(), reading.backend, channels(reading));
    let isotropic = ggx.alpha[0] == ggx.alpha[1];
    let [eta, k] = index.map(|index| -> Vec<f64> {
        index.as_ref().iter().take(channels.count()).map(|value| f64::from(*value)).collect()
    });
    let shader = if T::POLARISED {
        let mirrors = RoughMirrors { ggx, index: eta.into_iter().zip(k).map(|(n, k)| [n, k]).collect() };
        BsdfShader::<T>::model_in(basis, RoughMetal { mirrors, channels }, isotropic, backend)
    } else {
        BsdfShader::<T>::model_in(basis, RoughConductor { ggx, eta, k, channels }, isotropic, backend)
    };
    Ok(Arc::new(shader.map_err(|error| node.error("model", error.to_string()))?))
}
