//! Materials of every kind: what they evaluate to, on every backend, and how they are sampled.

mod examples;
mod golden;
mod golden_representations;
mod material;
mod paper;
mod real_files;
mod sampling;
mod threads;
mod zernike;
