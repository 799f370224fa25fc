//! Mueller matrices in specular coordinates, as [tensor files](crate::tensor).
//!
//! Fields: `sigma [S]`, `psi [P]`, `theta [T]` and `phi [F]` in radians, `wavelengths [L]` in nm, and
//! `M [S, P, T, F, L, 4, 4]` in 1/sr, all in 32-bit floats. The Stokes frames are those of [pBSDF](crate::pbsdf): the x
//! axis is the normal of the plane of the two directions.

use std::io;
use std::path::Path;

use lobe_files::{FormatError, unwritable, write_whole};
use lobe_table::specular::AXIS_NAMES;
use lobe_table::{Channels, Data, polarised};

use crate::Document;
use crate::spec::{FormatSpec, Writer, reflection, unfit};
use crate::tensor::{self, Field, TensorFile};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "specular Mueller tensor",
    word: "mueller",
    extensions: &["mueller"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?))),
    read_set: None,
    writer: Some(Writer {
        extensions: &["mueller"],
        holds_channels: |channels| matches!(channels, Channels::Spectral(_)),
        channels: "wavelengths",
        holds: |document| matches!(document.only(), Some(Data::Polarised(_))),
        holds_sheets: false,
        scatter: reflection,
        resampled_as: Ok(polarised::KIND),
        write: |document, path| match document.only() {
            Some(Data::Polarised(data)) => write(data, path),
            _ => Err(unfit(document, path, "Mueller matrices in specular coordinates")),
        },
    }),
};

const WAVELENGTHS: &str = "wavelengths";
const ELEMENTS: &str = "M";

/// `true` if `bytes` are a tensor file with the fields of such matrices.
pub fn matches(bytes: &[u8]) -> bool {
    tensor::matches(bytes)
        && tensor::read(bytes, Path::new(""))
            .is_ok_and(|file| file.get(ELEMENTS).is_some() && file.get(AXIS_NAMES[0]).is_some())
}

/// Reads matrices.
///
/// # Errors
/// [`FormatError`] if the file is not a tensor file, or a field is missing or does not fit the others.
pub fn read(bytes: &[u8], file: &Path) -> Result<polarised::Data, FormatError> {
    let tensors = tensor::read(bytes, file)?;
    let (values, shape) = tensors.floats(ELEMENTS, 7)?;
    if values.is_empty() {
        return Err(tensors.error(ELEMENTS, format!("M as {shape:?}"), "at least one matrix"));
    }
    let axis = |name: &'static str| -> Result<Vec<f64>, FormatError> {
        Ok(tensors.floats(name, 1)?.0.into_iter().map(f64::from).collect())
    };
    let [sigma, psi, theta, phi] = AXIS_NAMES;
    let knots = [axis(sigma)?, axis(psi)?, axis(theta)?, axis(phi)?];
    let wavelengths = axis(WAVELENGTHS)?;
    let expected: Vec<usize> = knots.iter().chain([&wavelengths]).map(Vec::len).chain([4, 4]).collect();
    if shape != expected {
        return Err(tensors.error(ELEMENTS, format!("M as {shape:?}"), format!("{expected:?}")));
    }
    polarised::Data::new(knots, wavelengths, values)
        .map_err(|error| tensors.error(ELEMENTS, error.to_string(), "matrices on a grid"))
}

/// The bytes of a file. Knots are rounded to 32-bit floats.
///
/// # Errors
/// If there are more matrices than the format can count.
pub fn to_bytes(data: &polarised::Data) -> io::Result<Vec<u8>> {
    let rounded = |knots: &[f64]| knots.iter().map(|knot| *knot as f32).collect::<Vec<f32>>();
    let mut shape: Vec<usize> = data.knots().iter().map(Vec::len).collect();
    let mut fields = Vec::new();
    for (name, knots) in AXIS_NAMES.into_iter().zip(data.knots()) {
        fields.push(Field::f32(name, &[knots.len()], &rounded(knots)));
    }
    fields.push(Field::f32(WAVELENGTHS, &[data.wavelengths().len()], &rounded(data.wavelengths())));
    shape.extend([data.wavelengths().len(), 4, 4]);
    fields.push(Field::f32(ELEMENTS, &shape, data.values()));
    TensorFile::new(fields).to_bytes()
}

/// Writes a file, replacing an existing one atomically.
///
/// # Errors
/// [`FormatError`] as [`to_bytes`], and if the file system refuses.
pub fn write(data: &polarised::Data, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(data).map_err(|error| unwritable(path, &error))?)
}
