//! The files of Integra (Lumicept): DDR and DDT, SDR and SDT, and code shared with Zemax tables.

mod common;
pub mod ddr;
pub(crate) mod grid;
pub mod sdr;
pub(crate) mod units;

pub(crate) use common::keep_comments;
