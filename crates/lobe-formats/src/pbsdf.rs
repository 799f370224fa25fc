//! `.pbsdf` files of polarised reflection (Baek et al. 2020, KAIST), which are [tensor files](crate::tensor).
//!
//! Fields: `theta_h [1, H]`, `theta_d [1, D]`, `phi_d [1, P]` in radians and `M [P, D, H, L, 4, 4]` in 32-bit floats,
//! and `wvls [L]` in nm as `u16`. Some files give the angles the shape `[0, n]` and do not store them; then they are
//! assumed to be uniform over a quarter turn, and `phi_d` over a full turn from `-pi`.

use crate::Document;
use crate::spec::{FormatSpec, Writer, reflection, unfit};
use crate::tensor::{self, DType, Field, TensorFile};
use lobe_files::FormatError;
use lobe_files::{unwritable, write_whole};
use lobe_table::mueller::{self, AXES};
use lobe_table::{Channels, Data};
use std::f32::consts::{FRAC_PI_2, PI};
use std::io;
use std::path::Path;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "KAIST pBSDF",
    word: "pbsdf",
    extensions: &["pbsdf"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?))),
    read_set: None,
    writer: Some(Writer {
        extensions: &["pbsdf"],
        holds_channels: |channels| matches!(channels, Channels::Spectral(_)),
        channels: "wavelengths",
        holds: |document| matches!(document.only(), Some(Data::Mueller(_))),
        holds_sheets: false,
        scatter: reflection,
        resampled_as: Ok(mueller::KIND),
        write: |document, path| match document.only() {
            Some(Data::Mueller(data)) => write(data, path),
            _ => Err(unfit(document, path, "Mueller matrices")),
        },
    }),
};

/// `true` if `bytes` are a tensor file with the fields of a polarised material.
pub fn matches(bytes: &[u8]) -> bool {
    tensor::matches(bytes)
        && tensor::read(bytes, Path::new("")).is_ok_and(|file| file.get("M").is_some() && file.get("theta_h").is_some())
}

/// Reads a polarised material.
///
/// # Errors
/// [`FormatError`] if the file is not a tensor file, or a field is missing or does not fit the others.
pub fn read(bytes: &[u8], file: &Path) -> Result<mueller::Data, FormatError> {
    let tensors = tensor::read(bytes, file)?;
    let (values, shape) = tensors.floats("M", 6)?;
    // With a dimension of zero, the others could be anything, and are not checked below.
    if values.is_empty() {
        return Err(tensors.error("M", format!("M as {shape:?}"), "at least one matrix"));
    }
    let wavelengths = tensors.require("wvls", DType::U16, 1)?;
    let (wavelengths, _) = wavelengths.data.as_chunks();
    let knots = [
        angles(&tensors, AXES[0], shape[0], -PI, PI)?,
        angles(&tensors, AXES[1], shape[1], 0.0, FRAC_PI_2)?,
        angles(&tensors, AXES[2], shape[2], 0.0, FRAC_PI_2)?,
        wavelengths.iter().map(|nm| f32::from(u16::from_le_bytes(*nm))).collect(),
    ];
    let expected: Vec<usize> = knots.iter().map(Vec::len).chain([4, 4]).collect();
    if shape != expected {
        return Err(tensors.error("M", format!("M as {shape:?}"), format!("{expected:?}")));
    }
    mueller::Data::new(knots, values).map_err(|invalid| tensors.invalid(invalid))
}

/// The `n` knots of an axis, over `[low, high]` if the file has none.
fn angles(tensors: &TensorFile<'_>, name: &str, n: usize, low: f32, high: f32) -> Result<Vec<f32>, FormatError> {
    let (knots, shape) = tensors.floats(name, 2)?;
    match *shape {
        [0, declared] if declared == n && n > 1 => {
            Ok((0..n).map(|i| low + (high - low) * i as f32 / (n - 1) as f32).collect())
        }
        [1, declared] if declared == n => Ok(knots),
        _ => Err(tensors.error(name, format!("{name} as {shape:?}"), format!("[1, {n}], as M has it"))),
    }
}

/// The bytes of a `.pbsdf` file.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] if a wavelength is not a whole number of nm below 65536.
pub fn to_bytes(material: &mueller::Data) -> io::Result<Vec<u8>> {
    let [p, d, h, nm] = material.knots();
    if let Some(bad) = nm.iter().find(|nm| f32::from(**nm as u16) != **nm) {
        let why = format!("wavelength {bad} nm; the format has whole numbers of nm");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
    }
    let wavelengths: Vec<u8> = nm.iter().flat_map(|nm| (*nm as u16).to_le_bytes()).collect();
    TensorFile::new(vec![
        Field::f32("theta_h", &[1, h.len()], h),
        Field::f32("theta_d", &[1, d.len()], d),
        Field::f32("phi_d", &[1, p.len()], p),
        Field::u16("wvls", &[nm.len()], &wavelengths),
        Field::f32("M", &[p.len(), d.len(), h.len(), nm.len(), 4, 4], material.values()),
    ])
    .to_bytes()
}

/// Writes a `.pbsdf` file, replacing an existing one atomically.
///
/// # Errors
/// [`FormatError`] as [`to_bytes`], and if the file system refuses.
pub fn write(material: &mueller::Data, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(material).map_err(|error| unwritable(path, &error))?)
}
