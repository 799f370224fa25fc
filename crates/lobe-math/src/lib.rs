//! Inverse trigonometry, and a root, over any [`lobe_lane`] backend.
//!
//! Every function is a polynomial with a stated largest error, [`bounds`], which the tests enforce and
//! `cargo xtask sweep` checks over every `f32` of the domain. Angles are radians.
//!
//! | function | method |
//! |---|---|
//! | [`acos`], [`asin`] | eight terms, Abramowitz and Stegun 4.4.46 (asin near zero: an odd minimax polynomial) |
//! | [`acos_from`] | the same polynomial with `1 - abs(c)` from a caller that knows it without cancellation |
//! | [`paper::acos`], [`paper::asin`] | four terms, the form of the 2005 paper, for comparison |
//! | [`atan2`], [`azimuth`], [`double_atan`] | odd minimax polynomial of eight terms, of half the angle |
//! | [`fifth_root`] | three steps of Newton's method from a fifth of the exponent |
//! | [`sin_cos`] | reduction by pi/2 in three parts and two minimax polynomials |
//!
//! Everything is `#[inline(always)]`: call it from inside [`Lanes::vectorize`](lobe_lane::Lanes::vectorize).
#![no_std]
#![forbid(unsafe_code)]

mod acos;
mod atan2;
pub mod bounds;
pub mod paper;
mod poly;
mod root;
mod sin_cos;

pub use acos::{acos, acos_from, asin};
pub use atan2::{atan2, azimuth, azimuth_from, double_atan, polar_from};
pub use root::fifth_root;
pub use sin_cos::sin_cos;
