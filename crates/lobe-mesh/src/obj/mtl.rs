//! Reads MTL, the material libraries of OBJ.

use std::path::{Path, PathBuf};

use lobe_files::FormatError;

use super::line::Line;
use crate::file;

/// A material of a library, which a renderer may use in place of a measured one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// Its name, to which `usemtl` refers.
    pub name: String,
    /// Diffuse reflectance, RGB (`Kd`).
    pub diffuse: Option<[f32; 3]>,
    /// Specular reflectance, RGB (`Ks`).
    pub specular: Option<[f32; 3]>,
    /// Emitted colour, RGB (`Ke`).
    pub emission: Option<[f32; 3]>,
    /// Exponent of the highlight (`Ns`).
    pub exponent: Option<f32>,
    /// Index of refraction (`Ni`).
    pub refraction: Option<f32>,
    /// 1 for opaque, 0 for invisible (`d`, or 1 - `Tr`).
    pub opacity: Option<f32>,
    /// Image of the diffuse reflectance (`map_Kd`), as the file names it.
    pub diffuse_map: Option<PathBuf>,
}

/// Reads a library.
///
/// # Errors
/// The file cannot be read, or a line is wrong.
pub fn materials(path: &Path) -> Result<Vec<Material>, FormatError> {
    parse(path, &file::bytes(path)?)
}

/// Reads the content of a library; `path` is only for messages.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Vec<Material>, FormatError> {
    let mut materials: Vec<Material> = Vec::new();
    for (number, bytes) in super::line::whole(bytes) {
        let mut line = Line::new(path, number, &bytes);
        let Some(keyword) = line.word() else { continue };
        if keyword == "newmtl" {
            materials.push(Material { name: line.name()?, ..Material::default() });
        } else if let Some(material) = materials.last_mut() {
            entry(material, keyword, &mut line)?;
        } else {
            return Err(line.wrong(format!("`{keyword}`"), "newmtl and a name first"));
        }
    }
    Ok(materials)
}

fn entry(material: &mut Material, keyword: &str, line: &mut Line<'_>) -> Result<(), FormatError> {
    match keyword {
        "Kd" => material.diffuse = Some(colour(line)?),
        "Ks" => material.specular = Some(colour(line)?),
        "Ke" => material.emission = Some(colour(line)?),
        "Ns" => material.exponent = Some(line.numbers::<1>("an exponent")?[0]),
        "Ni" => material.refraction = Some(line.numbers::<1>("an index of refraction")?[0]),
        "d" => material.opacity = Some(line.numbers::<1>("an opacity")?[0]),
        "Tr" => material.opacity = Some(1.0 - line.numbers::<1>("a transparency")?[0]),
        // Options come first, so the name is the last word. Names with spaces cannot be distinguished from options.
        "map_Kd" => material.diffuse_map = line.name()?.split(' ').next_back().map(Into::into),
        _ => {}
    }
    Ok(())
}

/// RGB; a single number means three equal ones.
fn colour(line: &mut Line<'_>) -> Result<[f32; 3], FormatError> {
    let [red] = line.numbers("RGB")?;
    match line.word() {
        None => Ok([red; 3]),
        Some(green) => {
            let green = line.number(green)?;
            let [blue] = line.numbers("RGB")?;
            Ok([red, green, blue])
        }
    }
}
