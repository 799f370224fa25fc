//! The kernel of the 2005 paper, as described there, kept for comparison.
//!
//! A. V. Adinetz et al., *Coherent ray tracing for scenes containing objects with complex light-scattering
//! properties*, section 2: an arc cosine of four terms ([`lobe_math::paper`]), a binary search of all lanes at once
//! ([`search`]), texels loaded once for the lanes that share them, and indices kept as floats ([`PaperTable`]). One
//! packet goes from directions to colours before the next starts.
//!
//! [`Table`](crate::specular::Table) gives the same values more accurately, and faster for all but the most coherent
//! packets. Only the report and its tests use this module.

mod angles;
pub mod search;
mod table;
mod texels;

pub use table::{PaperError, PaperTable};
