//! The parameters of models.

/// The scope of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// One number for all channels: the shape of a lobe.
    Shape,
    /// One number per channel: a colour.
    Channel,
}

/// The way in which a parameter is varied between its bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Evenly.
    Linear,
    /// By factors.
    Log,
    /// By factors; the values of the model are proportional to it.
    Amplitude,
}

/// A parameter of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in files and on the command line.
    pub name: &'static str,
    /// Its meaning, with its unit.
    pub meaning: &'static str,
    /// Its scope.
    pub scope: Scope,
    /// The smallest value that a fit can find.
    pub low: f64,
    /// The largest value that a fit can find.
    pub high: f64,
    /// The way in which it is varied between them.
    pub spacing: Spacing,
}

/// Closer to a bound than this share of the range, a parameter is at it.
const AT_BOUND: f64 = 1e-6;
/// Closer to a bound than this share of the range, a parameter is on the way to it.
const NEAR_BOUND: f64 = 1e-3;

impl Parameter {
    pub(crate) const fn new(
        name: &'static str,
        meaning: &'static str,
        scope: Scope,
        spacing: Spacing,
        range: [f64; 2],
    ) -> Self {
        Parameter { name, meaning, scope, low: range[0], high: range[1], spacing }
    }

    fn bounds(&self) -> [f64; 2] {
        match self.spacing {
            Spacing::Linear => [self.low, self.high],
            Spacing::Log | Spacing::Amplitude => [self.low.ln(), self.high.ln()],
        }
    }

    /// The value at a share of the range.
    pub(crate) fn at(&self, share: f64) -> f64 {
        let [low, high] = self.bounds();
        let position = low + (high - low) * share;
        match self.spacing {
            Spacing::Linear => position,
            Spacing::Log | Spacing::Amplitude => position.exp(),
        }
    }

    fn share(&self, value: f64) -> f64 {
        let [low, high] = self.bounds();
        let value = value.clamp(self.low, self.high);
        let position = if self.spacing == Spacing::Linear { value } else { value.ln() };
        ((position - low) / (high - low)).clamp(0.0, 1.0)
    }

    /// The value for a number that the optimiser may move without bounds (as in MINUIT, the sine keeps the value within
    /// them).
    pub(crate) fn value(&self, free: f64) -> f64 {
        self.at(0.5 * (free.sin() + 1.0))
    }

    /// The derivative of [`value`](Self::value).
    pub(crate) fn slope(&self, free: f64) -> f64 {
        let [low, high] = self.bounds();
        let slope = 0.5 * (high - low) * free.cos();
        if self.spacing == Spacing::Linear { slope } else { slope * self.value(free) }
    }

    /// The number for a value: the inverse of [`value`](Self::value).
    pub(crate) fn free(&self, value: f64) -> f64 {
        (2.0 * self.share(value) - 1.0).asin()
    }

    /// The bound that a value is near.
    pub(crate) fn near_bound(&self, value: f64) -> Option<f64> {
        let share = self.share(value);
        if share < NEAR_BOUND { Some(self.low) } else { (share > 1.0 - NEAR_BOUND).then_some(self.high) }
    }

    /// The value, moved slightly away from the bounds, where the derivatives vanish.
    pub(crate) fn inner(&self, value: f64) -> f64 {
        let inset = 0.02 * (self.high - self.low);
        match self.spacing {
            Spacing::Linear => value.clamp(self.low + inset, self.high - inset),
            Spacing::Log | Spacing::Amplitude => value.clamp(1.1 * self.low, self.high / 1.1),
        }
    }

    /// `true` if a value is at a bound.
    pub(crate) fn is_at_bound(&self, value: f64) -> bool {
        let share = self.share(value);
        !(AT_BOUND..=1.0 - AT_BOUND).contains(&share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_numbers_stay_within_the_bounds() {
        for spacing in [Spacing::Linear, Spacing::Log] {
            let parameter = Parameter::new("x", "", Scope::Shape, spacing, [0.5, 20.0]);
            for value in [0.51, 1.0, 19.0] {
                assert!((parameter.value(parameter.free(value)) - value).abs() < 1e-9 * value);
            }
            for step in 0..100 {
                let free = f64::from(step) * 0.37 - 20.0;
                assert!((0.5 - 1e-12..=20.0 + 1e-9).contains(&parameter.value(free)));
                let slope = (parameter.value(free + 1e-6) - parameter.value(free - 1e-6)) / 2e-6;
                assert!((slope - parameter.slope(free)).abs() < 1e-6 * slope.abs().max(1.0));
            }
            assert!(parameter.is_at_bound(20.0) && !parameter.is_at_bound(19.0));
        }
    }
}
