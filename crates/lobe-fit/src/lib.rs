//! Fits of models to measured materials: the parameters, their uncertainties, and where the model fails.
//!
//! - [`Model`]: the models, from Lambert to OpenPBR, glTF and the scatter of smooth optics;
//! - [`Measurement`]: pairs of directions and their values, from a file or a program;
//! - [`fit`]: bounded least squares from several starts, with the weights that [`Request`] chooses;
//! - [`Fit`]: estimates with uncertainties, [`Residuals`], and [`Fitted`], a [`Bsdf`](lobe_table::Bsdf) like any other;
//! - [`output`]: parameters as TOML and JSON, materials for MaterialX and glTF, tables for optics programs.
//!
//! Directions point away from the surface, normal on +z; angles are degrees in parameters and radians elsewhere; values
//! are `f` in 1/sr, without the cosine.
#![forbid(unsafe_code)]

mod fit;
mod fitted;
mod geometry;
mod measurement;
mod model;
pub mod output;
mod parameter;
mod problem;
mod real;
mod residuals;
mod uncertainty;
mod weights;

pub use fit::{Estimate, Fit, FitError, Request, fit};
pub use fitted::Fitted;
pub use geometry::Geometry;
pub use measurement::{Measurement, MeasurementError};
pub use model::Model;
pub use parameter::{Parameter, Scope, Spacing};
pub use residuals::{Band, Residuals, residuals};
pub use weights::Weights;
