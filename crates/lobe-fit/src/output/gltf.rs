//! A glTF file with only one material.

use serde_json::{Value, json};

use super::{Coloured, OutputError};
use crate::fit::Fit;
use crate::model::Model;

const FORMAT: &str = "glTF";

/// The material of a fit of glTF's own model, as the text of a `.gltf` file.
///
/// # Errors
/// [`OutputError`] if glTF does not have the model or the channels.
pub fn gltf(fit: &Fit, name: &str) -> Result<String, OutputError> {
    let found = fit.request.model;
    let extension = match found {
        Model::Gltf => None,
        Model::GltfClearcoat => Some("KHR_materials_clearcoat"),
        Model::GltfSheen => Some("KHR_materials_sheen"),
        _ => {
            let expected = "gltf, gltf-clearcoat and gltf-sheen";
            return Err(OutputError::Model { found: found.name(), expected, format: FORMAT });
        }
    };
    let fit = Coloured::new(fit, FORMAT)?;
    let [r, g, b] = fit.colour("base_color");
    let sheen = if found == Model::GltfSheen { [fit.shape("sheen"); 3] } else { [0.0; 3] };
    let mut material = json!({
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0],
            "metallicFactor": fit.shape("metallic"),
            "roughnessFactor": fit.shape("roughness"),
        },
    });
    let mut file = json!({ "asset": { "version": "2.0", "generator": "lobe" } });
    if let Some(extension) = extension {
        let values: Value = match found {
            Model::GltfClearcoat => json!({
                "clearcoatFactor": fit.shape("clearcoat"),
                "clearcoatRoughnessFactor": fit.shape("clearcoat_roughness"),
            }),
            _ => json!({
                "sheenColorFactor": sheen,
                "sheenRoughnessFactor": fit.shape("sheen_roughness"),
            }),
        };
        material["extensions"] = json!({ extension: values });
        file["extensionsUsed"] = json!([extension]);
    }
    file["materials"] = json!([material]);
    Ok(format!("{file:#}\n"))
}
