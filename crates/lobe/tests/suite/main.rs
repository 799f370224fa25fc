//! Materials of every kind: their values on every backend, and their samples.

mod examples;
mod golden;
mod golden_representations;
mod material;
mod paper;
mod polarised_sheets;
mod real_files;
mod sampling;
mod threads;
mod zernike;
