//! Representations other than specular tables in lanes: the same bits on every backend, and the `f64` reference.

mod common;
mod fourier;
mod half_diff;
mod mueller;
mod polarised;
mod scattered;
mod spherical;
mod utia;
mod window;
mod zernike;
