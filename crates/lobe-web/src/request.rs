//! The requests of a page: what to show of a material, in words.

use lobe::{Aspect, Scatter, Side};
use lobe_colour::Reduction;
use lobe_plot::{Scaling, View};
use serde::Deserialize;

use crate::Opened;

/// What a page asks to see of a material. Missing entries have defaults that depend on the material.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Request {
    /// `front` or `back`: the side that the light comes from.
    pub side: String,
    /// `reflection` or `transmission`.
    pub scatter: String,
    /// The azimuth of the light in radians.
    pub psi: Option<f64>,
    /// The name of a channel. If it is empty, all channels are reduced to one value.
    pub channel: String,
    /// `linear` or `log`.
    pub scale: String,
    /// The width of figures in pixels; 0 is that of the program. Those of less than 560 are laid out for narrow columns.
    pub width: u32,
}

/// The widths of figures, in pixels.
const NARROWEST: u32 = 280;
const WIDEST: u32 = 4000;

/// A request resolved for a material.
#[derive(Clone, Debug)]
pub struct Showing {
    /// The view of `lobe-plot`.
    pub view: View,
    /// Reflection or transmission.
    pub scatter: Scatter,
    /// The scale of values, linear or logarithmic.
    pub scaling: Scaling,
}

impl Request {
    /// Parses JSON.
    ///
    /// # Errors
    /// If `json` is not valid JSON, or has unknown keys.
    pub fn parse(json: &str) -> Result<Self, String> {
        serde_json::from_str(json).map_err(|error| format!("found an invalid request ({error}); expected JSON"))
    }

    /// Resolves the request for a material.
    ///
    /// # Errors
    /// If a word is unknown, or the material was not measured in the requested way.
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
        if self.width > 0 {
            view.width = self.width.clamp(NARROWEST, WIDEST);
        }
        let scatters = subject.scatters(view.side);
        let words = [("reflection", Scatter::Reflection), ("transmission", Scatter::Transmission)];
        let scatter = match word(&self.scatter, &words)? {
            Some(scatter) if scatters.contains(&scatter) => scatter,
            Some(_) => return Err(format!("found no {}; expected a kind of scatter that was measured", self.scatter)),
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

    /// The reduction of channels to the colours that are shown.
    pub fn colour(&self) -> &Reduction {
        &self.view.colour
    }
}

/// Looks up a word among `words`; `None` if it is empty.
pub(crate) fn word<T: Copy>(word: &str, words: &[(&str, T)]) -> Result<Option<T>, String> {
    if word.is_empty() {
        return Ok(None);
    }
    let known = || words.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", ");
    let found = words.iter().find(|(known, _)| *known == word).map(|(_, meaning)| Some(*meaning));
    found.ok_or_else(|| format!("found {word}; expected one of {}", known()))
}
