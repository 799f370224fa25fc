//! The options of a distribution, and the errors if there can be none.

use std::f64::consts::{PI, TAU};

use thiserror::Error;

use super::budget::Budget;
use crate::{Axis, AxisError, Scatter};

/// The options for laying out a [`Distribution`](super::Distribution).
#[derive(Clone, Debug, PartialEq)]
pub struct DistributionOptions {
    /// The kind of scatter: scattered directions are on the side of the incident one, or on the other.
    pub scatter: Scatter,
    /// Polar angles of incidence in radians, ascending in `[0, pi/2]`: at each there is a slice.
    pub sigma: Vec<f64>,
    /// Azimuths of incidence in radians, ascending in `[0, 2 pi)`; one or none if the azimuth does not matter.
    pub psi: Vec<f64>,
    /// Angles from the mirror direction, in radians in `[0, pi]`, between which the light varies little.
    pub theta: Vec<f64>,
    /// The approximate number of steps in azimuth about the mirror direction that resolve the light.
    pub phis: usize,
    /// The most memory to take, except for the coarsest grid.
    pub bytes: usize,
    /// The most values of the function to compute, except for the coarsest grid; if `None`, as many as its finest grid
    /// takes.
    pub evaluations: Option<usize>,
    /// The part of every slice that is a cosine distribution, in `(0, 1]`.
    pub defensive: f32,
}

impl DistributionOptions {
    /// A grid for light about which nothing is known: steps in theta that are finest at the mirror direction, and
    /// slices every 5 degrees, closer at grazing angles; if psi matters, every 10 degrees, and every 22.5 degrees of
    /// psi.
    pub fn unknown(scatter: Scatter, isotropic: bool, bytes: usize) -> Self {
        let (step, last) = if isotropic { (5, 17) } else { (10, 9) };
        let mut sigma: Vec<f64> = (0..last).map(|i| f64::from(step * i).to_radians()).collect();
        sigma.extend([85.0, 88.0, 89.5].map(f64::to_radians));
        let psi = if isotropic { vec![0.0] } else { (0..16).map(|i| f64::from(i) / 16.0 * TAU).collect() };
        let theta = (0..=40).map(|i| PI * (f64::from(i) / 40.0).powi(2)).collect();
        DistributionOptions { scatter, sigma, psi, theta, phis: 128, bytes, evaluations: None, defensive: 0.05 }
    }
}

/// A distribution that cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DistributionError {
    /// A defensive part outside `(0, 1]`.
    #[error("a defensive part of {found}; expected a number in (0, 1]")]
    Defensive {
        /// What was found.
        found: f32,
    },
    /// Knots that cannot form an axis.
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

/// The options that determine the resolution of a distribution (see [`DistributionOptions`]).
pub(super) struct Plan<'a> {
    /// The incident directions of the slices.
    pub(super) sigma: Axis,
    pub(super) psi: Option<Axis>,
    pub(super) theta: &'a [f32],
    pub(super) phis: usize,
    pub(super) bytes: usize,
    pub(super) budget: Budget,
    pub(super) defensive: f32,
}
