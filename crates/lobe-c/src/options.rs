//! Options for opening a material, and constants.

use std::ffi::{c_char, c_int};
use std::ptr;

use lobe::{Backend, Edges, Given, Lookup, Options, Scatter, Side};

use crate::border;
use crate::error::Error;

/// Beyond the outermost angles of a table in specular coordinates, the value at the nearest one.
pub const LOBE_EDGES_CLAMP: c_int = 0;
/// Linear extrapolation beyond the ends of all axes; negative values are kept.
pub const LOBE_EDGES_EXTRAPOLATE: c_int = 1;
/// 0 beyond the ends of sigma and theta.
pub const LOBE_EDGES_ZERO: c_int = 2;

/// Grids of half and difference angles (MERL): the value of the bin.
pub const LOBE_LOOKUP_NEAREST: c_int = 0;
/// Linear between the centres of bins.
pub const LOBE_LOOKUP_LINEAR: c_int = 1;

/// The direction to the light is given.
pub const LOBE_GIVEN_LIGHT: c_int = 0;
/// The direction to the viewer is given.
pub const LOBE_GIVEN_VIEWER: c_int = 1;

/// Both directions on the same side.
pub const LOBE_REFLECTION: c_int = 0;
/// The directions on opposite sides.
pub const LOBE_TRANSMISSION: c_int = 1;

/// Light from z > 0.
pub const LOBE_SIDE_FRONT: c_int = 0;
/// Light from z < 0.
pub const LOBE_SIDE_BACK: c_int = 1;

/// Options for opening a material. `lobe_options_default` gives the defaults.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct lobe_options {
    /// The instruction set, by a name from `lobe_backend_name`; NULL means the best that this machine has, or the one
    /// named by the environment variable LOBE_BACKEND.
    pub backend: *const c_char,
    /// Round in the same way on all machines and instruction sets.
    pub strict: bool,
    /// Keep each call on the thread that makes it, as renderers with their own threads need. Otherwise batches of
    /// 16,384 or more queries are shared among threads, with the same bits.
    pub serial: bool,
    /// One of `LOBE_EDGES_...`.
    pub edges: c_int,
    /// One of `LOBE_LOOKUP_...`.
    pub lookup: c_int,
    /// The direction that selects the slice of a material of the EPFL database: one of `LOBE_GIVEN_...`.
    pub indexed_by: c_int,
}

/// The default options.
#[unsafe(no_mangle)]
pub extern "C" fn lobe_options_default() -> lobe_options {
    lobe_options {
        backend: ptr::null(),
        strict: false,
        serial: false,
        edges: LOBE_EDGES_CLAMP,
        lookup: LOBE_LOOKUP_NEAREST,
        indexed_by: LOBE_GIVEN_LIGHT,
    }
}

/// The same, parsed.
#[derive(Debug)]
pub struct Chosen {
    pub options: Options,
    pub backend: Backend,
    pub serial: bool,
}

/// Parses options; null means the default.
///
/// # Errors
/// For a number without a meaning, or a backend that this machine does not have.
///
/// # Safety
/// `options` is null or points to options, whose backend is null or points to text.
pub unsafe fn chosen(options: *const lobe_options) -> Result<Chosen, Error> {
    let options = match options.is_null() {
        true => lobe_options_default(),
        // SAFETY: by the promise of the caller.
        false => *unsafe { border::borrowed(options, "options") }?,
    };
    let edges = match options.edges {
        LOBE_EDGES_CLAMP => Edges::default(),
        LOBE_EDGES_EXTRAPOLATE => Edges::extrapolate(),
        LOBE_EDGES_ZERO => Edges::zero(),
        other => return Err(unknown("edges", other)),
    };
    let lookup = match options.lookup {
        LOBE_LOOKUP_NEAREST => Lookup::Nearest,
        LOBE_LOOKUP_LINEAR => Lookup::Linear,
        other => return Err(unknown("lookup", other)),
    };
    let indexed_by = given(options.indexed_by, "indexed_by")?;
    let backend = match options.backend.is_null() {
        true => Backend::detect()?,
        // SAFETY: by the promise of the caller.
        false => Backend::named(unsafe { border::text(options.backend, "backend") }?)?,
    };
    let backend = if options.strict { backend.strict() } else { backend };
    let serial = options.serial;
    Ok(Chosen { options: Options { edges, lookup, indexed_by, ..Options::default() }, backend, serial })
}

fn unknown(name: &str, found: c_int) -> Error {
    Error::invalid(format!("{name}: found {found}; expected one of its constants"))
}

/// The given direction.
///
/// # Errors
/// If the number has no meaning.
pub fn given(number: c_int, name: &str) -> Result<Given, Error> {
    match number {
        LOBE_GIVEN_LIGHT => Ok(Given::Light),
        LOBE_GIVEN_VIEWER => Ok(Given::Viewer),
        other => Err(unknown(name, other)),
    }
}

/// The kind of scatter and the side of the light; `None` if a number has no meaning.
pub fn aspect(scatter: c_int, side: c_int) -> Option<lobe::Aspect> {
    let scatter = match scatter {
        LOBE_REFLECTION => Scatter::Reflection,
        LOBE_TRANSMISSION => Scatter::Transmission,
        _ => return None,
    };
    let light = match side {
        LOBE_SIDE_FRONT => Side::Front,
        LOBE_SIDE_BACK => Side::Back,
        _ => return None,
    };
    Some(lobe::Aspect { scatter, light })
}
