//! Fits as files: [`json`] and [`toml`] with everything, materials for renderers, tables for optics programs.

mod gltf;
mod materialx;
mod optics;
mod parameters;
mod saved;

use lobe_colour::Channels;
use thiserror::Error;

use crate::fit::Fit;
use crate::model::Model;

pub use gltf::gltf;
pub use materialx::materialx;
pub use optics::{table, total};
pub use parameters::{Report, json, toml};
pub use saved::{Saved, SavedError, read};

/// A fit that cannot be written in a format.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum OutputError {
    /// The format has no such model.
    #[error("found a fit of {found}; expected one of {expected}, which {format} can hold")]
    Model {
        /// The model of the fit.
        found: &'static str,
        /// The models that the format has.
        expected: &'static str,
        /// The name of the format.
        format: &'static str,
    },
    /// The channels are not red, green and blue, nor a single one.
    #[error("found the channels {found}; expected RGB or a single one for {format}")]
    Colour {
        /// The channels of the fit.
        found: String,
        /// The name of the format.
        format: &'static str,
    },
    /// Each channel has its own shape.
    #[error("found one shape per channel; expected one for all channels for {format}")]
    Shapes {
        /// The name of the format.
        format: &'static str,
    },
}

/// A fit that has one shape and a colour.
struct Coloured<'a> {
    fit: &'a Fit,
}

impl<'a> Coloured<'a> {
    fn new(fit: &'a Fit, format: &'static str) -> Result<Self, OutputError> {
        if fit.channels.count() == 3 && fit.channels != Channels::Rgb || !matches!(fit.channels.count(), 1 | 3) {
            return Err(OutputError::Colour { found: fit.channels.names().join(" "), format });
        }
        if fit.request.per_channel && fit.channels.count() > 1 && fit.request.model.shapes() > 0 {
            return Err(OutputError::Shapes { format });
        }
        Ok(Coloured { fit })
    }

    fn model(&self) -> Model {
        self.fit.request.model
    }

    /// A parameter of the shape.
    fn shape(&self, name: &str) -> f64 {
        self.list(name)[0]
    }

    /// A colour; a single channel is grey.
    fn colour(&self, name: &str) -> [f64; 3] {
        let list = self.list(name);
        std::array::from_fn(|channel| list[channel.min(list.len() - 1)])
    }

    fn list(&self, name: &str) -> Vec<f64> {
        let index = self.model().parameters().iter().position(|parameter| parameter.name == name);
        let index = index.unwrap_or_else(|| unreachable!("{} has no parameter {name}", self.model().name()));
        self.fit.fitted.parameters.iter().map(|all| all[index]).collect()
    }
}
