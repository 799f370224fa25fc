//! What a distribution is laid out for, and why there may be none.

use std::f64::consts::{PI, TAU};

use thiserror::Error;

use crate::{Axis, AxisError, Scatter};

/// What a [`Distribution`](super::Distribution) is laid out for.
#[derive(Clone, Debug, PartialEq)]
pub struct DistributionOptions {
    /// Whether scattered directions lie on the side of the incident one, or on the other.
    pub scatter: Scatter,
    /// Polar angles of incidence in radians, ascending in `[0, pi/2]`: at each there is a slice.
    pub sigma: Vec<f64>,
    /// Azimuths of incidence in radians, ascending in `[0, 2 pi)`; one or none if the azimuth does not count.
    pub psi: Vec<f64>,
    /// Angles from the mirror direction, radians in `[0, pi]`, between which the light varies little.
    pub theta: Vec<f64>,
    /// About how many steps in azimuth about the mirror direction it takes to follow the light.
    pub phis: usize,
    /// The most memory to take, except for the coarsest grid.
    pub bytes: usize,
    /// The part of every slice that is a cosine distribution, in `(0, 1]`.
    pub defensive: f32,
}

impl DistributionOptions {
    /// A grid for light of which nothing is known: steps in theta that are finest at the mirror direction, and slices
    /// every 5 degrees and closer at grazing; if psi counts, every 10 degrees, and of psi every 22.5.
    pub fn unknown(scatter: Scatter, isotropic: bool, bytes: usize) -> Self {
        let (step, last) = if isotropic { (5, 17) } else { (10, 9) };
        let mut sigma: Vec<f64> = (0..last).map(|i| f64::from(step * i).to_radians()).collect();
        sigma.extend([85.0, 88.0, 89.5].map(f64::to_radians));
        let psi = if isotropic { vec![0.0] } else { (0..16).map(|i| f64::from(i) / 16.0 * TAU).collect() };
        let theta = (0..=40).map(|i| PI * (f64::from(i) / 40.0).powi(2)).collect();
        DistributionOptions { scatter, sigma, psi, theta, phis: 128, bytes, defensive: 0.05 }
    }
}

/// Why there is no distribution.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DistributionError {
    /// A defensive part outside of `(0, 1]`.
    #[error("a defensive part of {found}; expected a number in (0, 1]")]
    Defensive {
        /// What was found.
        found: f32,
    },
    /// Knots that do not make an axis.
    #[error("{axis} of the distribution: {source}")]
    Axis {
        /// Which axis.
        axis: &'static str,
        /// What is wrong with it.
        source: AxisError,
    },
    /// Edges of a grid that single precision cannot distinguish.
    #[error("the grid of the distribution: {source}")]
    Grid {
        /// What is wrong with it.
        source: AxisError,
    },
}

/// What decides how fine a distribution is (see [`DistributionOptions`]).
pub(super) struct Plan<'a> {
    /// The incident directions of the slices.
    pub(super) sigma: Axis,
    pub(super) psi: Option<Axis>,
    pub(super) theta: &'a [f32],
    pub(super) phis: usize,
    pub(super) bytes: usize,
    pub(super) defensive: f32,
}
