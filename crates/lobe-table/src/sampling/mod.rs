//! Importance sampling of tables in specular coordinates, with exact densities.
//!
//! For each knot of sigma (and psi) the [`Sampler`] has a histogram of luminance times f times cosine over the
//! scattered hemisphere. The hemisphere is a rectangle in phi and `v = (1 - cos theta) / (1 - cos theta_max(phi))`,
//! where theta_max is the horizon, so no sample is below the horizon and no mass is lost; the Jacobian between solid
//! angle and the rectangle is `1 - cos theta_max(phi)`. Between the knots, the histograms are blended as the table
//! interpolates; their cumulative sums are blended while they are searched, first the rows in phi, then the columns in
//! `v` (inversion of the marginal and the conditional distribution: Pharr, Jakob and Humphreys 2023, *Physically Based
//! Rendering*, appendix A.4; blending of sums as in Dupuy and Jakob 2018, *An adaptive parameterization for efficient
//! material acquisition and rendering*). The map from `u` to directions is continuous in the incident direction and
//! keeps the stratification of `u`.
//!
//! Every histogram includes a share [`SamplerOptions::defensive`] of a cosine distribution, so the density is positive
//! on the whole hemisphere.

mod batches;
mod block;
mod budget;
mod build;
mod distribution;
mod given;
mod grid;
mod histogram;
mod incident;
mod kernels;
mod options;
mod patches;
mod places;
mod queries;
mod reference;
mod sampler;
mod slices;

pub use distribution::Distribution;
pub use given::Given;
pub use kernels::Sampled;
pub use options::{DistributionError, DistributionOptions};
pub use patches::PatchSampler;
pub use sampler::{Sampler, SamplerError, SamplerOptions};
