//! The files of Integra (Lumicept): DDR and DDT, SDR and SDT, and what Zemax tables have in common with them.

mod common;
pub mod ddr;
pub(crate) mod grid;
pub mod sdr;
pub(crate) mod units;

pub(crate) use common::keep_comments;
