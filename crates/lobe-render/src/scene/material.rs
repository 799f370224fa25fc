//! `[material.NAME]`: a file of a measured material, or a model by its name.

use std::sync::Arc;

use lobe::{Edges, Lookup, Options};
use lobe_model::{Blinn, Conductor, Ggx, OrenNayar, Phong, Ward};

use super::Reading;
use super::node::{Node, SceneError};
use crate::shader::{Delta, DeltaShader, Evaluate, Lambert, Proxied, Shader, open};

const MODELS: &str = "lambert, mirror, glass, oren-nayar, phong, blinn, ward or conductor";

pub(super) fn read(root: &Node<'_, '_>, reading: &mut Reading<'_>) -> Result<(), SceneError> {
    let Some(all) = root.child("material")? else { return Ok(()) };
    for name in all.keys() {
        let node = all.child(&name)?.expect("a key of the table");
        let shader = match (reading.file(&node, "file")?, node.text("model")?) {
            (Some(path), None) => {
                let options = options(&node)?;
                open(&path, &options).map_err(|error| node.error("file", error.to_string()))?
            }
            (None, Some(model)) => self::model(&node, model)?,
            _ => return Err(node.error("", "found no or too many keys; expected either `file` or `model`")),
        };
        node.finish()?;
        let number = reading.world.material(shader);
        reading.materials.insert(name, number);
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
    Ok(Options { edges, lookup, ..Options::default() })
}

fn model(node: &Node<'_, '_>, name: &str) -> Result<Arc<dyn Shader<3>>, SceneError> {
    let wide = |colour: [f32; 3]| colour.map(f64::from);
    let share = |key: &str| Ok::<_, SceneError>(wide(node.required_colour(key, 1.0)?));
    let exponent = || {
        let found = node.number("exponent", "a number from 0 to 1e5", |x| (0.0..=1e5).contains(&x))?;
        found.ok_or_else(|| node.error("exponent", "found nothing; expected a number"))
    };
    match name {
        "lambert" => Ok(Arc::new(Lambert { albedo: node.required_colour("albedo", 1.0)? })),
        "mirror" => Ok(Arc::new(DeltaShader(Delta::Mirror(node.colour("reflectance", 1.0)?.unwrap_or([1.0; 3]))))),
        "glass" => {
            let index = node.number("eta", "a refractive index from 1 to 5", |x| (1.0..=5.0).contains(&x))?;
            let tint = node.colour("tint", 1.0)?.unwrap_or([1.0; 3]);
            Ok(Arc::new(DeltaShader(Delta::Glass { eta: index.unwrap_or(1.5) as f32, tint })))
        }
        "oren-nayar" => {
            let radians = |x: f64| (0.0..=1.5).contains(&x);
            let roughness = node.number("roughness", "radians from 0 to 1.5", radians)?.unwrap_or(0.3);
            proxied(node, OrenNayar { albedo: share("albedo")?, roughness })
        }
        "phong" => proxied(node, Phong { specular: share("specular")?, exponent: exponent()? }),
        "blinn" => proxied(node, Blinn { specular: share("specular")?, exponent: exponent()? }),
        "ward" => proxied(node, Ward { specular: share("specular")?, alpha: alpha(node)? }),
        "conductor" => {
            let any = |key: &str| Ok::<_, SceneError>(wide(node.required_colour(key, f64::MAX)?));
            proxied(node, Conductor { ggx: Ggx { alpha: alpha(node)? }, eta: any("eta")?, k: any("k")? })
        }
        found => Err(node.error("model", format!("found `{found}`; expected {MODELS}"))),
    }
}

/// Roughness along x and y: `alpha`, and `alpha_y` where it is another one.
fn alpha(node: &Node<'_, '_>) -> Result<[f64; 2], SceneError> {
    let read = |key: &str| node.number(key, "a number from 0.001 to 1", |x| (0.001..=1.0).contains(&x));
    let x = read("alpha")?.ok_or_else(|| node.error("alpha", "found nothing; expected a number"))?;
    Ok([x, read("alpha_y")?.unwrap_or(x)])
}

fn proxied(node: &Node<'_, '_>, model: impl Evaluate + 'static) -> Result<Arc<dyn Shader<3>>, SceneError> {
    let shader = Proxied::new(model).map_err(|error| node.error("model", error.to_string()))?;
    Ok(Arc::new(shader))
}
