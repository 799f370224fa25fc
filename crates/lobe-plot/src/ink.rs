//! The colours of series.

use colorous::{Color, Gradient};

/// The colour of one of several series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Ink {
    /// A letter for the kind of the series, and the position among them.
    pub(crate) class: String,
    /// On white.
    pub(crate) light: String,
    /// On a dark page.
    pub(crate) dark: String,
}

impl Ink {
    /// Ordered series, such as incidences: evenly spaced in a perceptually uniform ramp, without its palest end, and on
    /// a dark page without its darkest.
    pub(crate) fn of_order(index: usize, count: usize) -> Self {
        Ink::of_ramp('s', colorous::PLASMA, index, count)
    }

    /// Wavelengths and similar series, in another ramp than incidences.
    pub(crate) fn of_channel(index: usize, count: usize) -> Self {
        Ink::of_ramp('c', colorous::VIRIDIS, index, count)
    }

    /// Red, green and blue.
    pub(crate) fn of_rgb(index: usize) -> Self {
        let (light, dark) = [("#c62828", "#ff7a70"), ("#2e7d32", "#6fcf77"), ("#1f5fc4", "#7db1ff")][index % 3];
        Ink { class: format!("c{index}"), light: light.into(), dark: dark.into() }
    }

    /// Unordered series, such as files: colours that are easily distinguished, also by most colour-blind people
    /// (M. Okabe and K. Ito, "Color Universal Design", 2008).
    pub(crate) fn of_set(index: usize) -> Self {
        const PAIRS: [(&str, &str); 7] = [
            ("#0072b2", "#5cb8ef"),
            ("#d55e00", "#ff8f43"),
            ("#009e73", "#2fd0a3"),
            ("#b0528c", "#e08fc0"),
            ("#b58900", "#f0c541"),
            ("#3a3f45", "#d5dae0"),
            ("#3b9fd6", "#8fd0f5"),
        ];
        let (light, dark) = PAIRS[index % PAIRS.len()];
        Ink { class: format!("f{index}"), light: light.into(), dark: dark.into() }
    }

    fn of_ramp(letter: char, ramp: Gradient, index: usize, count: usize) -> Self {
        let share = if count > 1 { index as f64 / (count - 1) as f64 } else { 0.25 };
        let at = |from: f64, to: f64| hex(ramp.eval_continuous(from + share * (to - from)));
        Ink { class: format!("{letter}{index}"), light: at(0.02, 0.80), dark: at(0.30, 0.98) }
    }

    /// The style from which a page takes the colour for a dark screen.
    pub(crate) fn style(&self) -> String {
        format!("--dark:{}", self.dark)
    }
}

fn hex(colour: Color) -> String {
    format!("#{colour:x}")
}
