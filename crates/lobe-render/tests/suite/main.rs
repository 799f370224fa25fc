//! Tests with pictures whose values are known, and with pictures that must have the same bits.

mod bsdf;
mod common;
mod direct;
mod environments;
mod examples;
mod files;
mod films;
mod furnace;
mod identical;
mod lights;
mod polarised_lights;
mod scenes;
mod spectra;
mod spectral_furnace;
mod steps;
