//! What a page asks to see, in words.

use lobe::{Aspect, Scatter, Side};
use lobe_colour::Reduction;
use lobe_plot::{Scaling, View};
use serde::Deserialize;

use crate::Opened;

/// What to show of a material, as a page says it; what it leaves out is chosen.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Request {
    /// `front` or `back`: the side that the light comes from.
    pub side: String,
    /// `reflection` or `transmission`.
    pub scatter: String,
    /// The azimuth of the light in radians.
    pub psi: Option<f64>,
    /// The name of a channel; all of them as one number if it is empty.
    pub channel: String,
    /// `linear` or `log`.
    pub scale: String,
}

/// A request that a material can answer.
#[derive(Clone, Debug)]
pub struct Showing {
    /// The view of `lobe-plot`.
    pub view: View,
    /// Reflection or transmission.
    pub scatter: Scatter,
    /// How values are spread.
    pub scaling: Scaling,
}

impl Request {
    /// From JSON.
    ///
    /// # Errors
    /// If it is none, or of other keys.
    pub fn parse(json: &str) -> Result<Self, String> {
        serde_json::from_str(json).map_err(|error| format!("found a request that is none ({error}); expected JSON"))
    }

    /// What it means for a material.
    ///
    /// # Errors
    /// If a word is unknown, or the material has nothing like it.
    pub fn of(&self, opened: &Opened) -> Result<Showing, String> {
        let subject = &opened.subject;
        let mut view = View::new(subject);
        if let Some(side) = word(&self.side, &[("front", Side::Front), ("back", Side::Back)])? {
            view = view.lit_from(subject, side).map_err(|error| error.to_string())?;
        }
        if !self.channel.is_empty() {
            view = view.channel(subject, &self.channel).map_err(|error| error.to_string())?;
        }
        if let Some(psi) = self.psi.filter(|psi| psi.is_finite()) {
            view.psi = psi;
        }
        view.scaling = word(&self.scale, &[("linear", Scaling::Linear), ("log", Scaling::Log)])?;
        let scatters = subject.scatters(view.side);
        let words = [("reflection", Scatter::Reflection), ("transmission", Scatter::Transmission)];
        let scatter = match word(&self.scatter, &words)? {
            Some(scatter) if scatters.contains(&scatter) => scatter,
            Some(_) => return Err(format!("found no {}; expected what was measured", self.scatter)),
            None => scatters.first().copied().unwrap_or(Scatter::Reflection),
        };
        Ok(Showing { scaling: view.scaling.unwrap_or(Scaling::Log), view, scatter })
    }
}

impl Showing {
    /// The side and the kind of scatter.
    pub fn aspect(&self) -> Aspect {
        Aspect { scatter: self.scatter, light: self.view.side }
    }

    /// The colours that are shown.
    pub fn colour(&self) -> &Reduction {
        &self.view.colour
    }
}

/// What a word means; nothing if it is empty.
pub(crate) fn word<T: Copy>(word: &str, words: &[(&str, T)]) -> Result<Option<T>, String> {
    if word.is_empty() {
        return Ok(None);
    }
    let known = || words.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", ");
    let found = words.iter().find(|(known, _)| *known == word).map(|(_, meaning)| Some(*meaning));
    found.ok_or_else(|| format!("found {word}; expected one of {}", known()))
}
