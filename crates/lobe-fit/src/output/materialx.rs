//! MaterialX documents: `open_pbr_surface`, `gltf_pbr` and, for purely diffuse materials, `standard_surface`.

use super::{Coloured, OutputError};
use crate::fit::Fit;
use crate::model::Model;

const FORMAT: &str = "MaterialX";

/// The material of a fit, as the text of a `.mtlx` file. Colours are linear, with the primaries of Rec. 709.
///
/// # Errors
/// [`OutputError`] if MaterialX does not have the model or the channels.
pub fn materialx(fit: &Fit, name: &str) -> Result<String, OutputError> {
    let model = fit.request.model;
    let refused = || {
        let expected = "openpbr, openpbr-anisotropic, gltf, gltf-clearcoat, gltf-sheen, lambert and oren-nayar";
        OutputError::Model { found: model.name(), expected, format: FORMAT }
    };
    let mut document = Document { before: String::new(), inputs: String::new() };
    let fit = Coloured::new(fit, FORMAT)?;
    let node = match model {
        Model::OpenPbr | Model::OpenPbrAnisotropic => {
            document.float("base_weight", 1.0);
            document.colour("base_color", fit.colour("base_color"));
            for name in ["base_diffuse_roughness", "base_metalness", "specular_roughness", "specular_ior"] {
                document.float(name, fit.shape(name));
            }
            document.float("specular_weight", 1.0);
            document.colour("specular_color", [1.0; 3]);
            if model == Model::OpenPbrAnisotropic {
                let name = "specular_roughness_anisotropy";
                document.float(name, fit.shape(name));
                document.tangent("geometry_tangent", fit.shape("rotation"));
            }
            "open_pbr_surface"
        }
        Model::Gltf | Model::GltfClearcoat | Model::GltfSheen => {
            document.colour("base_color", fit.colour("base_color"));
            for name in ["metallic", "roughness"] {
                document.float(name, fit.shape(name));
            }
            document.float("ior", 1.5);
            if model == Model::GltfClearcoat {
                for name in ["clearcoat", "clearcoat_roughness"] {
                    document.float(name, fit.shape(name));
                }
            }
            if model == Model::GltfSheen {
                document.colour("sheen_color", [fit.shape("sheen"); 3]);
                document.float("sheen_roughness", fit.shape("sheen_roughness"));
            }
            "gltf_pbr"
        }
        Model::Lambert | Model::OrenNayar => {
            document.float("base", 1.0);
            document.colour("base_color", fit.colour("albedo"));
            if model == Model::OrenNayar {
                document.float("diffuse_roughness", fit.shape("roughness").to_radians());
            }
            document.float("specular", 0.0);
            "standard_surface"
        }
        Model::Phong
        | Model::Blinn
        | Model::Ward
        | Model::WardAnisotropic
        | Model::Ggx
        | Model::GgxAnisotropic
        | Model::GgxFresnel
        | Model::Abg
        | Model::HarveyShack
        | Model::KCorrelation => return Err(refused()),
    };
    let name = identifier(name);
    let Document { before, inputs } = document;
    Ok(format!(
        "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n{before}\
         \x20 <{node} name=\"{name}_shader\" type=\"surfaceshader\">\n{inputs}  </{node}>\n\
         \x20 <surfacematerial name=\"{name}\" type=\"material\">\n\
         \x20   <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"{name}_shader\" />\n\
         \x20 </surfacematerial>\n</materialx>\n"
    ))
}

struct Document {
    before: String,
    inputs: String,
}

impl Document {
    fn input(&mut self, name: &str, kind: &str, value: &str) {
        self.inputs += &format!("    <input name=\"{name}\" type=\"{kind}\" {value} />\n");
    }

    fn float(&mut self, name: &str, value: f64) {
        self.input(name, "float", &format!("value=\"{value}\""));
    }

    fn colour(&mut self, name: &str, [r, g, b]: [f64; 3]) {
        self.input(name, "color3", &format!("value=\"{r}, {g}, {b}\""));
    }

    /// The tangent rotated about the normal, counterclockwise as seen from above.
    fn tangent(&mut self, name: &str, degrees: f64) {
        self.before += &format!(
            "  <normal name=\"normal_world\" type=\"vector3\">\n    <input name=\"space\" type=\"string\" value=\"world\" />\n  </normal>\n\
             \x20 <tangent name=\"tangent_world\" type=\"vector3\">\n    <input name=\"space\" type=\"string\" value=\"world\" />\n  </tangent>\n\
             \x20 <rotate3d name=\"tangent_turned\" type=\"vector3\">\n    <input name=\"in\" type=\"vector3\" nodename=\"tangent_world\" />\n\
             \x20   <input name=\"amount\" type=\"float\" value=\"{degrees}\" />\n    <input name=\"axis\" type=\"vector3\" nodename=\"normal_world\" />\n\
             \x20 </rotate3d>\n"
        );
        self.input(name, "vector3", "nodename=\"tangent_turned\"");
    }
}

/// A valid MaterialX name: letters, digits and underscores, not starting with a digit.
fn identifier(name: &str) -> String {
    let word: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') { word } else { format!("material_{word}") }
}
