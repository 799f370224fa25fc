//! The weights of differences between measured and modelled values.

/// The weights of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weights {
    /// Differences of `f` times the square root of the product of both cosines, as in the appearance of a lit surface.
    Cosine,
    /// Differences of `f`.
    Value,
    /// Differences of the logarithm of `f`: dim directions count like bright ones. Noise makes its mean slightly low.
    Log,
    /// Differences of `f` relative to the model, as is right for measurements with a relative error.
    Relative,
}

impl Weights {
    /// All weights.
    pub const ALL: [Weights; 4] = [Weights::Cosine, Weights::Value, Weights::Log, Weights::Relative];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Weights::Cosine => "cosine",
            Weights::Value => "value",
            Weights::Log => "log",
            Weights::Relative => "relative",
        }
    }
}
