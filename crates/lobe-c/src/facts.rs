//! Facts about materials and about this library.

use std::ffi::{CString, c_char, c_int};
use std::ptr;
use std::sync::OnceLock;

use lobe::Backend;

use crate::border;
use crate::material::{c_string, lobe_material};
use crate::options::aspect;

/// A property of a material, or `fallback` for NULL.
///
/// # Safety
/// `material` is null or a material that lives for `'a`.
unsafe fn of<'a, T>(material: *const lobe_material, fallback: T, ask: impl FnOnce(&'a lobe_material) -> T) -> T {
    // SAFETY: by the promise of the caller.
    match unsafe { border::borrowed(material, "material") } {
        Ok(material) => border::infallible(fallback, || ask(material)),
        Err(_) => fallback,
    }
}

/// The version of this library, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn lobe_version() -> *const c_char {
    static VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// The names of the backends, created once.
fn backends() -> &'static [CString] {
    static NAMES: OnceLock<Vec<CString>> = OnceLock::new();
    NAMES.get_or_init(|| Backend::available().iter().map(|backend| c_string(backend.name())).collect())
}

/// The number of backends that this machine can run.
#[unsafe(no_mangle)]
pub extern "C" fn lobe_backend_count() -> usize {
    border::infallible(0, || backends().len())
}

/// The name of a backend, the slowest first; NULL if the index is too large.
#[unsafe(no_mangle)]
pub extern "C" fn lobe_backend_name(index: usize) -> *const c_char {
    border::infallible(ptr::null(), || backends().get(index).map_or(ptr::null(), |name| name.as_ptr()))
}

/// The name of the backend that evaluates a material; NULL for NULL.
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_material_backend(material: *const lobe_material) -> *const c_char {
    let name = |material: &lobe_material| {
        let name = material.material.backend().name();
        let found = backends().iter().find(|known| known.as_bytes() == name.as_bytes());
        found.map_or(ptr::null(), |name| name.as_ptr())
    };
    // SAFETY: by the promise of the caller.
    unsafe { of(material, ptr::null(), name) }
}

/// The number of channels of a value; 0 for NULL.
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_channel_count(material: *const lobe_material) -> usize {
    // SAFETY: by the promise of the caller.
    unsafe { of(material, 0, |material| material.texts.channels.len()) }
}

/// The name of a channel, which lives as long as the material; NULL if the index is too large.
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_channel_name(material: *const lobe_material, channel: usize) -> *const c_char {
    // SAFETY: by the promise of the caller.
    unsafe { of(material, ptr::null(), |of| of.texts.channels.get(channel).map_or(ptr::null(), |name| name.as_ptr())) }
}

/// The wavelengths of the channels in nm, which live as long as the material; NULL if channels are not wavelengths.
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_wavelengths(material: *const lobe_material) -> *const f64 {
    // SAFETY: by the promise of the caller.
    unsafe { of(material, ptr::null(), |of| of.texts.wavelengths.as_ref().map_or(ptr::null(), |list| list.as_ptr())) }
}

/// The representation, such as "specular table", which lives as long as the material; NULL for NULL.
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_kind(material: *const lobe_material) -> *const c_char {
    // SAFETY: by the promise of the caller.
    unsafe { of(material, ptr::null(), |material| material.texts.kind.as_ptr()) }
}

/// The name of the format of the file, which lives as long as the material; NULL for NULL.
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_format(material: *const lobe_material) -> *const c_char {
    // SAFETY: by the promise of the caller.
    unsafe { of(material, ptr::null(), |of| of.texts.format.as_ref().map_or(ptr::null(), |name| name.as_ptr())) }
}

/// The number of facts in the header of the file.
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_fact_count(material: *const lobe_material) -> usize {
    // SAFETY: by the promise of the caller.
    unsafe { of(material, 0, |material| material.texts.facts.len()) }
}

/// A fact in the header: returns its name and writes its value to `*value`; both live as long as the material. NULL if
/// the index is too large.
///
/// # Safety
/// `material` is NULL or not freed; `value` points to a pointer or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_fact(
    material: *const lobe_material,
    index: usize,
    value: *mut *const c_char,
) -> *const c_char {
    // SAFETY: by the promise of the caller.
    let fact = unsafe { of(material, None, |material| material.texts.facts.get(index)) };
    let Some([name, found]) = fact else { return ptr::null() };
    // SAFETY: by the promise of the caller. If it is null, the value is not needed.
    let _ = unsafe { border::write(value, found.as_ptr(), "value") };
    name.as_ptr()
}

/// True if values do not depend on the rotation of the sample.
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_is_isotropic(material: *const lobe_material) -> bool {
    // SAFETY: by the promise of the caller.
    unsafe { of(material, false, |material| material.material.is_isotropic()) }
}

/// True if there are values for light from a side (`LOBE_SIDE_...`) that is reflected or transmitted
/// (`LOBE_REFLECTION`, `LOBE_TRANSMISSION`).
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_holds(material: *const lobe_material, scatter: c_int, side: c_int) -> bool {
    let Some(aspect) = aspect(scatter, side) else { return false };
    // SAFETY: by the promise of the caller.
    unsafe { of(material, false, |material| material.material.holds(aspect)) }
}

/// The size of the data in memory, in bytes.
///
/// # Safety
/// `material` is NULL or not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_material_bytes(material: *const lobe_material) -> usize {
    // SAFETY: by the promise of the caller.
    unsafe { of(material, 0, |material| material.material.bytes()) }
}
