//! Measured materials for C and C++: implements the functions that `include/lobe.h` declares.
//!
//! Handles are opaque and reference-counted. Functions that can fail return a code and describe the error in a struct
//! of the caller ([`lobe_error`]). No panic leaves this crate, because every function runs inside `border::guarded`.
//! The facade evaluates materials.
#![allow(non_camel_case_types, reason = "names of C")]

mod border;
mod directions;
mod error;
mod facts;
mod material;
mod options;
mod sampler;

pub use directions::{lobe_directions, lobe_values};
pub use error::{
    LOBE_ERROR_FORMAT, LOBE_ERROR_INTERNAL, LOBE_ERROR_INVALID, LOBE_ERROR_UNSUPPORTED, LOBE_MESSAGE_LENGTH, LOBE_OK,
    lobe_error, lobe_status,
};
pub use facts::{
    lobe_backend_count, lobe_backend_name, lobe_channel_count, lobe_channel_name, lobe_fact, lobe_fact_count,
    lobe_format, lobe_holds, lobe_is_isotropic, lobe_kind, lobe_material_backend, lobe_material_bytes, lobe_version,
    lobe_wavelengths,
};
pub use material::{
    lobe_eval, lobe_material, lobe_material_free, lobe_material_share, lobe_mueller, lobe_open, lobe_open_bytes,
};
pub use options::{
    LOBE_EDGES_CLAMP, LOBE_EDGES_EXTRAPOLATE, LOBE_EDGES_ZERO, LOBE_GIVEN_LIGHT, LOBE_GIVEN_VIEWER, LOBE_LOOKUP_LINEAR,
    LOBE_LOOKUP_NEAREST, LOBE_REFLECTION, LOBE_SIDE_BACK, LOBE_SIDE_FRONT, LOBE_TRANSMISSION, lobe_options,
    lobe_options_default,
};
pub use sampler::{lobe_pdf, lobe_sample, lobe_sampler, lobe_sampler_free, lobe_sampler_new};
