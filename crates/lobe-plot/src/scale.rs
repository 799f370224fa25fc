//! Axes of values and their ticks.

/// The scaling of values along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scaling {
    /// Equal ratios have equal lengths.
    Log,
    /// Equal differences have equal lengths.
    Linear,
}

/// A logarithmic axis spans at most this factor; smaller values are noise.
const DEEPEST: f64 = 1e-6;

/// A linear axis begins at 0 if the values below 0 are smaller than this share of the largest.
const NOISE: f64 = 0.02;

/// A tick on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    /// `None` for a minor tick. A power has the form `10^{-2}`.
    pub(crate) label: Option<String>,
}

/// An axis of values from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// How values are spread along it.
    pub scaling: Scaling,
    /// The value at its low end; above 0 on a logarithmic axis.
    pub low: f64,
    /// The value at its high end.
    pub high: f64,
}

impl Scale {
    /// An axis that covers all values, with ends at round numbers.
    pub fn around(values: impl Iterator<Item = f64>, scaling: Scaling) -> Self {
        let (mut least, mut most, mut least_positive) = (0.0_f64, 0.0_f64, f64::INFINITY);
        for value in values.filter(|value| value.is_finite()) {
            least = least.min(value);
            most = most.max(value);
            if value > 0.0 {
                least_positive = least_positive.min(value);
            }
        }
        if most <= 0.0 && (least >= 0.0 || scaling == Scaling::Log) {
            // There is nothing to show, on any axis.
            return Scale { scaling, low: if scaling == Scaling::Log { 0.1 } else { 0.0 }, high: 1.0 };
        }
        match scaling {
            Scaling::Log => {
                let high = round_up(most);
                let low = round_down(least_positive.max(most * DEEPEST)).min(high / 10.0);
                Scale { scaling, low, high }
            }
            Scaling::Linear => {
                // Noise below 0 is not worth a step.
                let least = if -least < NOISE * most { 0.0 } else { least };
                let mut step = step(most - least);
                // Rounding may lengthen the axis so much that the steps become longer.
                loop {
                    let high = (most / step * (1.0 - 1e-9)).ceil() * step;
                    let low = (least / step).floor() * step;
                    match self::step(high - low) {
                        longer if longer > step => step = longer,
                        _ => return Scale { scaling, low, high },
                    }
                }
            }
        }
    }

    /// A logarithmic axis from one positive value to a larger one.
    pub(crate) fn between(low: f64, high: f64) -> Self {
        Scale { scaling: Scaling::Log, low, high }
    }

    /// The position of a value: 0 at the low end, 1 at the high end. Values without a logarithm are far below 0.
    pub fn place(&self, value: f64) -> f64 {
        match self.scaling {
            Scaling::Linear => (value - self.low) / (self.high - self.low),
            Scaling::Log if value > 0.0 => ((value / self.low).ln() / (self.high / self.low).ln()).max(-1.0),
            Scaling::Log => -1.0,
        }
    }

    /// The value at a position.
    #[cfg(test)]
    pub(crate) fn value(&self, place: f64) -> f64 {
        match self.scaling {
            Scaling::Linear => self.low + place * (self.high - self.low),
            Scaling::Log => self.low * (self.high / self.low).powf(place),
        }
    }

    /// The ticks, ascending: at least two with labels. None on an axis without extent.
    pub(crate) fn ticks(&self) -> Vec<Tick> {
        let has_extent = self.high > self.low;
        match self.scaling {
            _ if !has_extent => Vec::new(),
            Scaling::Linear => self.linear_ticks(),
            Scaling::Log => {
                let ticks = self.log_ticks();
                // A part of a decade may contain hardly any round numbers.
                let labels = ticks.iter().filter(|tick| tick.label.is_some()).count();
                if labels < 3 { self.linear_ticks() } else { ticks }
            }
        }
    }

    fn linear_ticks(&self) -> Vec<Tick> {
        let step = step(self.high - self.low);
        let (first, last) = ((self.low / step - 1e-6).ceil() as i64, (self.high / step + 1e-6).floor() as i64);
        let power = exponent(self.high.abs().max(self.low.abs()));
        let tick = |n: i64| {
            let value = n as f64 * step;
            let label = match power {
                _ if n == 0 => "0".into(),
                // Plain numbers, if they are short.
                -3..=4 => format!("{value:.*}", (-exponent(step)).max(0) as usize),
                _ => {
                    let digits = (power - exponent(step)).max(0) as usize;
                    format!("{:.digits$}·10^{{{power}}}", value / 10_f64.powi(power))
                }
            };
            Tick { value, label: Some(minus(&label)) }
        };
        (first..=last).map(tick).collect()
    }

    fn log_ticks(&self) -> Vec<Tick> {
        let (first, last) = (exponent(self.low), exponent(self.high));
        let decades = (self.high / self.low).log10();
        // Powers of ten alone would leave a short axis empty.
        let labelled: &[u32] = match decades {
            decades if decades < 2.2 => &[1, 2, 5],
            _ => &[1],
        };
        let mut ticks = Vec::new();
        for exponent in first..=last {
            for digit in 1..10 {
                let value = f64::from(digit) * 10_f64.powi(exponent);
                if value < self.low * (1.0 - 1e-9) || value > self.high * (1.0 + 1e-9) {
                    continue;
                }
                let label = labelled.contains(&digit).then(|| power(digit, exponent));
                ticks.push(Tick { value, label });
            }
        }
        ticks
    }
}

/// A digit times a power of ten: a plain number if that is short.
fn power(digit: u32, exponent: i32) -> String {
    match exponent {
        0..=2 => format!("{}", digit * 10_u32.pow(exponent as u32)),
        -3..=-1 if digit > 1 || exponent > -3 => {
            format!("{:.*}", exponent.unsigned_abs() as usize, f64::from(digit) * 10_f64.powi(exponent))
        }
        _ if digit == 1 => format!("10^{{{}}}", minus(&exponent.to_string())),
        _ => format!("{digit}·10^{{{}}}", minus(&exponent.to_string())),
    }
}

/// With a proper minus sign, which is as wide as a digit.
pub(crate) fn minus(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

/// An angle in degrees with at most one decimal.
pub(crate) fn degrees(radians: f64) -> String {
    let rounded = (10.0 * radians.to_degrees()).round() / 10.0;
    minus(&format!("{}°", if rounded == 0.0 { 0.0 } else { rounded }))
}

/// A number with three significant digits.
pub(crate) fn short(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return "0".into();
    }
    let digits = 2 - exponent(magnitude);
    match digits {
        0..=6 => {
            let text = format!("{value:.*}", digits as usize);
            let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
            minus(text)
        }
        -4..=-1 => minus(&format!("{value:.0}")),
        _ => minus(&format!("{value:.2e}")),
    }
}

fn exponent(value: f64) -> i32 {
    (value.log10() + 1e-9).floor() as i32
}

/// 1, 2 or 5 times a power of ten, so that there are four to eight steps.
fn step(range: f64) -> f64 {
    let rough = range / 5.0;
    let power = 10_f64.powi(exponent(rough));
    let digit = [1.0, 2.0, 5.0].into_iter().rev().find(|digit| digit * power <= rough * 1.2).unwrap_or(1.0);
    digit * power
}

fn round_up(value: f64) -> f64 {
    let power = 10_f64.powi(exponent(value));
    let digit = [1.0, 2.0, 5.0, 10.0].into_iter().find(|digit| digit * power >= value * 0.999_999).unwrap_or(10.0);
    digit * power
}

fn round_down(value: f64) -> f64 {
    let power = 10_f64.powi(exponent(value));
    let digit = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * power <= value * 1.000_001).unwrap_or(1.0);
    digit * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale) -> Vec<String> {
        scale.ticks().into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn axes_end_at_round_numbers_and_hold_their_values() {
        let scale = Scale::around([0.013, 3.2].into_iter(), Scaling::Log);
        assert!((scale.low - 0.01).abs() < 1e-12 && (scale.high - 5.0).abs() < 1e-12, "{scale:?}");
        let scale = Scale::around([0.0, 0.31].into_iter(), Scaling::Linear);
        assert_eq!(labels(scale), ["0", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30", "0.35"]);
        let scale = Scale::around([-0.02, 0.9].into_iter(), Scaling::Linear);
        assert_eq!(labels(scale)[0], "\u{2212}0.2");
        // Zeros and noise do not stretch a logarithmic axis without end.
        assert_eq!(Scale::around([0.0, 1e-30, 1.0].into_iter(), Scaling::Log).low, 1e-6);
        assert_eq!(Scale::around([0.0].into_iter(), Scaling::Log).high, 1.0);
    }

    /// For all finite single-precision values of either sign.
    #[test]
    fn every_axis_has_an_extent_and_labels() {
        let magnitudes = [0.0, 1e-45, 1e-38, 3e-7, 0.999, 1.0, 7.0, 4095.0, 1e15, 3.4e38];
        let numbers: Vec<f64> = magnitudes.into_iter().flat_map(|value| [value, -value]).collect();
        for &a in &numbers {
            for &b in &numbers {
                for scaling in [Scaling::Log, Scaling::Linear] {
                    let scale = Scale::around([a, b].into_iter(), scaling);
                    assert!(scale.high > scale.low && scale.high.is_finite(), "{a} {b}: {scale:?}");
                    let labels = labels(scale);
                    assert!((2..20).contains(&labels.len()), "{a} {b}: {labels:?}");
                    assert!(labels.iter().all(|label| label.chars().count() < 16), "{a} {b}: {labels:?}");
                    for value in [a, b] {
                        let place = scale.place(value);
                        assert!(place.is_finite() && place <= 1.0 + 1e-6, "{a} {b}: {place}");
                    }
                }
            }
        }
        for (low, high) in [(0.31, 0.44), (1.01, 1.02), (0.05, 0.1), (3e-9, 3.1e-9), (9e20, 9.5e20)] {
            let labels = labels(Scale::between(low, high));
            assert!(labels.len() >= 2, "{low} {high}: {labels:?}");
        }
        assert!(Scale { scaling: Scaling::Linear, low: 0.0, high: 0.0 }.ticks().is_empty());
    }

    #[test]
    fn places_and_values_are_inverse() {
        for scaling in [Scaling::Log, Scaling::Linear] {
            let scale = Scale { scaling, low: 0.02, high: 50.0 };
            for value in [0.02, 0.7, 50.0] {
                assert!((scale.value(scale.place(value)) / value - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn powers_and_short_axes() {
        assert_eq!(
            labels(Scale { scaling: Scaling::Log, low: 1e-4, high: 1000.0 }).join(" "),
            "10^{\u{2212}4} 10^{\u{2212}3} 0.01 0.1 1 10 100 10^{3}"
        );
        assert_eq!(labels(Scale { scaling: Scaling::Log, low: 0.2, high: 5.0 }).join(" "), "0.2 0.5 1 2 5");
        assert_eq!(labels(Scale { scaling: Scaling::Log, low: 0.005, high: 0.02 }).join(" "), "0.005 0.01 0.02");
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [0.0, 0.12345, -2.5, 1234.6, 3.0e-7].map(short).join(" "),
            "0 0.123 \u{2212}2.5 1235 3.00e\u{2212}7"
        );
    }
}
