//! The explorer: measured materials in a browser, on the same kernels and with the same bits as the program.
//!
//! A [`Session`] holds the files of a page and the materials opened of them. Everything that the page shows is asked of it:
//! facts, findings, curves, maps, pictures, differences, converted files. `border.rs` hands that on to JavaScript as numbers,
//! typed arrays and JSON; it is the only file that is compiled for browsers only, so that the rest is tested like any library.
//! The page itself is in `page/`, and computes nothing that is asked here.
//!
//! Conventions are those of the other crates: directions point away from the surface, normal on +z; angles are radians; values
//! are `f` in 1/sr, without the cosine. Errors are sentences of the libraries.
#![cfg_attr(not(target_arch = "wasm32"), forbid(unsafe_code))]

#[cfg(target_arch = "wasm32")]
mod border;
mod comparison;
mod converted;
mod evaluation;
mod facts;
mod figures;
mod held;
mod hemisphere;
mod request;
mod session;
mod studio;
mod surface;

pub use comparison::{Compared, compare, difference_map};
pub use converted::{Converted, Target, converted, targets};
pub use evaluation::{Evaluator, backends, evaluate};
pub use facts::{Facts, Finding, facts, findings};
pub use figures::{CURVE_ROW, Spectrum, albedo_rows, curve, figure, spectra, table};
pub use held::{Held, MirrorTable};
pub use hemisphere::{Map, Probe, Quantities, map, probe};
pub use request::{Request, Showing};
pub use session::{Opened, Session};
pub use studio::{Ball, Studio, StudioRequest};
pub use surface::{SURFACE_ROW, surface};
