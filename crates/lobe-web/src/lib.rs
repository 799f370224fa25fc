//! The explorer: measured materials in a browser, on the same kernels and with the same bits as the program.
//!
//! A [`Session`] holds the files of a page and the materials opened from them. From these materials the other functions
//! compute everything that the page shows: facts, findings, curves, maps, pictures, differences and converted files.
//! `border.rs` passes the results to JavaScript as numbers, typed arrays and JSON. It is the only file that is compiled
//! for browsers only, so the rest can be tested like any other library. The page itself, in `page/`, leaves these
//! computations to the library.
//!
//! The conventions are those of the other crates: directions point away from the surface, whose normal is +z; angles
//! are in radians; values are `f` in 1/sr, without the cosine. Errors are the messages of the libraries.
#![cfg_attr(not(target_arch = "wasm32"), forbid(unsafe_code))]

#[cfg(target_arch = "wasm32")]
mod border;
mod comparison;
mod converted;
mod evaluation;
mod facts;
mod figures;
mod half_difference;
mod held;
mod hemisphere;
mod request;
mod session;
mod studio;
mod surface;

pub use comparison::{Compared, compare, difference_map};
pub use converted::{Converted, Target, converted, targets};
pub use evaluation::{Evaluator, backends, evaluate, evaluate_into};
pub use facts::{Facts, Finding, facts, findings};
pub use figures::{CURVE_ROW, Spectrum, albedo_rows, curve, figure, spectra, table};
pub use half_difference::{HalfProbe, half_difference, half_probe};
pub use held::{Held, MirrorRow, MirrorTable};
pub use hemisphere::{Map, Probe, Quantities, Shades, map, probe};
pub use request::{Request, Showing};
pub use session::{Opened, Session};
pub use studio::{Ball, Studio, StudioRequest};
pub use surface::{SURFACE_ROW, surface};
