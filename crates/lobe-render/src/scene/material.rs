//! `[material.NAME]`: a file of a measured material, or a model by its name.

use std::fmt::Debug;
use std::sync::Arc;

use lobe::formats::{Document, FormatError};
use lobe::table::Uses;
use lobe::{Edges, Given, Lookup, Options};
use lobe_model::{Blinn, Coated, Conductor, Ggx, Model, OrenNayar, Phong, Ward};

use super::Reading;
use super::node::{Node, SceneError};
use crate::shader::{Backend, BsdfShader, Delta, DeltaShader, Lambert, Shader};
use crate::shader::{MaterialError, from_document, open_sheet_with_progress};
use crate::transport::Rgb;

const MODELS: &str = "lambert, mirror, glass, oren-nayar, phong, blinn, ward, conductor or plastic";

pub(super) fn read(root: &Node<'_, '_>, reading: &mut Reading<'_>) -> Result<(), SceneError> {
    let Some(all) = root.child("material")? else { return Ok(()) };
    let names = all.keys();
    let count = names.len() as f64;
    for (index, name) in names.into_iter().enumerate() {
        // Distributions of directions are what takes time.
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
                from_document(&document, &path, &options(&node)?, reading.backend, None, &mut watch).map_err(refused)?
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
                open_sheet_with_progress(&front, &back, &options(&node)?, reading.backend, &mut watch)
                    .map_err(|error| node.error(key, error.to_string()))?
            }
            (None, Some(name), 0) => model_named(&node, name, reading.backend)?,
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

/// A key that only some representations look at.
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

/// Refuses what would make no difference: whoever asks for it expects one.
fn check_options(node: &Node<'_, '_>, documents: &[&Document]) -> Result<(), SceneError> {
    let uses = documents.iter().fold(Uses::default(), |uses, document| uses.or(document.uses()));
    for option in OPTIONS.iter().filter(|option| node.has(option.key) && !(option.applies)(uses)) {
        let kinds: Vec<String> = documents.iter().map(|document| document.kinds()).collect();
        let message = format!("found {}; expected {}", kinds.join(", "), option.expected);
        return Err(node.error(option.key, message));
    }
    Ok(())
}

/// What a file leaves open.
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

fn model_named(node: &Node<'_, '_>, name: &str, backend: Backend) -> Result<Arc<dyn Shader>, SceneError> {
    let wide = |colour: [f32; 3]| colour.map(f64::from);
    let share = |key: &str| Ok::<_, SceneError>(wide(node.required_colour(key, 1.0)?));
    let exponent = || {
        let found = node.number("exponent", "a number from 0 to 1e5", |x| (0.0..=1e5).contains(&x))?;
        found.ok_or_else(|| node.error("exponent", "found nothing; expected a number"))
    };
    match name {
        "lambert" => Ok(Arc::new(Lambert::new(node.required_colour("albedo", 1.0)?, backend))),
        "mirror" => Ok(Arc::new(DeltaShader(Delta::Mirror(node.colour("reflectance", 1.0)?.unwrap_or([1.0; 3]))))),
        "glass" => {
            let index = node.number("eta", "a refractive index from 1 to 5", |x| (1.0..=5.0).contains(&x))?;
            let tint = node.colour("tint", 1.0)?.unwrap_or([1.0; 3]);
            Ok(Arc::new(DeltaShader(Delta::Glass { eta: index.unwrap_or(1.5) as f32, tint })))
        }
        "oren-nayar" => {
            let radians = |x: f64| (0.0..=1.5).contains(&x);
            let roughness = node.number("roughness", "radians from 0 to 1.5", radians)?.unwrap_or(0.3);
            modelled(node, backend, OrenNayar { albedo: share("albedo")?, roughness })
        }
        "phong" => modelled(node, backend, Phong { specular: share("specular")?, exponent: exponent()? }),
        "blinn" => modelled(node, backend, Blinn { specular: share("specular")?, exponent: exponent()? }),
        "ward" => modelled(node, backend, Ward { specular: share("specular")?, alpha: alpha(node)? }),
        "conductor" => {
            let any = |key: &str| Ok::<_, SceneError>(wide(node.required_colour(key, f64::MAX)?));
            modelled(node, backend, Conductor { ggx: Ggx { alpha: alpha(node)? }, eta: any("eta")?, k: any("k")? })
        }
        "plastic" => {
            let index = node.number("eta", "a refractive index from 1 to 5", |x| (1.0..=5.0).contains(&x))?;
            let base = lobe_model::Lambert { albedo: share("albedo")? };
            let coat = Coated { base, ggx: Ggx { alpha: alpha(node)? }, eta: index.unwrap_or(1.5) };
            modelled(node, backend, coat)
        }
        found => Err(node.error("model", format!("found `{found}`; expected {MODELS}"))),
    }
}

/// Roughness along x and y: `alpha`, and `alpha_y` if it differs.
fn alpha(node: &Node<'_, '_>) -> Result<[f64; 2], SceneError> {
    let read = |key: &str| node.number(key, "a number from 0.001 to 1", |x| (0.001..=1.0).contains(&x));
    let x = read("alpha")?.ok_or_else(|| node.error("alpha", "found nothing; expected a number"))?;
    Ok([x, read("alpha_y")?.unwrap_or(x)])
}

fn modelled(
    node: &Node<'_, '_>,
    backend: Backend,
    model: impl Model + Debug + Send + Sync + 'static,
) -> Result<Arc<dyn Shader>, SceneError> {
    let shader = BsdfShader::<Rgb>::model(model, backend).map_err(|error| node.error("model", error.to_string()))?;
    Ok(Arc::new(shader))
}
