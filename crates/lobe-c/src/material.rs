//! Opens, shares and evaluates materials.

use std::ffi::{CString, c_char};
use std::sync::Arc;

use lobe::Material;
use lobe::formats::{self, Document};

use crate::border;
use crate::directions::{AT_ONCE, Readable, Writable, lobe_directions, lobe_values};
use crate::error::{Error, LOBE_ERROR_UNSUPPORTED, lobe_error, lobe_status};
use crate::options::{Chosen, chosen, lobe_options};

/// A measured material, in the representation in which it was measured. Threads may share it.
#[derive(Clone, Debug)]
pub struct lobe_material {
    pub(crate) material: Arc<Material>,
    pub(crate) texts: Arc<Texts>,
    pub(crate) serial: bool,
}

/// Texts that C can read as long as there is a handle.
#[derive(Debug)]
pub struct Texts {
    pub kind: CString,
    pub format: Option<CString>,
    pub channels: Vec<CString>,
    pub facts: Vec<[CString; 2]>,
    pub wavelengths: Option<Vec<f64>>,
}

/// Text up to its first zero; text from files has none, because readers escape them.
pub fn c_string(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

impl lobe_material {
    fn new(document: &Document, chosen: Chosen, file: Option<&str>) -> Result<Self, Error> {
        let Chosen { options, backend, serial } = chosen;
        let material = Material::from_document(document, &options);
        let material = material.map_err(|error| match file {
            Some(file) => error.in_file(file.as_ref()),
            None => error,
        })?;
        let material = material.with_backend(backend);
        let texts = Texts {
            kind: c_string(material.kind().name()),
            format: material.format().map(c_string),
            channels: material.channels().names().iter().map(|name| c_string(name)).collect(),
            facts: material.source().iter().map(|(name, value)| [c_string(name), c_string(value)]).collect(),
            wavelengths: material.wavelengths().map(<[f64]>::to_vec),
        };
        Ok(lobe_material { material: Arc::new(material), texts: Arc::new(texts), serial })
    }
}

/// Opens the file of a measured material, of any format, which is detected from the content. `options` may be NULL.
/// `*material` is set only if this returns LOBE_OK; free it with `lobe_material_free`.
///
/// # Safety
/// `path` is text; `options` is NULL or points to options; `material` points to a pointer, and `error` to an error or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_open(
    path: *const c_char,
    options: *const lobe_options,
    material: *mut *mut lobe_material,
    error: *mut lobe_error,
) -> lobe_status {
    // SAFETY: by the promises of the caller, which are those that the called functions require.
    unsafe {
        border::guarded(error, || {
            let path = border::text(path, "path")?;
            let chosen = chosen(options)?;
            border::check(material, "material")?;
            let (_, document) = formats::open(path.as_ref())?;
            let made = lobe_material::new(&document, chosen, Some(path))?;
            border::write(material, Box::into_raw(Box::new(made)), "material")
        })
    }
}

/// Opens a material from the content of a file in memory, which is not used after the call. `name` is the name of the
/// file in errors; its extension matters only if the format is not clear from the content. Everything else is as in
/// `lobe_open`.
///
/// # Safety
/// `data` points to `size` bytes; everything else is as in `lobe_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_open_bytes(
    data: *const u8,
    size: usize,
    name: *const c_char,
    options: *const lobe_options,
    material: *mut *mut lobe_material,
    error: *mut lobe_error,
) -> lobe_status {
    // SAFETY: by the promises of the caller, which are those that the called functions require.
    unsafe {
        border::guarded(error, || {
            let bytes = border::slice(data, size, "data")?;
            let name = border::text(name, "name")?;
            let chosen = chosen(options)?;
            border::check(material, "material")?;
            let document = formats::from_bytes(bytes, name.as_ref())?;
            let made = lobe_material::new(&document, chosen, Some(name))?;
            border::write(material, Box::into_raw(Box::new(made)), "material")
        })
    }
}

/// Another handle to the same material, which must also be freed; NULL for NULL.
///
/// # Safety
/// `material` is NULL or a material that is not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_material_share(material: *const lobe_material) -> *mut lobe_material {
    // SAFETY: by the promise of the caller.
    let shared = unsafe { border::borrowed(material, "material") };
    border::infallible(std::ptr::null_mut(), || match shared {
        Ok(material) => Box::into_raw(Box::new(material.clone())),
        Err(_) => std::ptr::null_mut(),
    })
}

/// Frees a handle; does nothing for NULL. Samplers of the material and other handles stay valid.
///
/// # Safety
/// `material` is NULL or a handle that is not freed, and no other thread uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_material_free(material: *mut lobe_material) {
    border::infallible((), || {
        if !material.is_null() {
            // SAFETY: a handle was made from a box, and by the promise of the caller it is freed once.
            drop(unsafe { Box::from_raw(material) });
        }
    });
}

/// Evaluates f in 1/sr, without the cosine, for `count` pairs of directions.
///
/// # Safety
/// `material` is not freed; `wi` and `wo` are `count` directions, and `values` has room for as many queries of all channels,
/// which overlap nothing; `error` points to an error or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_eval(
    material: *const lobe_material,
    count: usize,
    wi: lobe_directions,
    wo: lobe_directions,
    values: lobe_values,
    error: *mut lobe_error,
) -> lobe_status {
    // SAFETY: by the promises of the caller, which are those that the called functions require.
    unsafe {
        border::guarded(error, || {
            let material = border::borrowed(material, "material")?;
            let (wi, wo) = (wi.readable(count, "wi")?, wo.readable(count, "wo")?);
            let values = values.writable(count, material.material.channel_count(), "values")?;
            eval(material, count, [wi, wo], values);
            Ok(())
        })
    }
}

fn eval(of: &lobe_material, count: usize, [wi, wo]: [Readable<'_>; 2], mut values: Writable<'_>) {
    let material = &*of.material;
    let run = |wi: lobe::Directions<'_>, wo: lobe::Directions<'_>, out: &mut [f32]| match of.serial {
        true => material.bsdf().eval_batch(material.backend(), wi, wo, out),
        false => material.eval_batch(wi, wo, out),
    };
    if let (Some(wi), Some(wo), Some(out)) = (wi.placed(), wo.placed(), values.placed()) {
        return run(wi, wo, out);
    }
    // Enough to share among threads.
    let at_once = if of.serial { AT_ONCE } else { 16 * AT_ONCE }.min(count);
    let mut rows = [vec![[0.0; 3]; at_once], vec![[0.0; 3]; at_once]];
    let mut out = vec![0.0; at_once * material.channel_count()];
    let mut at = 0;
    while at < count {
        let size = at_once.min(count - at);
        let [light, viewer] = &mut rows;
        wi.copy(at, &mut light[..size]);
        wo.copy(at, &mut viewer[..size]);
        let out = &mut out[..size * material.channel_count()];
        run((&light[..size]).into(), (&viewer[..size]).into(), out);
        values.copy(at, out);
        at += size;
    }
}

/// The Mueller matrix in 1/sr for light from `wi` to `wo` at a wavelength in nm: 16 numbers, row by row. Returns
/// LOBE_ERROR_UNSUPPORTED if the material has no polarisation.
///
/// # Safety
/// `material` is not freed; `wi` and `wo` point to 3 numbers and `matrix` to room for 16; `error` points to an error or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_mueller(
    material: *const lobe_material,
    wi: *const f32,
    wo: *const f32,
    wavelength: f64,
    matrix: *mut f64,
    error: *mut lobe_error,
) -> lobe_status {
    // SAFETY: by the promises of the caller, which are those that the called functions require.
    unsafe {
        border::guarded(error, || {
            let material = border::borrowed(material, "material")?;
            let wi = border::borrowed(wi.cast::<[f32; 3]>(), "wi")?;
            let wo = border::borrowed(wo.cast::<[f32; 3]>(), "wo")?;
            let out = border::slice_mut(matrix, 16, "matrix")?;
            let found = material.material.mueller(*wi, *wo, wavelength).ok_or_else(|| {
                let kind = material.material.kind();
                Error::new(LOBE_ERROR_UNSUPPORTED, format!("found {kind}; expected a material with polarisation"))
            })?;
            out.copy_from_slice(found.as_flattened());
            Ok(())
        })
    }
}
