//! Reads fits that were saved as JSON.

use std::collections::BTreeMap;

use lobe_colour::Channels;
use lobe_ops::Aspect;
use serde::Deserialize;
use thiserror::Error;

use crate::fitted::Fitted;
use crate::model::Model;

/// The reason why a text is not a fit.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SavedError {
    /// The text is not JSON with the entries of a fit.
    #[error("found other text ({0}); expected JSON written by `lobe fit -o FIT.json`")]
    Json(String),
    /// A name is unknown, or numbers are missing.
    #[error("found {found}; expected {expected}")]
    Entry {
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
}

impl Saved {
    /// The measurement that was fitted.
    pub fn aspect(&self) -> Aspect {
        self.fitted.aspect
    }
}

/// A saved fit.
#[derive(Clone, Debug)]
pub struct Saved {
    /// The model with its parameters.
    pub fitted: Fitted,
    /// The names of the channels that it was fitted to.
    pub channels: Vec<String>,
    /// Names and values for readers: the parameters with their uncertainties, and the residuals.
    pub facts: Vec<(String, String)>,
}

/// A number, or one per channel; null if it is unknown.
#[derive(Deserialize)]
#[serde(untagged)]
enum Entry {
    One(Option<f64>),
    Each(Vec<Option<f64>>),
}

impl Entry {
    fn of(&self, channel: usize) -> Option<f64> {
        match self {
            Entry::One(value) => *value,
            Entry::Each(values) => values.get(channel).copied().flatten(),
        }
    }

    fn count(&self) -> usize {
        match self {
            Entry::One(_) => 1,
            Entry::Each(values) => values.len(),
        }
    }
}

#[derive(Deserialize)]
struct Whole {
    model: String,
    aspect: String,
    channels: Vec<String>,
    wavelengths: Option<Vec<f64>>,
    weights: String,
    parameters: BTreeMap<String, Entry>,
    uncertainties: BTreeMap<String, Entry>,
    residuals: Sizes,
}

#[derive(Deserialize)]
struct Sizes {
    max: f64,
    rms: f64,
    relative_rms: f64,
    log_rms: f64,
}

/// Reads a fit from JSON.
///
/// # Errors
/// [`SavedError`] if the text is not a fit.
pub fn read(text: &str) -> Result<Saved, SavedError> {
    let whole: Whole = serde_json::from_str(text).map_err(|error| SavedError::Json(error.to_string()))?;
    let refuse = |found: String, expected: &str| SavedError::Entry { found, expected: expected.into() };
    let model = Model::named(&whole.model).ok_or_else(|| {
        let names = Model::ALL.map(|model| model.name()).join(", ");
        refuse(format!("the model {:?}", whole.model), &names)
    })?;
    let aspect = Aspect::ALL.into_iter().find(|aspect| aspect.to_string() == whole.aspect);
    let aspect =
        aspect.ok_or_else(|| refuse(format!("the aspect {:?}", whole.aspect), "an aspect such as reflection front"))?;
    let count = whole.channels.len();
    if count == 0 {
        return Err(refuse("no channels".into(), "at least one"));
    }
    let mut parameters = vec![Vec::new(); count];
    for parameter in model.parameters() {
        let entry = whole.parameters.get(parameter.name);
        let entry = entry.filter(|entry| entry.count() == 1 || entry.count() == count);
        for (channel, parameters) in parameters.iter_mut().enumerate() {
            let value = entry.and_then(|entry| entry.of(channel)).filter(|value| value.is_finite());
            let missing = || refuse(format!("no {} of channel {channel}", parameter.name), "a number for each channel");
            parameters.push(value.ok_or_else(missing)?);
        }
    }
    let wavelengths = whole.wavelengths.as_deref();
    if wavelengths.is_some_and(|wavelengths| wavelengths.len() != count) {
        return Err(refuse("a number of wavelengths other than that of channels".into(), "one per channel"));
    }
    let fitted = Fitted {
        model,
        aspect,
        channels: channels(&whole.channels),
        wavelengths: wavelengths.map_or_else(|| vec![f64::NAN; count], <[f64]>::to_vec),
        parameters,
    };
    Ok(Saved { fitted, facts: facts(&whole, model), channels: whole.channels })
}

/// The meaning of the names of channels.
fn channels(names: &[String]) -> Channels {
    let is = |wanted: &[&str]| names.iter().map(String::as_str).eq(wanted.iter().copied());
    let wavelength = |name: &String| name.strip_suffix("nm").and_then(|digits| digits.trim().parse().ok());
    match names.iter().map(wavelength).collect::<Option<Vec<f64>>>() {
        Some(wavelengths) => Channels::Spectral(wavelengths),
        None if is(&["R", "G", "B"]) => Channels::Rgb,
        None if is(&["X", "Y", "Z"]) => Channels::Xyz,
        None if names.len() == 1 => Channels::Mono,
        None => Channels::Named(names.to_vec()),
    }
}

fn facts(whole: &Whole, model: Model) -> Vec<(String, String)> {
    let mut facts = vec![("model".into(), whole.model.clone()), ("measurement".into(), whole.aspect.clone())];
    for parameter in model.parameters() {
        let [value, uncertainty] = [&whole.parameters, &whole.uncertainties].map(|table| table.get(parameter.name));
        let Some(value) = value else { continue };
        let words = (0..value.count()).filter_map(|channel| {
            let sigma = uncertainty.and_then(|uncertainty| uncertainty.of(channel));
            let sigma = sigma.map_or(String::new(), |sigma| format!(" ± {sigma:.2e}"));
            Some(format!("{:.4}{sigma}", value.of(channel)?))
        });
        facts.push((parameter.name.into(), words.collect::<Vec<_>>().join(", ")));
    }
    let Sizes { max, rms, relative_rms, log_rms } = whole.residuals;
    facts.push(("weights".into(), whole.weights.clone()));
    facts.push(("largest difference".into(), format!("{max:.4e} 1/sr")));
    facts.push(("rms difference".into(), format!("{rms:.4e} 1/sr, {:.2} % of the values", 100.0 * relative_rms)));
    facts.push(("rms of logarithms".into(), format!("{log_rms:.3}")));
    facts
}
