//! Pictures whose values are known, and pictures that have to be the same bits.

mod common;
mod direct;
mod environments;
mod examples;
mod files;
mod furnace;
mod identical;
mod lights;
mod scenes;
mod spectra;
