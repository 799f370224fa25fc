//! `.bsdf` files of the EPFL material database (RGL), which are [tensor files](crate::tensor).
//!
//! The fields and their shapes, where P is the number of `phi_i` and T of `theta_i`: `phi_i [P]`, `theta_i [T]`, `ndf
//! [H, W]`, `sigma [H, W]`, `vndf [P, T, H, W]`, `luminance [P, T, H, W]`, and either `rgb [P, T, 3, H, W]` or
//! `wavelengths [L]` with `spectra [P, T, L, H, W]`, all 32-bit floats, and `description`, `jacobian` and, if there is
//! one, `valid` in bytes. Fields may be in any order. Other fields are ignored; [`tensor::read`] returns them.

use crate::spec::{FormatSpec, Writer, reflection, resampled, unfit};
use crate::tensor::{self, DType, Field, TensorFile};
use crate::{Document, Place};
use lobe_files::FormatError;
use lobe_files::{unwritable, write_whole};
use lobe_table::rgl::{self, Images, Parts};
use lobe_table::{Channels, Data};
use std::io;
use std::path::Path;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "RGL BSDF",
    word: "rgl",
    extensions: &["bsdf"],
    matches: tensor::matches,
    read: Some(|bytes, path, _| {
        let data = read(bytes, path)?;
        let description = data.parts().description.clone();
        Ok(Document::new(data).with_source(&[("description", &description)]))
    }),
    read_set: None,
    writer: Some(Writer {
        extensions: &["bsdf"],
        holds_channels: |channels| matches!(channels, Channels::Rgb | Channels::Spectral(_)),
        channels: "R G B or wavelengths",
        holds: |document| matches!(document.only(), Some(Data::Rgl(_))),
        holds_sheets: false,
        scatter: reflection,
        resampled_as: Ok(rgl::KIND),
        write: |document, path| match document.only() {
            Some(Data::Rgl(data)) => match resampled(document) {
                Some(description) => {
                    let described = rgl::Data::new(Parts { description, ..data.clone().into_parts() });
                    let described =
                        described.map_err(|error| FormatError::new(path, Place::File, error.found, error.expected))?;
                    write(&described, path)
                }
                None => write(data, path),
            },
            _ => Err(unfit(document, path, "the parameterisation of the EPFL database")),
        },
    }),
};

/// `true` if `bytes` are a tensor file with the fields of an RGL material.
pub fn matches(bytes: &[u8]) -> bool {
    tensor::matches(bytes)
        && tensor::read(bytes, Path::new("")).is_ok_and(|file| file.get("vndf").is_some() && file.get("ndf").is_some())
}

/// Reads an RGL material.
///
/// # Errors
/// [`FormatError`] if the file is not a tensor file, or a field is missing or does not fit the others.
pub fn read(bytes: &[u8], file: &Path) -> Result<rgl::Data, FormatError> {
    let tensors = tensor::read(bytes, file)?;
    let (phi_i, _) = tensors.floats("phi_i", 1)?;
    let (theta_i, _) = tensors.floats("theta_i", 1)?;
    let incident = [phi_i.len(), theta_i.len()];
    let (channels, spectra) = if tensors.get("spectra").is_some() {
        let (wavelengths, _) = tensors.floats("wavelengths", 1)?;
        (Channels::Spectral(wavelengths.into_iter().map(f64::from).collect()), "spectra")
    } else {
        (Channels::Rgb, "rgb")
    };
    let with_channels = [incident[0], incident[1], channels.count()];
    let bytes_of = |name| -> Result<_, FormatError> { Ok(&*tensors.require(name, DType::U8, 1)?.data) };
    let jacobian = match bytes_of("jacobian")? {
        [flag] => *flag != 0,
        other => return Err(tensors.error("jacobian", format!("{} flags", other.len()), "one")),
    };
    let parts = Parts {
        description: match tensors.get("description") {
            Some(_) => String::from_utf8_lossy(bytes_of("description")?).into_owned(),
            None => String::new(),
        },
        ndf: images(&tensors, "ndf", &[])?,
        sigma: images(&tensors, "sigma", &[])?,
        vndf: images(&tensors, "vndf", &incident)?,
        luminance: images(&tensors, "luminance", &incident)?,
        spectra: images(&tensors, spectra, &with_channels)?,
        channels,
        jacobian,
        valid: match tensors.get("valid") {
            Some(_) => Some(bytes_of("valid")?.to_vec()),
            None => None,
        },
        phi_i,
        theta_i,
    };
    rgl::Data::new(parts).map_err(|invalid| tensors.invalid(invalid))
}

/// A field as images, its leading dimensions checked.
fn images(tensors: &TensorFile<'_>, name: &'static str, leading: &[usize]) -> Result<Images, FormatError> {
    let (texels, shape) = tensors.floats(name, leading.len() + 2)?;
    let (found, size) = shape.split_at(leading.len());
    if found != leading {
        return Err(tensors.error(
            name,
            format!("{name} as {shape:?}"),
            format!("{leading:?} as the first dimensions"),
        ));
    }
    // The data are in the file, so the product of the dimensions fits.
    let slices = leading.iter().product();
    Images::new(name, [slices, size[0], size[1]], texels).map_err(|invalid| tensors.invalid(invalid))
}

/// The bytes of an RGL file.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] if the material does not fit the format.
pub fn to_bytes(rgl: &rgl::Data) -> io::Result<Vec<u8>> {
    let parts = rgl.parts();
    let (p, t) = (parts.phi_i.len(), parts.theta_i.len());
    let images = |name, leading: &[usize], images: &Images| {
        Field::f32(name, &[leading, &images.size()].concat(), images.texels())
    };
    let jacobian = [u8::from(parts.jacobian)];
    let mut fields = vec![
        Field::u8("description", &[parts.description.len()], parts.description.as_bytes()),
        Field::f32("phi_i", &[p], &parts.phi_i),
        Field::f32("theta_i", &[t], &parts.theta_i),
        images("sigma", &[], &parts.sigma),
        images("ndf", &[], &parts.ndf),
        images("vndf", &[p, t], &parts.vndf),
        images("luminance", &[p, t], &parts.luminance),
    ];
    if let Channels::Spectral(nm) = &parts.channels {
        let wavelengths: Vec<f32> = nm.iter().map(|nm| *nm as f32).collect();
        fields.push(Field::f32("wavelengths", &[nm.len()], &wavelengths));
        fields.push(images("spectra", &[p, t, nm.len()], &parts.spectra));
    } else {
        fields.push(images("rgb", &[p, t, 3], &parts.spectra));
    }
    fields.push(Field::u8("jacobian", &[1], &jacobian));
    if let Some(valid) = &parts.valid {
        fields.push(Field::u8("valid", &[valid.len()], valid));
    }
    TensorFile::new(fields).to_bytes()
}

/// Writes an RGL file, replacing an existing one atomically.
///
/// # Errors
/// [`FormatError`] as [`to_bytes`], and if the file system refuses.
pub fn write(rgl: &rgl::Data, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(rgl).map_err(|error| unwritable(path, &error))?)
}
